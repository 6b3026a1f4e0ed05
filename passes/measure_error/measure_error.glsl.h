// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/shading/display.glsl.h"

struct Params {
    uint space;
    uint norm;
    float exposure;
    uint curve;
    float scale;
};
HONE_PARAMS(Params)
HONE_READ(vec3, image)
HONE_READ(vec3, reference)
HONE_WRITE(vec2, error)
HONE_WRITE(vec3, display)

HONE_CONST uint kDisplay = 0u;
HONE_CONST uint kMeanSquare = 1u;

float shown(float radiance) {
    return params.space == kDisplay ? displayed(radiance, params.exposure, params.curve) : radiance;
}

#include "hone/core/measure/real_error.glsl.h"

/// A temperature: 0 deep blue, 1/4 light blue, 1/2 green, 3/4 yellow, 1 and above red.
vec3 temperature(float x) {
    float place = clamp(x, 0.0f, 1.0f) * 4.0f;
    vec3 blue = vec3(0.0f, 0.0f, 0.375f);
    vec3 light_blue = vec3(0.125f, 0.5f, 1.0f);
    vec3 green = vec3(0.375f, 0.875f, 0.375f);
    vec3 yellow = vec3(1.0f, 0.875f, 0.125f);
    vec3 red = vec3(0.75f, 0.0f, 0.0f);
    if (place < 1.0f)
        return mix(blue, light_blue, place);
    if (place < 2.0f)
        return mix(light_blue, green, place - 1.0f);
    if (place < 3.0f)
        return mix(green, yellow, place - 2.0f);
    return mix(yellow, red, place - 3.0f);
}

void kernel(uint index) {
    vec3 errors = channelErrors(image[index], reference[index]);
    float real = params.norm == kMeanSquare ? meanSquare(errors) : greatest(errors);
    error[index] = vec2(real, real);
    display[index] = temperature(real * params.scale);
}

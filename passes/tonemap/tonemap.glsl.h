// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/shading/srgb.glsl.h"

struct Params {
    float exposure;
    uint curve;
};
HONE_PARAMS(Params)
HONE_READ(vec3, color)
HONE_WRITE(vec3, display)

/// Reinhard's curve (2002, equation 4) with white at 4: keeps dark values, never exceeds 1 below
/// white.
float reinhard(float x) {
    return min(x * (1.0f + x * (1.0f / 16.0f)) / (1.0f + x), 1.0f);
}

/// Exposed, curved, cut to [0,1]; NaN becomes 0.
float develop(float radiance) {
    float x = radiance * params.exposure;
    x = x > 0.0f ? x : 0.0f;
    return min(params.curve == 1u ? reinhard(x) : x, 1.0f);
}

void kernel(uint index) {
    vec3 radiance = color[index];
    display[index] = vec3(encodeSrgb(develop(radiance.x)), encodeSrgb(develop(radiance.y)),
                          encodeSrgb(develop(radiance.z)));
}

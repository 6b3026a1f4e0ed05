// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/shading/display.glsl.h"

struct Params {
    float exposure;
    uint curve;
};
HONE_PARAMS(Params)
HONE_READ(vec3, color)
HONE_WRITE(vec3, display)

void kernel(uint index) {
    vec3 radiance = color[index];
    display[index] = vec3(displayed(radiance.x, params.exposure, params.curve),
                          displayed(radiance.y, params.exposure, params.curve),
                          displayed(radiance.z, params.exposure, params.curve));
}

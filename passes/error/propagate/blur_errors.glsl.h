// SPDX-License-Identifier: Apache-2.0

struct Params {
    uvec2 extent;
    uint taps;
    float radius_limit;
};
HONE_PARAMS(Params)
HONE_READ(vec2, clean)
HONE_READ(uint, wrong_near) // by tile: 0 where nothing wrong is in reach of the blur
HONE_WRITE(vec2, blurred)

vec3 blurSource(uint pixel) {
    return vec3(clean[pixel], 0.0f);
}

#include "hone/passes/shading/lens_blur.glsl.h"

/// A blur of nothing but 0 is 0.
void kernel(uint index) {
    BlurWindow window;
    window.extent = params.extent;
    window.taps = params.taps;
    window.radius_limit = params.radius_limit;
    bool is_near = wrong_near[blurTile(index, params.extent)] != 0u;
    blurred[index] = is_near ? vec2(lensBlurred(index, window)) : vec2(0.0f);
}

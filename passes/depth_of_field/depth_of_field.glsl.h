// SPDX-License-Identifier: Apache-2.0

struct Params {
    uvec2 extent;
    uint taps;
    float radius_limit;
};
HONE_PARAMS(Params)
HONE_READ(vec3, image)
HONE_WRITE(vec3, color)

vec3 blurSource(uint pixel) {
    return image[pixel];
}

#include "hone/passes/shading/lens_blur.glsl.h"

void kernel(uint index) {
    BlurWindow window;
    window.extent = params.extent;
    window.taps = params.taps;
    window.radius_limit = params.radius_limit;
    color[index] = lensBlurred(index, window);
}

// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/shading/sanitised.glsl.h"

struct Params {
    uvec2 extent;
    uint taps;
    float radius_limit;
    uint mode;
    uint has_post;
};
HONE_PARAMS(Params)
HONE_READ(vec2, shading_error)
HONE_READ(vec2, post)
HONE_READ(uint, wrong_near) // by tile: 0 where nothing wrong is in reach of the blur
HONE_WRITE(vec2, propagated)

HONE_CONST uint kPropagate = 0u;
HONE_CONST uint kMax = 1u;
HONE_CONST uint kSum = 2u;
HONE_CONST float kLargest = 1e30f;

/// What is huge is cut, so that sums stay finite.
vec2 sanitisedError(vec2 error) {
    return min(vec2(sanitised(error.x), sanitised(error.y)), vec2(kLargest));
}

vec3 blurSource(uint pixel) {
    return vec3(sanitisedError(shading_error[pixel]), 0.0f);
}

#include "hone/passes/shading/lens_blur.glsl.h"

void kernel(uint index) {
    vec2 shading = sanitisedError(shading_error[index]);
    if (params.mode == kPropagate) {
        BlurWindow window;
        window.extent = params.extent;
        window.taps = params.taps;
        window.radius_limit = params.radius_limit;
        // A blur of nothing but 0 is 0.
        bool is_near = wrong_near[blurTile(index, params.extent)] != 0u;
        shading = is_near ? vec2(lensBlurred(index, window)) : vec2(0.0f);
    }
    vec2 filter_error = vec2(0.0f);
    if (params.has_post != 0u)
        filter_error = sanitisedError(post[index]);
    vec2 both = shading + filter_error; // kPropagate and kSum
    if (params.mode == kMax)
        both = max(shading, filter_error);
    else if (params.mode > kSum)
        both = 1.0f - (1.0f - min(shading, vec2(1.0f))) * (1.0f - min(filter_error, vec2(1.0f)));
    propagated[index] = both;
}

// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/shading/sanitised.glsl.h"

#include "hone/passes/error/propagate/clean_error.glsl.h"

struct Params {
    uint mode;
    uint has_post;
};
HONE_PARAMS(Params)
HONE_READ(vec2, shading_error) // kPropagate: blurred already
HONE_READ(vec2, post)
HONE_WRITE(vec2, propagated)

HONE_CONST uint kMax = 1u; // 0, propagate, is a sum, too
HONE_CONST uint kSum = 2u;

void kernel(uint index) {
    vec2 shading = cleanError(shading_error[index]);
    vec2 filter_error = vec2(0.0f);
    if (params.has_post != 0u)
        filter_error = cleanError(post[index]);
    vec2 both = shading + filter_error;
    if (params.mode == kMax)
        both = max(shading, filter_error);
    else if (params.mode > kSum)
        both = 1.0f - (1.0f - min(shading, vec2(1.0f))) * (1.0f - min(filter_error, vec2(1.0f)));
    propagated[index] = both;
}

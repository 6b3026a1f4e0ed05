// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/shading/sanitised.glsl.h"

struct Params {
    uint mode;
    uint metrics;       ///< how many edges `errors` has
    vec4 weights_first; ///< of edges 0 to 3
    vec4 weights_last;  ///< of edges 4 to 7
};
HONE_PARAMS(Params)
HONE_READS(vec2, errors, 8)
HONE_WRITE(vec2, error)

HONE_CONST uint kMean = 0u;
HONE_CONST uint kLinear = 1u;
HONE_CONST uint kMax = 2u;
HONE_CONST uint kNoisyOr = 3u;
HONE_CONST uint kSum = 4u;
HONE_CONST float kLargest = 3.402823466e38f;

float weightOf(uint metric) {
    return metric < 4u ? params.weights_first[metric] : params.weights_last[metric - 4u];
}

void kernel(uint index) {
    float expect = 0.0f;
    float bound = 0.0f;
    for (uint metric = 0u; metric < params.metrics; ++metric) {
        vec2 term = errors[metric].data[index];
        float term_expect = sanitised(term.x);
        float term_bound = sanitised(term.y);
        if (params.mode != kMean && params.mode != kSum)
            term_expect *= weightOf(metric);
        if (params.mode == kMax) {
            expect = max(expect, term_expect);
            bound = max(bound, term_bound);
        } else {
            // a + (1 - a) b = 1 - (1 - a)(1 - b), but keeps small chances.
            expect +=
                params.mode == kNoisyOr ? (1.0f - expect) * min(term_expect, 1.0f) : term_expect;
            bound += term_bound;
        }
    }
    if (params.mode == kMean)
        expect /= float(max(params.metrics, 1u));
    error[index] = vec2(min(expect, kLargest), min(bound, kLargest));
}

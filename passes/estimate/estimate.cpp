// SPDX-License-Identifier: Apache-2.0
//
// estimate: how many samples one visit of each pixel shall take.
//
// "First and more often": a pixel gets samples in proportion to its expected error E,
//
//     count = max(1, round(max_count * E / E_max)),    E_max: the greatest of the frame
//
// of which request takes at most what the pixel still lacks. Later visits go on with the next
// samples, so counts decide how soon a pixel is finished, never how it looks then. What is not
// finite counts as 1, what is negative as 0; where all errors are 0 every count is 1.
//
// in   error   Error; expect counts
// out  counts  SampleCounts, 1 to max_count
// params  max_count  samples that a visit of the worst pixel takes (8)
//
//     "estimate": { "type": "estimate", "in": { "error": "combine.error" } }
//
// Source: Amann, Chajdas, Westermann 2012, section 3.5, which says that a pass fills in the number
// of samples and that large errors are refined more often; proportional is our reading.
#include "hone/passes/passes.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>

namespace hone {
namespace {

float expected(vec2 error) {
    return std::isfinite(error.x) ? std::max(error.x, 0.0f) : 1.0f;
}

class EstimatePass final : public RenderPass {
public:
    void execute(PassContext& context) override {
        const std::span<const vec2> errors = context.in("error").as<vec2>();
        const std::span<uint> counts = context.out("counts").as<uint>();
        const uint max_count = context.param<uint>("max_count");

        // A maximum is the same in any order.
        using Range = tbb::blocked_range<std::size_t>;
        const float greatest = tbb::parallel_reduce(
            Range(0, errors.size()), 0.0f,
            [&](const Range& range, float most) {
                for (std::size_t i = range.begin(); i < range.end(); ++i)
                    most = std::max(most, expected(errors[i]));
                return most;
            },
            [](float a, float b) { return std::max(a, b); });

        tbb::parallel_for(Range(0, errors.size()), [&](const Range& range) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) {
                const double share =
                    greatest > 0.0f ? static_cast<double>(expected(errors[i])) / greatest : 0.0;
                counts[i] = std::max(1u, static_cast<uint>(std::llround(share * max_count)));
            }
        });
    }
};

} // namespace

PassType estimatePass() {
    return PassType("estimate", "Decides how many samples one visit of each pixel shall take")
        .in("error", types::kError, "expect: what the counts are in proportion to")
        .out("counts", types::kSampleCounts, "at least 1; max_count where expect is greatest")
        .param("max_count", 8u, {.min = 1, .max = 65536},
               "samples that a visit of the worst pixel takes")
        .implementedBy<EstimatePass>(Domain::kHost);
}

} // namespace hone

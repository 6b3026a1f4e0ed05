// SPDX-License-Identifier: Apache-2.0
//
// combine: several error metrics into one.
//
// The metrics of one pixel become the number that orders it (expect) and the number that gates it
// (bound):
//
//     mode      expect                      bound
//     mean      sum of E_i / n              sum of bounds
//     linear    sum of w_i E_i              sum of bounds
//     max       max of w_i E_i              max of bounds
//     noisy_or  1 - product of (1 - w_i E_i)  sum of bounds
//     sum       sum of E_i                  sum of bounds
//
// mean: n counts connected metrics, whether they apply to a pixel or not, so one certain error
// among n says 1/n: it orders, but is no estimate. linear and sum are not cut at 1: the order above
// 1 counts, too. noisy_or takes each w_i E_i, cut at 1, for the chance that its effect is wrong,
// independent of the others: the chance that any is.
//
// Weights scale estimates only. A bound stays a bound whatever its metric's weight: a weight of 0
// takes a metric out of the order, not out of what may be wrong. By the triangle inequality the sum
// of bounds is a bound of the sum of effects; the max is one only where effects do not add, but is
// greater than 0 wherever one of them is.
//
// NaN and infinity count as 1 (a metric that failed says "unknown"), negative values as 0; results
// are finite.
//
// in   errors  Error, up to 8 edges, each with a weight (1)
// out  error   Error
// params  mode  mean, linear, max, noisy_or, sum
//
//     "combine": { "type": "combine", "params": { "mode": "linear" }, "in": { "errors": [
//         { "from": "shadow.error" }, { "from": "reflection.error", "weight": 0.8 } ] } }
//
// Source: Amann, Chajdas, Westermann 2012, section 3.4 (mean and linear combination of metrics);
// the others and the bound are ours.
#include "hone/passes/passes.h"

#include "hone_spirv/combine.h"

#include "hone/core/device/kernel.glsl.h"

namespace hone {
namespace {

struct Combine : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/combine/combine.glsl.h"
};
constexpr Kernel kCombine = makeKernel<Combine>("combine", spirv::combine);

class CombinePass final : public RenderPass {
public:
    void execute(PassContext& context) override {
        Combine::Params params{};
        params.mode = context.params->choice("mode");
        params.metrics = context.edges("errors");
        for (uint metric = 0; metric < params.metrics; ++metric) {
            vec4& quarter = metric < 4 ? params.weights_first : params.weights_last;
            quarter[static_cast<int>(metric % 4)] =
                std::get<float>(context.edgeParam("errors", metric, "weight"));
        }
        context.dispatch(kCombine, params, context.out("error").count);
    }
};

} // namespace

PassType combinePass() {
    ParamDecl weight;
    weight.name = "weight";
    weight.doc = "scales this metric's expected error (modes linear, max and noisy_or)";
    weight.fallback = 1.0f;
    weight.min = 0.0;
    return PassType("combine", "Combines several error metrics into one")
        .inMany("errors", types::kError, "the metrics", {weight})
        .out("error", types::kError, "expect orders pixels, bound gates them; finite, >= 0")
        .param("mode", {"mean", "linear", "max", "noisy_or", "sum"},
               "mean: their mean; linear: their weighted sum; max: the greatest weighted one; "
               "noisy_or: the chance that any is wrong; sum: their sum without weights")
        .promises(Promise::kPixelwise)
        .promises(Promise::kMonotone)
        .implementedBy<CombinePass>(Domain::kEither);
}

} // namespace hone

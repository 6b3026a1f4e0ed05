// SPDX-License-Identifier: Apache-2.0
//
// accumulate: adds samples to each pixel's running sum.
//
// One sum a pixel, in the order of its samples, over all batches: so the sum is the same bits
// whatever the batches were. A pixel's samples must be consecutive in the list and follow those
// that were added before, as request and trace make them.
//
// in   samples       Samples
// in   accumulation  Accumulation (optional): the sums so far; without it they begin at zero
// out  accumulation  Accumulation, in place
//
//     "accumulate": { "type": "accumulate", "in": { "samples": "trace.samples",
//                     "accumulation": "~accumulation" } }
#include "hone/passes/passes.h"

#include "hone_spirv/accumulate.h"

#include "hone/core/device/kernel.glsl.h"

namespace hone {
namespace {

struct Accumulate : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/accumulate/accumulate.glsl.h"
};
constexpr Kernel kAccumulate = makeKernel<Accumulate>("accumulate", spirv::accumulate);

class AccumulatePass final : public RenderPass {
public:
    void execute(PassContext& context) override {
        const uint count = context.in("samples").count;
        context.dispatch(kAccumulate, Accumulate::Params{count}, count);
    }
};

} // namespace

PassType accumulatePass() {
    return PassType("accumulate", "Adds samples to each pixel's running sum")
        .in("samples", types::kSamples, "one pixel's are consecutive, in the order of samples")
        .inOptional("accumulation", types::kAccumulation, "the sums so far; none: zero")
        .outInPlace("accumulation", types::kAccumulation, "accumulation", "the sums")
        .implementedBy<AccumulatePass>(Domain::kEither);
}

} // namespace hone

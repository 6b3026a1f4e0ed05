// SPDX-License-Identifier: Apache-2.0
//
// blend: puts traced pixels into the image.
//
// Only requested pixels are written. A pixel with all its samples becomes exactly their mean, so
// the finished image is the ray-traced one, bit for bit. Before that
//
//     mode replace  the mean of the samples so far
//     mode ramp     base + n / samples * (mean - base): few noisy samples do not make a pixel worse
//                   than the raster image was; needs base, and is replace without it
//
// in   requests      RequestList: the pixels to write
// in   accumulation  Accumulation
// in   base          Radiance (optional): the raster image
// in   image         Radiance
// in   round         Round (optional)
// out  image         Radiance, in place
// out  round         Round, in place: which iteration traced a pixel first
// params  samples  samples per pixel when finished (1)
//         mode     replace, ramp
//
//     "blend": { "type": "blend", "in": { "requests": "request.requests", "accumulation":
//                "accumulate.accumulation", "base": "raster.color", "image": "~image" } }
//
// Source: Amann, Chajdas, Westermann 2012, section 3.5, which gives no formula: ramp is our
// reading.
#include "hone/passes/passes.h"

#include "hone_spirv/blend.h"

#include "hone/core/device/kernel.glsl.h"

#include <algorithm>
#include <array>

namespace hone {
namespace {

struct Blend : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/blend/blend.glsl.h"
};
constexpr Kernel kBlend = makeKernel<Blend>("blend", spirv::blend);

class BlendPass final : public RenderPass {
public:
    void execute(PassContext& context) override {
        const Value& image = context.out("image");
        const Blend::Params params{.samples = context.param<uint>("samples"),
                                   .mode = context.params->choice("mode"),
                                   .has_base = context.has("base") ? 1u : 0u,
                                   .round_number = std::max(context.iteration, 1u)};
        // `round` is a function's name in kernels; without a base its name is bound to what is
        // never read through it.
        const std::array<Argument, 2> extra{
            {{"round_of", context.out("round").buffer},
             {"base", context.has("base") ? context.in("base").buffer : image.buffer}}};
        context.dispatch(kBlend, params, context.in("requests").count, extra);
    }
};

} // namespace

PassType blendPass() {
    return PassType("blend", "Puts traced pixels into the image")
        .in("requests", types::kRequestList, "the pixels to write")
        .in("accumulation", types::kAccumulation, "sums of samples")
        .inOptional("base", types::kRadiance, "the raster image, for mode ramp")
        .in("image", types::kRadiance, "what is refined")
        .inOptional("round", types::kRound, "which iteration first traced each pixel; none: zero")
        .outInPlace("image", types::kRadiance, "image", "the image, refined")
        .outInPlace("round", types::kRound, "round", "which iteration first traced each pixel")
        .param("samples", 1u, {.min = 1, .max = {}}, "samples per pixel when finished")
        .param("mode", {"replace", "ramp"},
               "before a pixel is finished; replace: the mean so far; ramp: from base to it")
        .implementedBy<BlendPass>(Domain::kEither);
}

} // namespace hone

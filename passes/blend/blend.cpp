// SPDX-License-Identifier: Apache-2.0
//
// blend: puts traced pixels into the image.
//
// Only requested pixels are written. A pixel with all its samples becomes exactly their mean, so
// the finished image is the ray-traced one, bit for bit. Before that
//
//     mode replace  the mean of the n samples so far
//     mode ramp     base + alpha * (mean - base) with alpha = n / N, N: all samples. Few noisy
//                   samples do not make a pixel worse than the raster image was
//     mode credit   the same with alpha = n / (n + k (1 - n / N)): the base is worth k samples.
//                   k = sigma^2 / e^2 makes the expected squared error least, where e is the
//                   base's error and sigma^2 the variance of one sample, independent of it. 0 where
//                   samples are exact: the first replaces the base
//
// ramp and credit need base, and are replace without it.
//
// in   requests      RequestList: the pixels to write
// in   accumulation  Accumulation
// in   base          Radiance (optional): the raster image
// in   error         Error (optional): credit's e is expect; without it k is the parameter credit
// in   image         Radiance
// in   round         Round (optional)
// out  image         Radiance, in place
// out  round         Round, in place: which iteration traced a pixel first
// params  samples  samples per pixel when finished (1)
//         mode     replace, ramp, credit
//         credit   samples that the base is worth, 0 to samples (4)
//         sigma    standard deviation of a sample, in the unit of error (0.5)
//
//     "blend": { "type": "blend", "in": { "requests": "request.requests", "accumulation":
//                "accumulate.accumulation", "base": "raster.color", "image": "~image" } }
//
// Source: Amann, Chajdas, Westermann 2012, section 3.5, which gives no formula: ramp is our
// reading, credit the minimum of (1 - alpha)^2 e^2 + alpha^2 sigma^2 / n, bent to be 1 at n = N.
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
                                   .has_error = context.has("error") ? 1u : 0u,
                                   .credit = context.param<float>("credit"),
                                   .sigma = context.param<float>("sigma"),
                                   .round_number = std::max(context.iteration, 1u)};
        // `round` is a function's name in kernels. What nothing feeds is never read, but must be
        // bound to something.
        std::array<Argument, 3> extra;
        std::size_t extras = 0;
        extra[extras++] = {"round_of", context.out("round").buffer};
        for (const char* optional : {"base", "error"})
            if (!context.has(optional))
                extra[extras++] = {optional, image.buffer};
        context.dispatch(kBlend, params, context.in("requests").count,
                         std::span(extra).first(extras));
    }
};

} // namespace

PassType blendPass() {
    return PassType("blend", "Puts traced pixels into the image")
        .in("requests", types::kRequestList, "the pixels to write")
        .in("accumulation", types::kAccumulation, "sums of samples")
        .inOptional("base", types::kRadiance, "the raster image, for modes ramp and credit")
        .inOptional("error", types::kError, "of the base, for mode credit")
        .in("image", types::kRadiance, "what is refined")
        .inOptional("round", types::kRound, "which iteration first traced each pixel; none: zero")
        .outInPlace("image", types::kRadiance, "image", "the image, refined")
        .outInPlace("round", types::kRound, "round", "which iteration first traced each pixel")
        .param("samples", 1u, {.min = 1, .max = {}}, "samples per pixel when finished")
        .param("mode", {"replace", "ramp", "credit"},
               "before a pixel is finished; replace: the mean so far; ramp: from base to it by the "
               "share of samples; credit: as if base were some samples, too")
        .param("credit", 4.0f, {.min = 0, .max = {}},
               "samples that the base is worth where no error is connected")
        .param("sigma", 0.5f, {.min = 0, .max = {}},
               "standard deviation of a sample, in the unit of error")
        .implementedBy<BlendPass>(Domain::kEither);
}

} // namespace hone

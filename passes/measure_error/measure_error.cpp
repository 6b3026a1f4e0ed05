// SPDX-License-Identifier: Apache-2.0
//
// measure.error: the real error of an image against a reference.
//
// What every estimate is judged by. By default the greatest difference of a channel, because any
// visible change counts; 0 means the same bits. It is written as an Error, so that it can feed
// sort: the order of an oracle (graphs/oracle.json). The picture shows it on a temperature scale
// from blue to red.
//
// in   image      Radiance
// in   reference  Radiance
// out  error      Error, expect = bound
// out  display    Display: temperature of error * scale; 1 and above is red
// params  space     display: what a screen shows of both, in [0,1] (as tonemap makes it); linear:
//                   radiance
//         norm      max: the greatest channel's; mean_square: the mean of the channels' squares,
//                   whose mean over pixels is the MSE
//         exposure  as in tonemap, for space display (1)
//         curve     as in tonemap, for space display (clip)
//         scale     multiplies the error before it is coloured (1)
//
// What cannot be compared (one of the two is not finite, and they are not the same bits) counts as
// 1 in a channel.
//
//     "error": { "type": "measure.error", "in": { "image": "raster.color",
//                "reference": "truth.image" }, "params": { "norm": "mean_square" } }
//
// Source: Amann, Chajdas, Westermann 2012, Figure 1 (the picture) and Figure 10 (real error); the
// maximum over channels is ours.
#include "hone/passes/passes.h"

#include "hone_spirv/measure_error.h"

#include "hone/core/device/kernel.glsl.h"

namespace hone {
namespace {

struct MeasureError : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/measure_error/measure_error.glsl.h"
};
constexpr Kernel kMeasureError = makeKernel<MeasureError>("measure_error", spirv::measure_error);

} // namespace

PassType measureErrorPass() {
    return PassType("measure.error", "The real error of an image against a reference")
        .in("image", types::kRadiance, "what is judged")
        .in("reference", types::kRadiance, "the truth")
        .out("error", types::kError, "difference of the two; expect = bound")
        .out("display", types::kDisplay, "the error on a temperature scale, blue to red")
        .param("space", {"display", "linear"},
               "display: as a screen shows it, exposed, curved and sRGB-encoded; linear: radiance")
        .into(offsetof(MeasureError::Params, space))
        .param("norm", {"max", "mean_square"},
               "max: of the channels' differences; mean_square: the mean of their squares")
        .into(offsetof(MeasureError::Params, norm))
        .param("exposure", 1.0f, {.min = 0, .max = {}},
               "space display: multiplies radiance before the curve")
        .into(offsetof(MeasureError::Params, exposure))
        .param("curve", {"clip", "reinhard"}, "space display: as in tonemap")
        .into(offsetof(MeasureError::Params, curve))
        .param("scale", 1.0f, {.min = 0, .max = {}}, "multiplies the error before it is coloured")
        .into(offsetof(MeasureError::Params, scale))
        .promises(Promise::kPixelwise)
        .kernel(kMeasureError, "error");
}

} // namespace hone

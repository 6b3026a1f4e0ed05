// SPDX-License-Identifier: Apache-2.0
//
// difference: the real error of an image against a reference.
//
// The error of a pixel is the greatest difference of a channel, because any visible change counts;
// 0 means the same bits. The picture shows it on a temperature scale from blue to red.
//
// in   image      Radiance
// in   reference  Radiance
// out  error      Error, expect = bound
// out  display    Display: temperature of error * scale; 1 and above is red
// params  space  display: after clipping to [0,1] and sRGB encoding, in [0,1]; linear: radiance
//         scale  multiplies the error before it is coloured (1)
//
//     "difference": { "type": "difference", "in": { "image": "raster.color",
//                     "reference": "refine.image" } }
//
// Source: Amann, Chajdas, Westermann 2012, Figure 1 (the picture); the maximum over channels is
// ours.
#include "hone/passes/passes.h"

#include "hone_spirv/difference.h"

#include "hone/core/device/kernel.glsl.h"

namespace hone {
namespace {

struct Difference : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/difference/difference.glsl.h"
};
constexpr Kernel kDifference = makeKernel<Difference>("difference", spirv::difference);

} // namespace

PassType differencePass() {
    return PassType("difference", "The real error of an image against a reference")
        .in("image", types::kRadiance, "what is judged")
        .in("reference", types::kRadiance, "the truth")
        .out("error", types::kError, "greatest difference of a channel; expect = bound")
        .out("display", types::kDisplay, "the error on a temperature scale, blue to red")
        .param("space", {"display", "linear"},
               "display: as a screen shows it, clipped and sRGB-encoded; linear: radiance")
        .into(offsetof(Difference::Params, space))
        .param("scale", 1.0f, {.min = 0, .max = {}}, "multiplies the error before it is coloured")
        .into(offsetof(Difference::Params, scale))
        .kernel(kDifference, "error");
}

} // namespace hone

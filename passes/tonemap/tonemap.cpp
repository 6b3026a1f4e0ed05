// SPDX-License-Identifier: Apache-2.0
//
// tonemap: radiance to what a screen shows.
//
// Multiplies by the exposure, applies a curve per channel and encodes for sRGB. The curve is per
// channel and does not depend on the image, so an error bound in radiance stays a bound after it.
//
// in   color    Radiance
// out  display  Display, in [0,1]
// params  exposure  multiplies radiance first (1)
//         curve     clip: cut at 1; reinhard: Reinhard et al. 2002, white at 4
//
//     "tonemap": { "type": "tonemap", "in": { "color": "refine.image" }, "params": {
//     "exposure": 1.5 } }
//
// Source: IEC 61966-2-1; Reinhard et al., Photographic Tone Reproduction for Digital Images, 2002,
// equation 4.
#include "hone/passes/passes.h"

#include "hone_spirv/tonemap.h"

#include "hone/core/device/kernel.glsl.h"

namespace hone {
namespace {

struct Tonemap : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/tonemap/tonemap.glsl.h"
};
constexpr Kernel kTonemap = makeKernel<Tonemap>("tonemap", spirv::tonemap);

} // namespace

PassType tonemapPass() {
    return PassType("tonemap", "Turns radiance into what a screen shows")
        .in("color", types::kRadiance, "linear radiance")
        .out("display", types::kDisplay, "sRGB-encoded, in [0,1]")
        .param("exposure", 1.0f, {.min = 0, .max = {}}, "multiplies radiance before the curve")
        .into(offsetof(Tonemap::Params, exposure))
        .param("curve", {"clip", "reinhard"},
               "clip: cut at 1; reinhard: compress highlights, white at 4")
        .into(offsetof(Tonemap::Params, curve))
        .promises(Promise::kPixelwise)
        .kernel(kTonemap, "display");
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
//
// error.kbm10: where the raster image's hard shadows differ from soft ones.
//
// Asks the shadow maps of several points of each light, each over 3 x 3 texels. Where the answers
// differ is penumbra (or the edge of a hard shadow, which the map draws only as fine as its
// texels): error 1. The mask is dilated, for the points see only part of the light. Pixels that no
// light can reach stay 0: their shadows cannot be wrong. expect = bound = E. Not conservative:
// what blocks the light between its points is not seen.
//
// in   gbuffer      Hits
//      scene        Scene
//      camera       Camera
//      shadow_maps  ShadowMaps; with the points that shadow_map was asked for
// out  error        Error, 0 or 1
// params  include_umbra  flag the pixels that no point sees as well, as the source's words say
//                        (false)
//         dilation       pixels to each side (2: 5 x 5 as in the source)
//
//     "kbm10": { "type": "error.kbm10",
//                "in": { "gbuffer": "raster.gbuffer", "scene": "$scene", "camera": "$camera",
//                        "shadow_maps": "shadow_map.maps" } }
//
// Source: Knauer, Baerz, Mueller, A hybrid approach to interactive global illumination and soft
// shadows, 2010; used by Amann, Chajdas, Westermann, 2012.
#include "hone/passes/passes.h"

#include "hone_spirv/dilate_columns.h"
#include "hone_spirv/dilate_rows.h"
#include "hone_spirv/penumbra.h"

#include "hone/core/device/kernel.glsl.h"

namespace hone {
namespace {

struct Penumbra : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/error/kbm10/penumbra.glsl.h"
};
struct DilateRows : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/error/kbm10/dilate_rows.glsl.h"
};
struct DilateColumns : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/error/kbm10/dilate_columns.glsl.h"
};
constexpr Kernel kPenumbra = makeKernel<Penumbra>("penumbra", spirv::penumbra);
constexpr Kernel kDilateRows = makeKernel<DilateRows>("dilate_rows", spirv::dilate_rows);
constexpr Kernel kDilateColumns =
    makeKernel<DilateColumns>("dilate_columns", spirv::dilate_columns);

class Kbm10Error final : public RenderPass {
public:
    void execute(PassContext& context) override {
        const uint pixels = context.extent.x * context.extent.y;
        if (!penumbra_ || penumbra_.bytes() < pixels * sizeof(uint)) {
            penumbra_ = context.memory->createBuffer(pixels * sizeof(uint), "penumbra");
            dilated_rows_ = context.memory->createBuffer(pixels * sizeof(uint), "dilated_rows");
        }
        const Argument scratch[] = {{"penumbra", penumbra_.view()},
                                    {"dilated_rows", dilated_rows_.view()}};

        const Penumbra::Params params{context.camera(), context.extent,
                                      context.param<bool>("include_umbra") ? 1u : 0u};
        context.dispatch(kPenumbra, params, pixels, scratch);
        const uint radius = context.param<uint>("dilation");
        const DilateRows::Params rows{context.extent, radius};
        context.dispatch(kDilateRows, rows, pixels, scratch);
        const DilateColumns::Params columns{context.extent, radius};
        context.dispatch(kDilateColumns, columns, pixels, scratch);
    }

private:
    Buffer penumbra_, dilated_rows_;
};

} // namespace

PassType kbm10ErrorPass() {
    return PassType("error.kbm10", "Where hard shadows differ from soft ones")
        .in("gbuffer", types::kHits, "what the raster image sees")
        .in("scene", types::kScene, "surfaces and lights")
        .in("camera", types::kCamera, "of the raster image")
        .in("shadow_maps", types::kShadowMaps, "of several points of each light")
        .out("error", types::kError, "1 in the penumbra, else 0")
        .param("include_umbra", false, "whether pixels that no point sees are flagged, too")
        .param("dilation", 2u, {.min = 0, .max = 8}, "pixels that the mask grows to each side")
        .implementedBy<Kbm10Error>(Domain::kEither);
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
//
// error.shadow: where the raster image's hard shadows differ from soft ones, and by how much.
//
// For each light, searches the map of its centre where the segments from the pixel's surface to all
// of the light cross it: nothing is in their way (lit), one unbroken surface is across all of them
// (umbra), or neither (penumbra). Lit and umbra are what a hard shadow shows. A light without an
// extent has no penumbra but the edges of its map, a texel and a half to each side. Lights that are
// partly below the surface's horizon are penumbra; pixels that no light can reach are 0.
//
// in   gbuffer        Hits
//      scene          Scene
//      camera         Camera
//      shadow_maps    ShadowMaps; of the lights' centres at least
//      shadow_ranges  ShadowRanges; their depths by areas
// out  error          Error
// params  magnitude   bitmask: expect is |share of the light that is seen - share in the image|, by
//                     which of 16 x 16 cells of it the map's texels hide, times what the light
//                     sends unshadowed (greatest channel of radiance); bound is that light where
//                     either could be wrong. Several lights are added.
//                     binary: expect = bound = 1 in the penumbra, as in the paper
//         detail      bitmask: blocks along the edge of the searched area that the mask is made of,
//                     at most; half as many at least. Around the surface smaller ones (4)
//         certified   call umbra only what one unbroken surface hides: occluders that hide the
//                     light from the centre together may leave a gap beside it (true)
//         retest      ask texel by texel where a rectangle of the map decides nothing, so that
//                     slanted receivers are no penumbra of themselves (true)
//         iterations  times that the search area is made smaller (4)
//         near        depth of the first search area in metres; 0: the nearest thing in the map (0)
//
//     "shadow": { "type": "error.shadow",
//                 "in": { "gbuffer": "raster.gbuffer", "scene": "$scene", "camera": "$camera",
//                         "shadow_maps": "shadow_map.maps", "shadow_ranges": "ranges.ranges" } }
//
// The metric of the paper: magnitude binary, certified false, retest false.
//
// Source: Amann, Chajdas, Westermann 2012, section 4.3, after Guennebaud, Barthe, Paulin, Real-time
// soft shadow mapping by backprojection, 2006; Schwarz and Stamminger, Bitmask Soft Shadows, 2007.
#include "hone/core/error.h"
#include "hone/passes/passes.h"

#include "hone_spirv/shadow_error.h"

#include "hone/core/device/kernel.glsl.h"

#include <array>
#include <utility>

namespace hone {
namespace {

struct ShadowErrorKernel : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/error/shadow/shadow_error.glsl.h"
};
constexpr Kernel kShadowError = makeKernel<ShadowErrorKernel>("shadow_error", spirv::shadow_error);

class ShadowError final : public RenderPass {
public:
    void execute(PassContext& context) override {
        checkRanges(context);
        const ShadowErrorKernel::Params params{
            .camera = context.camera(),
            .extent = context.extent,
            .near = context.param<float>("near"),
            .iterations = context.param<uint>("iterations"),
            .certified = context.param<bool>("certified") ? 1u : 0u,
            .retest = context.param<bool>("retest") ? 1u : 0u,
            .detail = context.params->choice("magnitude") == 0 ? context.param<uint>("detail") : 0};
        context.dispatch(kShadowError, params, context.extent.x * context.extent.y);
    }

private:
    /// Ranges of maps of another size would be looked up beside them. Sizes are read again where
    /// the records are others, or elsewhere.
    void checkRanges(PassContext& context) {
        const BufferView maps = context.in("shadow_maps").buffer;
        const BufferView ranges = context.in("shadow_ranges").buffer;
        const std::array records{std::pair(maps.data, maps.bytes),
                                 std::pair(ranges.data, ranges.bytes)};
        if (checked_ == records)
            return;
        context.chosen->finish();
        const auto size = static_cast<uint>(maps.as<float>()[0]);
        const uint cells = ranges.as<uvec2>()[0].x;
        if (cells != (size + 1) / 2)
            throw GraphError(
                std::string(context.pass_name) + ": the shadow maps have faces of " +
                std::to_string(size) + " texels, but the shadow ranges were made of maps with " +
                std::to_string(2 * cells) + "; connect the maps that pass shadow_range reads");
        checked_ = records;
    }

    std::array<std::pair<std::byte*, std::size_t>, 2> checked_{}; ///< where sizes were right
};

} // namespace

PassType shadowErrorPass() {
    return PassType("error.shadow", "Where hard shadows differ from soft ones, and by how much")
        .in("gbuffer", types::kHits, "what the raster image sees")
        .in("scene", types::kScene, "surfaces and lights")
        .in("camera", types::kCamera, "of the raster image")
        .in("shadow_maps", types::kShadowMaps, "of the lights' centres")
        .in("shadow_ranges", types::kShadowRanges, "of those maps")
        .out("error", types::kError, "what the penumbra of all lights may be wrong by")
        .param("magnitude", {"bitmask", "binary"}, "bitmask: radiance; binary: 1 in the penumbra")
        .param("detail", 4u, {.min = 1, .max = 64},
               "blocks along the searched area that the mask is made of, at most")
        .param("certified", true, "whether umbra must be one unbroken surface's")
        .param("retest", true, "whether what rectangles leave open is asked texel by texel")
        .param("iterations", 4u, {.min = 0, .max = 16}, "times that the search area shrinks")
        .param("near", 0.0f, {.min = 0, .max = {}},
               "depth of the first search area; 0: of the nearest thing")
        .implementedBy<ShadowError>(Domain::kEither);
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
//
// shadow_range: how near and how far shadow maps are, for any rectangle of them.
//
// Of the map of each light's centre, the least and the greatest depth in squares of many sizes, and
// whether all depths of a square are those of one unbroken surface. hsm: a pyramid of squares that
// tile the map, 2/3 of the map's bytes; an area is answered by the 2 x 2 squares that hold it, up
// to four times as wide. nbuffer: at each size squares that begin at every second texel, so that an
// area is answered exactly, for (levels + 1) / 2 times the map's bytes (size 1024, 6 levels: 84 MiB
// a light); an area wider than twice the largest square takes more lookups, not more room. Record:
// passes/shading/shadow_range.glsl.h. Runs again only when the scene changed.
//
// in   scene        Scene
//      shadow_maps  ShadowMaps
// out  ranges       ShadowRanges
// params  query   hsm | nbuffer (hsm)
//         levels  nbuffer: the largest squares are 2^levels cells of 2 x 2 texels (6)
//         size    texels along a face's edge; that of shadow_map (1024)
//
//     "ranges": { "type": "shadow_range", "in": { "scene": "$scene",
//                 "shadow_maps": "shadow_map.maps" } }
//
// Source: Guennebaud, Barthe, Paulin, Real-time soft shadow mapping by backprojection, 2006 (the
// pyramid); Decoret, N-Buffers for efficient depth map query, 2005.
#include "hone/core/error.h"
#include "hone/passes/passes.h"

#include "hone_spirv/range_blocks.h"
#include "hone_spirv/range_cells.h"
#include "hone_spirv/range_faces.h"

#include "hone/core/device/kernel.glsl.h"

#include <algorithm>

namespace hone {
namespace {

struct RangeCells : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/shadow_range/range_cells.glsl.h"
};
struct RangeBlocks : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/shadow_range/range_blocks.glsl.h"
};
struct RangeFaces : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/shadow_range/range_faces.glsl.h"
};
constexpr Kernel kRangeCells = makeKernel<RangeCells>("range_cells", spirv::range_cells);
constexpr Kernel kRangeBlocks = makeKernel<RangeBlocks>("range_blocks", spirv::range_blocks);
constexpr Kernel kRangeFaces = makeKernel<RangeFaces>("range_faces", spirv::range_faces);

constexpr uint kMostLevels = RangeFaces::kRangeHeader - RangeFaces::kRangeFirstLevel;

/// Where what is: of each level its first range in a face and the blocks along its edge.
struct Layout {
    bool is_hsm;
    uint cells;
    std::vector<uvec2> levels;
    uint face_ranges = 0;

    explicit Layout(const PassParams& params)
        : is_hsm(params.choice("query") == RangeFaces::kRangeHsm),
          cells((params.get<uint>("size") + 1) / 2) {
        const uint most = is_hsm ? kMostLevels - 1 : params.get<uint>("levels");
        for (uint level = 0, edge = cells; level <= most; ++level) {
            levels.push_back({face_ranges, edge});
            face_ranges += edge * edge;
            if ((1u << level) >= cells) // all in one block
                break;
            if (is_hsm)
                edge = (edge + 1) / 2;
        }
    }
};

uint faceCount(const Scene& scene) {
    uint faces = 0;
    for (const Light& light : scene.lights)
        faces += light.shadowless != 0 ? 0 : light.kind == kLightDirectional ? 1 : 6;
    return faces;
}

std::size_t recordSize(const SizeQuery& query) {
    return RangeFaces::kRangeHeader +
           faceCount(*query.scene) * (1 + std::size_t{Layout(query.params).face_ranges});
}

class ShadowRange final : public RenderPass {
public:
    void execute(PassContext& context) override {
        const Scene& scene = *context.scene().scene;
        const Layout layout(*context.params);
        const uint faces = faceCount(scene);
        Value& ranges = context.out("ranges");
        ranges.count = static_cast<uint>(ranges.capacity<uvec2>().size());

        // The header comes first: kernels read it.
        context.chosen->finish();
        const auto size = static_cast<uint>(context.in("shadow_maps").as<float>()[0]);
        if (size != context.param<uint>("size"))
            throw GraphError(std::string(context.pass_name) + ": the shadow maps have faces of " +
                             std::to_string(size) + " texels, but room was made for " +
                             std::to_string(context.param<uint>("size")) +
                             "; set this pass's parameter \"size\" to that of shadow_map");
        const std::span<uvec2> header = ranges.capacity<uvec2>().first(RangeFaces::kRangeHeader);
        const auto top = static_cast<uint>(layout.levels.size()) - 1;
        std::ranges::fill(header, uvec2(0));
        header[0] = {layout.cells, top};
        header[1] = {layout.is_hsm ? RangeFaces::kRangeHsm : RangeFaces::kRangeNbuffer,
                     layout.face_ranges};
        header[2] = {faces, 0};
        std::ranges::copy(layout.levels, header.begin() + RangeFaces::kRangeFirstLevel);

        const Argument layout_argument[] = {{"shadow_ranges", ranges.buffer}};
        const uint levels_first = RangeFaces::kRangeHeader + faces;
        const uint cells = layout.cells * layout.cells;
        for (uint light = 0, face = 0; light < scene.lights.size(); ++light) {
            if (scene.lights[light].shadowless != 0)
                continue;
            const uint own_faces = scene.lights[light].kind == kLightDirectional ? 1 : 6;
            const uint first = levels_first + face * layout.face_ranges;
            const RangeCells::Params finest{light, first, layout.face_ranges, layout.cells};
            context.dispatch(kRangeCells, finest, own_faces * cells);
            for (uint level = 1; level <= top; ++level) {
                const auto [source, source_edge] =
                    std::pair(layout.levels[level - 1].x, layout.levels[level - 1].y);
                const uint edge = layout.levels[level].y;
                const RangeBlocks::Params blocks{.source = first + source,
                                                 .source_edge = source_edge,
                                                 .level = first + layout.levels[level].x,
                                                 .edge = edge,
                                                 .face_ranges = layout.face_ranges,
                                                 .spread = layout.is_hsm ? 2u : 1u,
                                                 .offset = layout.is_hsm ? 1u : 1u << (level - 1)};
                context.dispatch(kRangeBlocks, blocks, own_faces * edge * edge);
            }
            const RangeFaces::Params all{light, face};
            context.dispatch(kRangeFaces, all, own_faces, layout_argument);
            face += own_faces;
        }
    }
};

} // namespace

PassType shadowRangePass() {
    return PassType("shadow_range", "Finds how near and far shadow maps are in any rectangle")
        .in("scene", types::kScene, "its lights")
        .in("shadow_maps", types::kShadowMaps, "depth seen from their centres")
        .out("ranges", types::kShadowRanges, "see passes/shading/shadow_range.glsl.h", recordSize)
        .param("query", {"hsm", "nbuffer"}, "hsm: small; nbuffer: exact")
        .param("levels", 6u, {.min = 1, .max = 12},
               "nbuffer: the largest squares are 2^levels cells of 2 x 2 texels")
        .param("size", 1024u, {.min = 16, .max = 8192},
               "texels along a face's edge; that of shadow_map")
        .implementedBy<ShadowRange>(Domain::kEither);
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/shading/lens_blur.h"

#include "hone_spirv/blur_reach.h"
#include "hone_spirv/blur_tiles.h"
#include "hone_spirv/confusion.h"

#include "hone/core/device/kernel.glsl.h"

#include <numeric>

namespace hone {
namespace {

struct Confusion : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/shading/confusion.glsl.h"
};
struct BlurTiles : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/shading/blur_tiles.glsl.h"
};
struct BlurReach : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/shading/blur_reach.glsl.h"
};
constexpr Kernel kConfusion = makeKernel<Confusion>("confusion", spirv::confusion);
constexpr Kernel kBlurTiles = makeKernel<BlurTiles>("blur_tiles", spirv::blur_tiles);
constexpr Kernel kBlurReach = makeKernel<BlurReach>("blur_reach", spirv::blur_reach);

} // namespace

void LensBlur::prepare(PassContext& context, float radius_limit) {
    const uvec2 extent = context.extent;
    const uint pixels = extent.x * extent.y;
    const uvec2 tiles = LensBlur::tiles(extent);
    tile_count_ = std::size_t{tiles.x} * tiles.y;
    Device& memory = *context.memory;
    if (confusion_.bytes() < pixels * sizeof(float))
        confusion_ = memory.createBuffer(pixels * sizeof(float), "confusion");
    if (tiles_.bytes() < tile_count_ * sizeof(float)) {
        tiles_ = memory.createBuffer(tile_count_ * sizeof(float), "blur_tiles");
        reach_ = memory.createBuffer(tile_count_ * sizeof(float), "blur_reach");
        limited_ = memory.createBuffer(tile_count_ * sizeof(uint), "limited");
    }
    const Argument buffers[] = {{"confusion", confusion_.view()},
                                {"blur_tiles", tiles_.view()},
                                {"blur_reach", reach_.view()},
                                {"limited", limited_.view()}};
    const uint count = static_cast<uint>(tile_count_);
    context.dispatch(kConfusion, Confusion::Params{context.camera(), extent}, pixels, buffers);
    context.dispatch(kBlurTiles, BlurTiles::Params{extent, tiles, kTile, radius_limit}, count,
                     buffers);
    context.dispatch(kBlurReach, BlurReach::Params{tiles, kTile, radius_limit}, count, buffers);
}

std::array<Argument, 2> LensBlur::arguments() const {
    return {Argument{"confusion", confusion_.view()}, Argument{"blur_reach", reach_.view()}};
}

std::size_t LensBlur::limitedPixels() const {
    const std::span<const uint> limited = limited_.as<uint>().first(tile_count_);
    return std::accumulate(limited.begin(), limited.end(), std::size_t{0});
}

} // namespace hone

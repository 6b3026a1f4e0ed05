// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/raster/cast_hits.h"

#include "hone/core/device/kernel.glsl.h"
#include "hone/core/image/tile_order.h"

#include <tbb/parallel_for.h>

namespace hone {
namespace {

/// Tiles that are asked together: their rays stay in the caches.
constexpr uint kWaveTiles = 32;

struct Cameras : HostKernel {
    using HostKernel::HostKernel;
#include "hone/core/scene/camera.glsl.h"
};

} // namespace

void CastHits::cast(PassContext& context, const Camera& camera, const TraceBackend& backend,
                    BufferView hits) {
    const std::size_t most = std::size_t{kWaveTiles} * TileOrder::kTilePixels;
    if (!rays_) {
        rays_ = context.memory->createBuffer(most * sizeof(Ray), "visibility_rays");
        answers_ = context.memory->createBuffer(most * sizeof(Hit), "visibility_answers");
    }
    const std::span<Ray> rays = rays_.as<Ray>();
    const std::span<Hit> answers = answers_.as<Hit>();
    const std::span<Hit> seen = hits.as<Hit>();
    const uvec2 extent = context.extent;
    const TileOrder order(extent);
    const uint tiles = order.tiles().x * order.tiles().y;
    const Arguments no_arguments;
    for (uint begin = 0; begin < tiles; begin += kWaveTiles) {
        const uint end = std::min(begin + kWaveTiles, tiles);
        const uint first = order.firstRank(begin);
        const std::size_t count = order.firstRank(end) - first;
        tbb::parallel_for(begin, end, [&](uint tile) {
            Cameras cameras(no_arguments, nullptr);
            Ray* next = rays.data() + (order.firstRank(tile) - first);
            order.forEachPixel(tile, [&](uint pixel) {
                *next++ = cameras.cameraRay(camera, extent, cameras.pixelCenter(pixel, extent));
            });
        });
        backend.closest(rays.first(count), answers.first(count), Coherence::kCoherent, {});
        tbb::parallel_for(begin, end, [&](uint tile) {
            const Hit* next = answers.data() + (order.firstRank(tile) - first);
            order.forEachPixel(tile, [&](uint pixel) { seen[pixel] = *next++; });
        });
    }
    context.counters->add("rays.visibility", std::uint64_t{extent.x} * extent.y);
}

} // namespace hone

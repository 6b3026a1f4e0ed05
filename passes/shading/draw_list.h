// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/passes/shading/view.glsl.h"
#include "hone/passes/shading/world_geometry.h"

#include <vector>

namespace hone {

/// What a view leaves out besides what lies outside of it.
struct Culling {
    bool back_faces = true; ///< of materials without kMaterialTwoSided, as closest hits ignore them
    uint without = kNone;   ///< an instance that is not drawn
};

/// The triangles that a view may see, as draws: clusters outside the view or turned away from it
/// are dropped, the rest go front to back, and of those the triangles that face away are dropped.
///
/// The index list is written anew for each view. It costs the host about 1 ms for 100,000
/// triangles, and on software devices saves far more: half the vertices are never transformed, and
/// a few large draws replace thousands of small ones.
class DrawList {
public:
    /// Builds the list for `view`. `world` is up to date with `scene`. Allocates only to grow.
    void build(Device& device, const Scene& scene, const WorldGeometry& world, const View& view,
               const Culling& culling);

    /// World vertices, three a triangle.
    [[nodiscard]] BufferView indices() const { return indices_.view(); }
    /// (instance, primitive) of each triangle; a draw's first_instance is where its own begin.
    [[nodiscard]] BufferView triangleIds() const { return ids_.view(); }
    /// DrawIndexed records. Masked materials apart, for their shader looks at alpha.
    [[nodiscard]] BufferView opaqueDraws() const;
    [[nodiscard]] BufferView maskedDraws() const;
    [[nodiscard]] std::size_t triangles() const; ///< in all draws

private:
    struct Visible {
        float distance; ///< from the eye to the nearest point of the bounding sphere
        uint cluster;   ///< in WorldGeometry::clusters
    };
    struct Chunk {
        std::size_t begin, end; ///< in visible_
        uint first_triangle;    ///< where it writes
    };
    void findVisible(const Scene& scene, const WorldGeometry& world, const View& view,
                     const Culling& culling);
    void cutChunks(const Scene& scene, const WorldGeometry& world);
    uint writeChunk(const Chunk& chunk, const Scene& scene, const WorldGeometry& world,
                    const View& view, const Culling& culling) const;

    std::vector<vec3> eyes_; ///< the view's position in each instance's object space
    std::vector<Visible> visible_;
    std::size_t opaque_ = 0; ///< the first so many of visible_ are opaque, the rest masked
    std::vector<Chunk> chunks_;
    std::size_t opaque_chunks_ = 0;
    uint capacity_needed_ = 0;
    Buffer indices_, ids_, draws_;
};

} // namespace hone

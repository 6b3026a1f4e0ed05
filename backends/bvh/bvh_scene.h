// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/backends/bvh/bvh.glsl.h"
#include "hone/core/scene/host_surface.h"
#include "hone/core/trace/bvh.h"

#include <cstdint>
#include <vector>

namespace hone {

/// A scene as the traversal reads it: the records of bvh.glsl.h.
///
/// Meshes stand in the world, with worldPosition()'s own corners, in one flat tree; those whose
/// copies would fill memory (chooseInstanced) have a tree of their own, and instances in the
/// world's tree lead to it.
class BvhScene {
public:
    /// Borrows `scene`. Throws what `builder` throws, and DeviceError for more nodes than links can
    /// name.
    BvhScene(const Scene& scene, const BvhBuilder& builder, std::size_t flatten_triangles);

    /// Follows instances that moved: new corners, and boxes that hold them. False, and nothing is
    /// changed, if one that has a tree of its own lost its inverse: build anew.
    [[nodiscard]] bool update(std::span<const uint> moved);

    [[nodiscard]] std::span<const BvhNode> nodes() const { return nodes_; }
    [[nodiscard]] std::span<const uint> skips() const { return skips_; } ///< by octant, by node
    [[nodiscard]] std::span<const BvhTriangle> triangles() const { return triangles_; }
    [[nodiscard]] std::span<const BvhInstance> instances() const { return instances_; }
    [[nodiscard]] uint worldNodes() const { return world_nodes_; }
    [[nodiscard]] float extent() const; ///< the greatest coordinate of the world's tree
    [[nodiscard]] bool isMasked() const { return is_masked_; }
    /// Of all trees, each counted once.
    [[nodiscard]] std::size_t triangleCount() const { return triangle_count_; }

private:
    /// A triangle before it has a place in a tree; `placed`: its instance, or null in a mesh's own
    /// space.
    [[nodiscard]] BvhTriangle makeTriangle(const Instance* placed, uint instance, const Mesh& mesh,
                                           uint primitive) const;
    void placeTriangle(const Instance* placed, const Mesh& mesh, BvhTriangle& triangle) const;
    [[nodiscard]] static Bvh buildTriangles(std::span<const BvhTriangle> triangles,
                                            const BvhBuilder& builder);
    /// Takes the instance's place from the scene; returns its box in the world.
    Bounds placeInstance(BvhInstance& placed, const Bounds& object_bounds) const;
    void append(const Bvh& tree, std::span<const BvhTriangle> triangles);
    void appendWorld(const Bvh& flat, std::span<const BvhTriangle> triangles, const Bvh& placed);
    void link();
    void writeBox(uint index);

    const Scene* scene_;
    HostSurface surface_;
    std::vector<BvhNode> nodes_;
    std::vector<Bounds> bounds_; ///< by node, exact
    std::vector<uint> skips_;
    std::vector<BvhTriangle> triangles_;
    std::vector<BvhInstance> instances_;
    std::vector<uint> roots_; ///< of all trees; the world's is first if it has nodes
    uint world_nodes_ = 0;
    uint world_triangles_ = 0; ///< triangles_ that lie in the world's tree
    std::size_t triangle_count_ = 0;
    bool is_masked_ = false;
};

} // namespace hone

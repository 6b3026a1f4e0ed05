// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/backends/embree/embree_device.h"
#include "hone/backends/embree/world_vertices.h"
#include "hone/core/scene/host_surface.h"

#include <array>
#include <span>
#include <vector>

namespace hone {

/// Some of a scene's instances as Embree traces them. Geometry ids are instance numbers.
struct EmbreePart {
    /// How an instance of the part is seen.
    struct Facing {
        /// 0 if both faces are seen, else the sign that makes the slope of a back face positive.
        float back_sign = 0;
        bool has_left = false; ///< it stands in the other part now: what is met here is not there
    };

    SceneOwner scene;
    std::vector<Facing> facing; ///< by instance
};

/// A scene as Embree traces it, in two parts: what stands still, in a tree that took its time, and
/// what has moved since, in a tree of trees of which only the moved are made anew. A query asks
/// one part after the other.
///
/// Meshes stand in the world, with worldPosition()'s own vertices, in one flat tree, which is
/// fastest and rounds as shading does; a mesh whose copies would fill memory (EmbreeParams) gets a
/// tree of its own and Embree instances. Embree reads the scene's own triangles and, where nothing
/// is moved, positions.
class EmbreeTree {
public:
    /// Borrows `device` and `scene`. Throws OutOfMemory, DeviceError.
    EmbreeTree(EmbreeDevice& device, const Scene& scene, std::size_t flatten_triangles);
    EmbreeTree(const EmbreeTree&) = delete;
    EmbreeTree& operator=(const EmbreeTree&) = delete;

    /// Follows instances that moved in the scene. False if the whole tree must be built anew: an
    /// instance of a mesh with a tree of its own was flattened. Throws OutOfMemory, DeviceError;
    /// then, too, it must be built anew.
    [[nodiscard]] bool move(std::span<const uint> moved);

    /// What a query asks, in this order.
    [[nodiscard]] std::span<const EmbreePart> parts() const {
        return std::span(parts_).first(parts_[1].scene.handle() != nullptr ? 2 : 1);
    }
    /// The filter of occlusion queries; null if all that is met is there.
    [[nodiscard]] RTCFilterFunctionN occlusionFilter() const {
        return left_weight_ > 0 ? rejectLeft : nullptr;
    }
    [[nodiscard]] std::size_t triangles() const { return triangles_; }
    /// Of derived vertices, which Embree does not count.
    [[nodiscard]] std::size_t vertexBytes() const { return vertices_.bytes(); }
    /// Whether packets may carry Embree's coherent flag: not through Embree instances, where Embree
    /// 3.13.5 sometimes loops for ever in rtcOccluded16 (AVX-512, seen with one ray in the packet).
    [[nodiscard]] bool takesCoherentPackets() const { return !has_instances_; }

    /// The filter of closest queries. Keeps in QueryContext::nearest the seen hit with the least
    /// (t, instance, primitive).
    ///
    /// Why Embree's own choice is not enough: packets test a leaf for all their rays, so equal t
    /// (shared edges, coplanar faces) are settled by what the other rays visit, and a kernel may
    /// take a hit slightly beyond the last. So ties are settled here, candidates a little beyond
    /// are asked for (slack), and back faces of single-sided materials are passed by.
    static void keepNearest(const RTCFilterFunctionNArguments* arguments);

private:
    static void rejectHoles(const RTCFilterFunctionNArguments* arguments);
    static void rejectLeft(const RTCFilterFunctionNArguments* arguments);

    [[nodiscard]] EmbreePart& still() { return parts_[0]; }
    [[nodiscard]] EmbreePart& moving() { return parts_[1]; }
    void buildStill();
    void enterMoving(uint index);
    void follow(uint index);

    [[nodiscard]] const Mesh& meshOf(uint index) const;
    [[nodiscard]] bool isInstanced(uint index) const;
    [[nodiscard]] EmbreePart::Facing facingOf(uint index) const;
    [[nodiscard]] std::size_t weightOf(uint index) const;
    SceneOwner makeScene(RTCBuildQuality quality, RTCSceneFlags flags);
    GeometryOwner makeGeometry(uint index, RTCBuildQuality quality);
    GeometryOwner makeTriangles(const Mesh& mesh, std::span<const vec3> vertices,
                                RTCBuildQuality quality);
    void commit(RTCScene scene);

    EmbreeDevice* device_;
    const Scene* source_;
    HostSurface surface_;
    std::vector<std::uint8_t> is_instanced_; ///< by mesh: has a tree of its own
    WorldVertices vertices_;
    std::vector<SceneOwner> mesh_trees_;       ///< by mesh; empty for meshes in the flat tree
    std::vector<GeometryOwner> moving_things_; ///< by instance; empty for those that stand still
    std::array<EmbreePart, 2> parts_;          ///< still, moving
    bool has_instances_ = false;
    std::size_t triangles_ = 0;
    std::size_t still_weight_ = 0; ///< of what is in the still part's tree
    std::size_t left_weight_ = 0;  ///< of what left it since that was built
};

} // namespace hone

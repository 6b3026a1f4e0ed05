// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/backends/embree/embree_shim.h"
#include "hone/core/scene/host_surface.h"

#include <atomic>
#include <memory>
#include <string>
#include <vector>

namespace hone {

/// Embree itself, with the first error it reported and the memory it holds. Not movable: Embree's
/// callbacks point into it.
class EmbreeDevice {
public:
    /// Throws DeviceError if the library cannot start.
    EmbreeDevice();
    EmbreeDevice(const EmbreeDevice&) = delete;
    EmbreeDevice& operator=(const EmbreeDevice&) = delete;

    [[nodiscard]] RTCDevice handle() const { return device_.handle(); }
    [[nodiscard]] std::size_t bytes() const;
    /// Throws OutOfMemory or DeviceError, naming `call`, if Embree reported an error since the last
    /// check.
    void check(const char* call);

private:
    std::atomic<std::int64_t> bytes_ = 0;
    std::atomic<RTCError> error_ = RTC_ERROR_NONE;
    DeviceOwner device_; // last, so that it goes first: its release still reports memory
};

/// A scene as Embree traces it. Geometry ids are instance numbers.
///
/// Meshes stand in the world, with worldPosition()'s own vertices, in one flat tree, which is
/// fastest and rounds as shading does; a mesh whose copies would fill memory (EmbreeParams)
/// gets a tree of its own and Embree instances.
class EmbreeTree {
public:
    /// Borrows `device` and `scene`. Throws OutOfMemory, DeviceError.
    EmbreeTree(EmbreeDevice& device, const Scene& scene, std::size_t flatten_triangles);
    EmbreeTree(const EmbreeTree&) = delete;
    EmbreeTree& operator=(const EmbreeTree&) = delete;

    [[nodiscard]] RTCScene handle() const { return scene_.handle(); }
    [[nodiscard]] std::size_t triangles() const { return triangles_; }
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

    void addInstance(EmbreeDevice& device, uint index);
    GeometryOwner makeTriangles(EmbreeDevice& device, const Mesh& mesh, const Instance* placed);
    SceneOwner makeScene(EmbreeDevice& device) const;

    const Scene* source_;
    HostSurface surface_;
    /// By instance: 0 if both faces are seen, else the sign that makes the slope of a back face
    /// positive.
    std::vector<float> facing_;
    std::vector<std::uint8_t> is_instanced_; ///< by mesh: has a tree of its own
    bool has_instances_ = false;
    std::size_t triangles_ = 0;
    std::vector<SceneOwner> mesh_trees_; ///< by mesh; empty for meshes in the flat tree
    std::vector<uint> slots_; ///< scratch of makeTriangles: each position's number in the geometry
    SceneOwner scene_;
};

} // namespace hone

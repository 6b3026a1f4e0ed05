// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/backends/vulkan/triangle_soup.h"
#include "hone/backends/vulkan/vulkan_acceleration.h"
#include "hone/backends/vulkan/vulkan_tracers.h"
#include "hone/backends/vulkan/vulkan_tree.glsl.h"

#include <array>
#include <cstdint>
#include <vector>

namespace hone {

/// A scene as a Vulkan device traces it: acceleration structures, and the names of their triangles.
///
/// Meshes stand in the world in two flat structures, one of single-sided and one of two-sided
/// triangles, because an instance says whether back faces can be culled (on a software device, in
/// one for each of them); in each, masked triangles are a geometry of their own, so that opaque
/// ones are settled without a shader. A mesh whose copies would fill memory (chooseInstanced) gets
/// a structure in its own space and an instance for each copy.
class VulkanSceneTree {
public:
    /// Builds and waits. Borrows `device` and `scene`. `is_refitted`: update() may be called, at
    /// the price of memory for the corners and, on some devices, of slower queries.
    /// Throws OutOfMemory, DeviceError.
    VulkanSceneTree(Device& device, const Scene& scene, const RayTracerParams& params,
                    bool is_refitted);
    VulkanSceneTree(const VulkanSceneTree&) = delete;

    /// Follows instances that moved. False if the scene's structure must be made anew: triangles
    /// lost or gained their area, or an instance its inverse.
    [[nodiscard]] bool update(std::span<const uint> moved);

    /// Without triangles there is nothing to trace.
    [[nodiscard]] bool empty() const { return triangles_ == 0; }
    [[nodiscard]] bool isRefitted() const { return is_refitted_; }
    /// TraceParams::tree.
    [[nodiscard]] uvec2 address() const;
    /// Binds tree_places and tree_triangles.
    void bind(Arguments& arguments) const;

    [[nodiscard]] std::size_t triangles() const { return triangles_; }
    [[nodiscard]] std::size_t bytes() const;
    /// Of corners that are kept.
    [[nodiscard]] std::size_t copiedBytes() const { return corners_.bytes(); }

private:
    /// Consecutive triangles of the soup.
    struct Stretch {
        uint first = 0;
        uint count = 0;
        [[nodiscard]] uint end() const { return first + count; }
    };
    /// A flat structure: opaque and masked triangles, either possibly none.
    struct FlatTree {
        bool is_two_sided = false;
        std::array<Stretch, 2> geometries;
        std::size_t moved = 0; ///< triangles, during an update
    };

    [[nodiscard]] bool isInstanced(uint instance) const;
    [[nodiscard]] uint flagsOf(uint mesh) const;
    /// The instances of each flat structure; all of one are single-sided, or all two-sided.
    [[nodiscard]] std::vector<std::vector<uint>> groupFlat() const;
    void addFlat(TriangleSoup& soup);
    void addMeshes(TriangleSoup& soup);
    [[nodiscard]] AddressedBuffer upload(const TriangleSoup& soup, Stretch stretch) const;
    void makeInputs(const AddressedBuffer& meshes);
    void writePlaces();
    void build();

    Device* device_;
    VulkanInside inside_;
    const Scene* scene_;
    HostSurface surface_;
    RayTracerParams params_;
    bool is_refitted_;
    std::vector<std::uint8_t> is_instanced_; ///< by mesh
    std::size_t triangles_ = 0;
    std::vector<Stretch> by_instance_; ///< of flat triangles
    std::vector<Stretch> by_mesh_;     ///< of triangles of instanced meshes
    std::vector<FlatTree> flat_;
    AddressedBuffer corners_; ///< of flat triangles; kept where they may move
    AddressedBuffer placed_;  ///< VkAccelerationStructureInstanceKHR
    Buffer names_;            ///< tree_triangles
    Buffer places_;           ///< tree_places
    std::vector<TreeInput> flat_inputs_, mesh_inputs_;
    std::vector<TreeInput> top_input_; ///< one
    TreeStore flat_store_, mesh_store_, top_store_;
};

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/backends/vulkan/vulkan_addressed_buffer.h"
#include "hone/backends/vulkan/vulkan_inside.h"

#include <cstdint>
#include <vector>

namespace hone {

/// What one acceleration structure is built from: triangles of the scene (bottom level), or
/// placed structures (top level). Only what addresses name is borrowed.
struct TreeInput {
    VkAccelerationStructureTypeKHR type = VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR;
    bool is_refitted = false; ///< may follow moved triangles without being built anew
    std::vector<VkAccelerationStructureGeometryKHR> geometries;
    std::vector<std::uint32_t> counts; ///< primitives by geometry

    /// Adds `count` triangles of three consecutive vec3 at `corners`.
    void addTriangles(VkDeviceAddress corners, std::uint32_t count, bool is_opaque);
    /// Adds `count` VkAccelerationStructureInstanceKHR at `instances`.
    void addInstances(VkDeviceAddress instances, std::uint32_t count);
};

/// Acceleration structures that lie one after another in one buffer. They are made empty and must
/// be built before they are traced.
class TreeStore {
public:
    TreeStore() = default;
    /// One structure for each input. Throws OutOfMemory; DeviceError where the device takes fewer
    /// primitives than there are, naming both.
    TreeStore(const VulkanInside& inside, const std::vector<TreeInput>& inputs, const char* name);

    enum class Build : std::uint8_t { kAnew, kRefit };
    /// Records the builds, one after another, of all structures or one. Allocates nothing.
    void record(const VulkanInside& inside, const std::vector<TreeInput>& inputs, Build build);
    void record(const VulkanInside& inside, const TreeInput& input, std::size_t which, Build build);
    /// Gives back what builds scratch on; none may be pending, and none comes after it.
    void releaseScratch() { scratch_ = {}; }

    [[nodiscard]] std::size_t size() const { return trees_.size(); }
    /// What instances and shaders name a structure by.
    [[nodiscard]] VkDeviceAddress address(std::size_t which) const { return addresses_[which]; }
    /// Without scratch memory.
    [[nodiscard]] VkDeviceSize bytes() const { return store_.bytes(); }

private:
    AddressedBuffer store_; // first, so that it goes last
    AddressedBuffer scratch_;
    std::vector<OwnedAccelerationStructure> trees_;
    std::vector<VkDeviceAddress> addresses_;
};

} // namespace hone

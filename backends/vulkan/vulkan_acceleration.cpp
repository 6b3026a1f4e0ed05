// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan/vulkan_acceleration.h"

#include "hone/core/error.h"
#include "hone/core/math.h"

#include <algorithm>
#include <string>

namespace hone {
namespace {

/// Where a structure may begin in its buffer, by the standard.
constexpr VkDeviceSize kTreeAlignment = 256;

VkPhysicalDeviceAccelerationStructurePropertiesKHR limitsOf(const VulkanContext& context) {
    VkPhysicalDeviceAccelerationStructurePropertiesKHR limits{};
    limits.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &limits;
    vkGetPhysicalDeviceProperties2(context.chosen().device, &properties);
    return limits;
}

void checkCount(const VulkanContext& context, const TreeInput& input, const char* name) {
    const auto limits = limitsOf(context);
    const bool is_top = input.type == VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR;
    const std::uint64_t most = is_top ? limits.maxInstanceCount : limits.maxPrimitiveCount;
    std::uint64_t count = 0;
    for (const std::uint32_t primitives : input.counts)
        count += primitives;
    if (count > most)
        throw DeviceError(std::string(name) + " has " + std::to_string(count) +
                          (is_top ? " instances; " : " triangles in one tree; ") +
                          context.chosen().report.name + " takes " + std::to_string(most) +
                          "; trace with embree");
}

VkAccelerationStructureBuildGeometryInfoKHR buildInfo(const TreeInput& input) {
    VkAccelerationStructureBuildGeometryInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR;
    info.type = input.type;
    info.flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR;
    if (input.is_refitted)
        info.flags |= VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_UPDATE_BIT_KHR;
    info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
    info.geometryCount = static_cast<std::uint32_t>(input.geometries.size());
    info.pGeometries = input.geometries.data();
    return info;
}

VkDeviceSize roundUp(VkDeviceSize value, VkDeviceSize multiple) {
    return (value + multiple - 1) / multiple * multiple;
}

} // namespace

void TreeInput::addTriangles(VkDeviceAddress corners, std::uint32_t count, bool is_opaque) {
    VkAccelerationStructureGeometryKHR geometry{};
    geometry.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR;
    geometry.geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR;
    // A triangle that is not opaque is asked about once, however a tree holds it.
    geometry.flags = is_opaque ? VK_GEOMETRY_OPAQUE_BIT_KHR
                               : VK_GEOMETRY_NO_DUPLICATE_ANY_HIT_INVOCATION_BIT_KHR;
    auto& triangles = geometry.geometry.triangles;
    triangles = {};
    triangles.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR;
    triangles.vertexFormat = VK_FORMAT_R32G32B32_SFLOAT;
    triangles.vertexData.deviceAddress = corners;
    triangles.vertexStride = sizeof(vec3);
    triangles.maxVertex = count > 0 ? 3 * count - 1 : 0;
    triangles.indexType = VK_INDEX_TYPE_NONE_KHR;
    geometries.push_back(geometry);
    counts.push_back(count);
}

void TreeInput::addInstances(VkDeviceAddress instances, std::uint32_t count) {
    type = VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR;
    VkAccelerationStructureGeometryKHR geometry{};
    geometry.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR;
    geometry.geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR;
    auto& placed = geometry.geometry.instances;
    placed = {};
    placed.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR;
    placed.data.deviceAddress = instances;
    geometries.push_back(geometry);
    counts.push_back(count);
}

TreeStore::TreeStore(const VulkanInside& inside, const std::vector<TreeInput>& inputs,
                     const char* name) {
    const VulkanContext& context = inside.context();
    const auto size_of =
        HONE_DEVICE_CALL(context.device(), vkGetAccelerationStructureBuildSizesKHR);
    struct Stretch {
        VkDeviceSize offset, bytes;
    };
    std::vector<Stretch> stretches;
    VkDeviceSize end = 0;
    VkDeviceSize scratch_bytes = 4;
    for (const TreeInput& input : inputs) {
        checkCount(context, input, name);
        VkAccelerationStructureBuildSizesInfoKHR sizes{};
        sizes.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR;
        const auto info = buildInfo(input);
        size_of(context.device(), VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &info,
                input.counts.data(), &sizes);
        stretches.push_back({end, sizes.accelerationStructureSize});
        end = roundUp(end + sizes.accelerationStructureSize, kTreeAlignment);
        scratch_bytes = std::max({scratch_bytes, sizes.buildScratchSize, sizes.updateScratchSize});
    }
    if (inputs.empty())
        return;
    store_ = AddressedBuffer(context, inside.resources->memory, end,
                             VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR,
                             AddressedBuffer::Place::kDevice, name);
    scratch_ =
        AddressedBuffer(context, inside.resources->memory, scratch_bytes,
                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, AddressedBuffer::Place::kDevice, name,
                        limitsOf(context).minAccelerationStructureScratchOffsetAlignment);
    const auto address_of =
        HONE_DEVICE_CALL(context.device(), vkGetAccelerationStructureDeviceAddressKHR);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        VkAccelerationStructureCreateInfoKHR info{};
        info.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR;
        info.buffer = store_.handle();
        info.offset = stretches[i].offset;
        info.size = stretches[i].bytes;
        info.type = inputs[i].type;
        const auto& tree = trees_.emplace_back(context.device(), info, name);
        context.setName(VK_OBJECT_TYPE_ACCELERATION_STRUCTURE_KHR, tree.handle(), name);
        VkAccelerationStructureDeviceAddressInfoKHR asked{};
        asked.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR;
        asked.accelerationStructure = tree.handle();
        addresses_.push_back(address_of(context.device(), &asked));
    }
}

void TreeStore::record(const VulkanInside& inside, const TreeInput& input, std::size_t which,
                       Build build) {
    HONE_ASSERT(scratch_.bytes() > 0, "a build after releaseScratch()");
    VkAccelerationStructureBuildGeometryInfoKHR info = buildInfo(input);
    info.dstAccelerationStructure = trees_[which].handle();
    if (build == Build::kRefit) {
        info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_UPDATE_KHR;
        info.srcAccelerationStructure = trees_[which].handle();
    }
    info.scratchData.deviceAddress = scratch_.address();
    std::vector<VkAccelerationStructureBuildRangeInfoKHR> ranges;
    for (const std::uint32_t count : input.counts)
        ranges.push_back({.primitiveCount = count,
                          .primitiveOffset = 0,
                          .firstVertex = 0,
                          .transformOffset = 0});
    const auto* range = ranges.data();
    const auto build_trees =
        HONE_DEVICE_CALL(inside.context().device(), vkCmdBuildAccelerationStructuresKHR);
    build_trees(inside.encoder->next(), 1, &info, &range);
}

void TreeStore::record(const VulkanInside& inside, const std::vector<TreeInput>& inputs,
                       Build build) {
    for (std::size_t i = 0; i < inputs.size(); ++i)
        record(inside, inputs[i], i, build);
}

} // namespace hone

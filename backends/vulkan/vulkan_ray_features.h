// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/backends/vulkan/vulkan_check.h"
#include "hone/backends/vulkan/vulkan_tracers.h"

#include <vector>

namespace hone {

/// What a physical device offers in full: extensions and features.
[[nodiscard]] RayTracing findRayTracing(VkPhysicalDevice device);

/// The extensions and features of the kinds of ray tracing that are asked for, for vkCreateDevice;
/// none where none is asked. Not copyable: it points into itself.
struct VulkanRayFeatures {
    explicit VulkanRayFeatures(RayTracing wanted);
    VulkanRayFeatures(const VulkanRayFeatures&) = delete;

    std::vector<const char*> extensions;
    void* chain = nullptr; ///< of feature structures; needs bufferDeviceAddress beside it
    VkPhysicalDeviceAccelerationStructureFeaturesKHR tree{};
    VkPhysicalDeviceRayQueryFeaturesKHR query{};
    VkPhysicalDeviceRayTracingPipelineFeaturesKHR pipeline{};
};

} // namespace hone

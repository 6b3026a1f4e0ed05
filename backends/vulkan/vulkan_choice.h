// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/backends/vulkan/vulkan_instance.h"

#include <cstdint>
#include <string>
#include <vector>

namespace hone {

/// A physical device and what hone wants to know of it before it opens it.
struct VulkanCandidate {
    VkPhysicalDevice device = VK_NULL_HANDLE;
    VkPhysicalDeviceProperties properties{};
    VulkanDeviceReport report;
    std::uint32_t queue_family = 0; ///< graphics and compute; valid if report.usable
    VkDeviceSize max_buffer_bytes = 0;
    VkDeviceSize max_allocation_bytes = 0;
    VkDeviceSize host_import_alignment = 0; ///< hostImportAlignment()
    bool multi_draw = false;                ///< one indirect call may hold several draws
};

/// All physical devices in the loader's order, with what each lacks.
[[nodiscard]] std::vector<VulkanCandidate> findCandidates(const VulkanInstance& instance);

/// The device that `wish` (VulkanOptions::device) names, or the best usable one.
/// Throws DeviceError that lists what was found.
[[nodiscard]] const VulkanCandidate& choose(const std::vector<VulkanCandidate>& candidates,
                                            const std::string& wish);

/// The features that hone enables, as a chain for vkCreateDevice. Not copyable: it points into
/// itself.
struct VulkanFeatures {
    VulkanFeatures();
    VulkanFeatures(const VulkanFeatures&) = delete;

    VkPhysicalDeviceFeatures2 core{};
    VkPhysicalDeviceVulkan12Features v12{};
    VkPhysicalDeviceVulkan13Features v13{};
};

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/backends/vulkan/vulkan_choice.h"

#include <string_view>

namespace hone {

/// The opened device, its one queue, and what the rest of the backend asks about it.
class VulkanContext {
public:
    explicit VulkanContext(const VulkanOptions& options);
    VulkanContext(VulkanContext&&) = delete;

    [[nodiscard]] VkDevice device() const { return device_.handle(); }
    [[nodiscard]] VkQueue queue() const { return queue_; }
    [[nodiscard]] const VulkanCandidate& chosen() const { return chosen_; }
    [[nodiscard]] const VkPhysicalDeviceLimits& limits() const { return chosen_.properties.limits; }
    [[nodiscard]] const VkPhysicalDeviceMemoryProperties& memory() const { return memory_; }
    /// Nanoseconds a timestamp counts; 0 if the queue has no clock.
    [[nodiscard]] double timestampPeriodNs() const { return timestamp_period_ns_; }

    /// Names an object in validation messages and captures.
    template <class Handle>
    void setName(VkObjectType type, Handle handle, std::string_view name) const {
        setName(type, reinterpret_cast<std::uint64_t>(handle), name);
    }
    void setName(VkObjectType type, std::uint64_t handle, std::string_view name) const;
    void beginLabel(VkCommandBuffer commands, const char* name) const;
    void endLabel(VkCommandBuffer commands) const;

private:
    VulkanInstance instance_;
    VulkanCandidate chosen_;
    OwnedDevice device_;
    VkQueue queue_ = VK_NULL_HANDLE;
    VkPhysicalDeviceMemoryProperties memory_{};
    double timestamp_period_ns_ = 0;
    // Null where the loader has no VK_EXT_debug_utils.
    PFN_vkSetDebugUtilsObjectNameEXT set_name_ = nullptr;
    PFN_vkCmdBeginDebugUtilsLabelEXT begin_label_ = nullptr;
    PFN_vkCmdEndDebugUtilsLabelEXT end_label_ = nullptr;
};

} // namespace hone

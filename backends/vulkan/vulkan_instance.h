// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/backends/vulkan/vulkan_device.h"
#include "hone/backends/vulkan/vulkan_objects.h"

#include <memory>
#include <vector>

namespace hone {

/// A headless VkInstance with debug names, and with the validation layer where asked.
/// Messages of the layer go to options.on_message, or are logged as warnings without one.
/// Throws DeviceError if there is no driver or the layer is not installed.
class VulkanInstance {
public:
    explicit VulkanInstance(const VulkanOptions& options);
    VulkanInstance(VulkanInstance&&) = delete;
    ~VulkanInstance();

    [[nodiscard]] VkInstance handle() const { return instance_.handle(); }
    [[nodiscard]] std::vector<VkPhysicalDevice> physicalDevices() const;

private:
    std::function<void(std::string_view)> on_message_;
    OwnedInstance instance_;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
};

} // namespace hone

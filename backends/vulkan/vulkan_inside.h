// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/backends/vulkan/vulkan_encoder.h"

namespace hone {

/// What a Vulkan device is made of, for the tracers of this backend that run on one. Borrowed;
/// valid as long as the device.
struct VulkanInside {
    VulkanResources* resources = nullptr;
    VulkanEncoder* encoder = nullptr;
    [[nodiscard]] const VulkanContext& context() const { return resources->context; }
};

/// Empty for a device that makeVulkanDevice() did not make.
[[nodiscard]] VulkanInside insideOf(Device& device);

} // namespace hone

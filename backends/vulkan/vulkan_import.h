// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/backends/vulkan/vulkan_buffer.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace hone {

/// What host memory must be a multiple of, begin and size, for buffers to use it where it is
/// (VK_EXT_external_memory_host); 0 if the device cannot.
[[nodiscard]] VkDeviceSize hostImportAlignment(VkPhysicalDevice device);

/// A buffer that is these bytes, which Device::importBuffer() says more of. Empty, with a word in
/// the log, where this memory or this device does not allow it.
[[nodiscard]] std::optional<VulkanBuffer>
importHostMemory(const VulkanContext& context, std::span<std::byte> bytes, std::string_view name);

} // namespace hone

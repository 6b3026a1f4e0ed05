// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vulkan/vulkan.h>

namespace hone {

/// "VK_ERROR_DEVICE_LOST", for example.
[[nodiscard]] const char* resultName(VkResult result);

/// Passes on results >= 0. Throws OutOfMemory for the two out-of-memory results and DeviceError for
/// every other failure, both with the call's text, the result's name and what it was about.
VkResult checkResult(VkResult result, const char* call, const char* about = "");

} // namespace hone

/// Makes a Vulkan call and throws if it failed. Every call that returns a VkResult goes through
/// this or through VulkanObject.
#define HONE_VULKAN(call) ::hone::checkResult((call), #call)

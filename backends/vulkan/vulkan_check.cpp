// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan/vulkan_check.h"

#include "hone/core/error.h"

#include <string>

namespace hone {

const char* resultName(VkResult result) {
#define HONE_RESULT(name)                                                                          \
    case name:                                                                                     \
        return #name;
    switch (result) {
        HONE_RESULT(VK_SUCCESS)
        HONE_RESULT(VK_NOT_READY)
        HONE_RESULT(VK_TIMEOUT)
        HONE_RESULT(VK_INCOMPLETE)
        HONE_RESULT(VK_ERROR_OUT_OF_HOST_MEMORY)
        HONE_RESULT(VK_ERROR_OUT_OF_DEVICE_MEMORY)
        HONE_RESULT(VK_ERROR_INITIALIZATION_FAILED)
        HONE_RESULT(VK_ERROR_DEVICE_LOST)
        HONE_RESULT(VK_ERROR_MEMORY_MAP_FAILED)
        HONE_RESULT(VK_ERROR_LAYER_NOT_PRESENT)
        HONE_RESULT(VK_ERROR_EXTENSION_NOT_PRESENT)
        HONE_RESULT(VK_ERROR_FEATURE_NOT_PRESENT)
        HONE_RESULT(VK_ERROR_INCOMPATIBLE_DRIVER)
        HONE_RESULT(VK_ERROR_TOO_MANY_OBJECTS)
        HONE_RESULT(VK_ERROR_FORMAT_NOT_SUPPORTED)
        HONE_RESULT(VK_ERROR_FRAGMENTED_POOL)
        HONE_RESULT(VK_ERROR_OUT_OF_POOL_MEMORY)
        HONE_RESULT(VK_ERROR_FRAGMENTATION)
        HONE_RESULT(VK_ERROR_UNKNOWN)
    default:
        return "a VkResult unknown to this build";
    }
#undef HONE_RESULT
}

VkResult checkResult(VkResult result, const char* call, const char* about) {
    if (result >= 0)
        return result;
    std::string text =
        std::string(call) + " returned " + resultName(result) + " (" + std::to_string(result) + ")";
    if (about[0] != '\0')
        text += std::string(" for ") + about;
    if (result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY)
        throw OutOfMemory(text);
    throw DeviceError(text);
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan/vulkan_import.h"

#include "hone/core/device/page_allocator.h"
#include "hone/core/error.h"
#include "hone/core/log.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

namespace hone {
namespace {

constexpr VkExternalMemoryHandleTypeFlagBits kHostMemory =
    VK_EXTERNAL_MEMORY_HANDLE_TYPE_HOST_ALLOCATION_BIT_EXT;

bool offersExtension(VkPhysicalDevice device) {
    std::uint32_t count = 0;
    HONE_VULKAN(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr));
    std::vector<VkExtensionProperties> extensions(count);
    HONE_VULKAN(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data()));
    return std::ranges::any_of(extensions, [](const VkExtensionProperties& extension) {
        return std::strcmp(extension.extensionName, VK_EXT_EXTERNAL_MEMORY_HOST_EXTENSION_NAME) ==
               0;
    });
}

/// Whether buffers as hone makes them may stand in host memory that is not dedicated to them.
bool canImportBuffers(VkPhysicalDevice device) {
    const VkPhysicalDeviceExternalBufferInfo info{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_BUFFER_INFO,
        .pNext = nullptr,
        .flags = 0,
        .usage = kBufferUsage,
        .handleType = kHostMemory};
    VkExternalBufferProperties found{};
    found.sType = VK_STRUCTURE_TYPE_EXTERNAL_BUFFER_PROPERTIES;
    vkGetPhysicalDeviceExternalBufferProperties(device, &info, &found);
    const VkExternalMemoryFeatureFlags features =
        found.externalMemoryProperties.externalMemoryFeatures;
    return (features & VK_EXTERNAL_MEMORY_FEATURE_IMPORTABLE_BIT) != 0 &&
           (features & VK_EXTERNAL_MEMORY_FEATURE_DEDICATED_ONLY_BIT) == 0;
}

/// The types as which the driver takes this memory.
std::uint32_t typesOf(const VulkanContext& context, void* bytes) {
    const auto ask = reinterpret_cast<PFN_vkGetMemoryHostPointerPropertiesEXT>(
        vkGetDeviceProcAddr(context.device(), "vkGetMemoryHostPointerPropertiesEXT"));
    VkMemoryHostPointerPropertiesEXT found{};
    found.sType = VK_STRUCTURE_TYPE_MEMORY_HOST_POINTER_PROPERTIES_EXT;
    HONE_VULKAN(ask(context.device(), kHostMemory, bytes, &found));
    return found.memoryTypeBits;
}

} // namespace

VkDeviceSize hostImportAlignment(VkPhysicalDevice device) {
    if (!offersExtension(device) || !canImportBuffers(device))
        return 0;
    VkPhysicalDeviceExternalMemoryHostPropertiesEXT host{};
    host.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_MEMORY_HOST_PROPERTIES_EXT;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &host;
    vkGetPhysicalDeviceProperties2(device, &properties);
    // Memory is handed over in whole pages (PagedVector).
    const VkDeviceSize alignment = host.minImportedHostPointerAlignment;
    return kPageBytes % alignment == 0 ? alignment : 0;
}

std::optional<VulkanBuffer> importHostMemory(const VulkanContext& context,
                                             std::span<std::byte> bytes, std::string_view name) {
    const VkDeviceSize alignment = context.chosen().host_import_alignment;
    if (alignment == 0 || bytes.empty() ||
        reinterpret_cast<std::uintptr_t>(bytes.data()) % alignment != 0)
        return std::nullopt;
    const std::string about(name);
    try {
        const VkExternalMemoryBufferCreateInfo external{
            .sType = VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_BUFFER_CREATE_INFO,
            .pNext = nullptr,
            .handleTypes = kHostMemory};
        OwnedBuffer buffer = createBuffer(context, bytes.size(), about.c_str(), &external);
        VkMemoryRequirements needs{};
        vkGetBufferMemoryRequirements(context.device(), buffer.handle(), &needs);

        const VkImportMemoryHostPointerInfoEXT import{
            .sType = VK_STRUCTURE_TYPE_IMPORT_MEMORY_HOST_POINTER_INFO_EXT,
            .pNext = nullptr,
            .handleType = kHostMemory,
            .pHostPointer = bytes.data()};
        const VkDeviceSize size = wholePages(bytes.size());
        const auto type =
            findType(context.memory(), needs.memoryTypeBits & typesOf(context, bytes.data()),
                     VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
        if (!type || needs.size > size)
            throw DeviceError(about + ": the driver takes no such memory for buffers");
        const VkMemoryAllocateInfo info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                        .pNext = &import,
                                        .allocationSize = size,
                                        .memoryTypeIndex = *type};
        OwnedMemory memory(context.device(), info, about.c_str());
        context.setName(VK_OBJECT_TYPE_DEVICE_MEMORY, memory.handle(), about);
        HONE_VULKAN(vkBindBufferMemory(context.device(), buffer.handle(), memory.handle(), 0));
        return VulkanBuffer(std::move(buffer), std::move(memory), bytes);
    } catch (const std::exception& problem) {
        // Drivers may refuse memory (a mapped file, a limit on pinned pages); a copy does as well.
        logger().info("Vulkan: {} will be copied: {}", name, problem.what());
        return std::nullopt;
    }
}

} // namespace hone

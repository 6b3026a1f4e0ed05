// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan/vulkan_context.h"

#include "hone/backends/vulkan/vulkan_ray_features.h"
#include "hone/core/log.h"

#include <string>

namespace hone {
namespace {

OwnedDevice openDevice(const VulkanCandidate& chosen) {
    VulkanRayFeatures rays({chosen.report.ray_query, chosen.report.ray_pipeline});
    VulkanFeatures features;
    features.core.features.geometryShader = VK_TRUE;
    features.core.features.drawIndirectFirstInstance = VK_TRUE;
    features.core.features.shaderStorageBufferArrayDynamicIndexing = VK_TRUE;
    features.core.features.multiDrawIndirect = chosen.multi_draw ? VK_TRUE : VK_FALSE;
    features.v12.scalarBlockLayout = VK_TRUE;
    features.v13.dynamicRendering = VK_TRUE;
    features.v13.synchronization2 = VK_TRUE;
    features.v13.maintenance4 = VK_TRUE;
    features.v12.bufferDeviceAddress = rays.extensions.empty() ? VK_FALSE : VK_TRUE;
    features.v13.pNext = rays.chain;

    std::vector<const char*> extensions = rays.extensions;
    if (chosen.host_import_alignment > 0)
        extensions.push_back(VK_EXT_EXTERNAL_MEMORY_HOST_EXTENSION_NAME);

    const float priority = 1.0f;
    const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                        .pNext = nullptr,
                                        .flags = 0,
                                        .queueFamilyIndex = chosen.queue_family,
                                        .queueCount = 1,
                                        .pQueuePriorities = &priority};
    const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                  .pNext = &features.core,
                                  .flags = 0,
                                  .queueCreateInfoCount = 1,
                                  .pQueueCreateInfos = &queue,
                                  .enabledLayerCount = 0,
                                  .ppEnabledLayerNames = nullptr,
                                  .enabledExtensionCount =
                                      static_cast<std::uint32_t>(extensions.size()),
                                  .ppEnabledExtensionNames = extensions.data(),
                                  .pEnabledFeatures = nullptr};
    VkDevice device = VK_NULL_HANDLE;
    checkResult(vkCreateDevice(chosen.device, &info, nullptr, &device), "vkCreateDevice",
                chosen.report.name.c_str());
    return OwnedDevice(device);
}

VulkanCandidate chooseFor(const VulkanInstance& instance, const VulkanOptions& options) {
    VulkanCandidate chosen = choose(findCandidates(instance), options.device);
    chosen.report.ray_query = chosen.report.ray_query && options.ray_tracing;
    chosen.report.ray_pipeline = chosen.report.ray_pipeline && options.ray_tracing;
    if (!options.host_import)
        chosen.host_import_alignment = 0;
    return chosen;
}

double timestampPeriod(const VulkanCandidate& chosen) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(chosen.device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(chosen.device, &count, families.data());
    // Fewer than 64 valid bits would wrap; such a queue counts as one without a clock.
    const bool has_clock = families[chosen.queue_family].timestampValidBits == 64;
    return has_clock ? chosen.properties.limits.timestampPeriod : 0.0;
}

} // namespace

VulkanContext::VulkanContext(const VulkanOptions& options)
    : instance_(options), chosen_(chooseFor(instance_, options)), device_(openDevice(chosen_)),
      timestamp_period_ns_(timestampPeriod(chosen_)) {
    vkGetDeviceQueue(device(), chosen_.queue_family, 0, &queue_);
    vkGetPhysicalDeviceMemoryProperties(chosen_.device, &memory_);
    const auto load = [this](const char* name) {
        return vkGetInstanceProcAddr(instance_.handle(), name);
    };
    set_name_ =
        reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(load("vkSetDebugUtilsObjectNameEXT"));
    begin_label_ =
        reinterpret_cast<PFN_vkCmdBeginDebugUtilsLabelEXT>(load("vkCmdBeginDebugUtilsLabelEXT"));
    end_label_ =
        reinterpret_cast<PFN_vkCmdEndDebugUtilsLabelEXT>(load("vkCmdEndDebugUtilsLabelEXT"));
    setName(VK_OBJECT_TYPE_QUEUE, queue_, "hone queue");
    logger().info("Vulkan device: {}, {}", chosen_.report.name, chosen_.report.driver);
}

void VulkanContext::setName(VkObjectType type, std::uint64_t handle, std::string_view name) const {
    if (set_name_ == nullptr)
        return;
    const std::string text(name);
    const VkDebugUtilsObjectNameInfoEXT info{.sType =
                                                 VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                                             .pNext = nullptr,
                                             .objectType = type,
                                             .objectHandle = handle,
                                             .pObjectName = text.c_str()};
    HONE_VULKAN(set_name_(device(), &info));
}

void VulkanContext::beginLabel(VkCommandBuffer commands, const char* name) const {
    if (begin_label_ == nullptr)
        return;
    const VkDebugUtilsLabelEXT label{.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT,
                                     .pNext = nullptr,
                                     .pLabelName = name,
                                     .color = {}};
    begin_label_(commands, &label);
}

void VulkanContext::endLabel(VkCommandBuffer commands) const {
    if (end_label_ != nullptr)
        end_label_(commands);
}

} // namespace hone

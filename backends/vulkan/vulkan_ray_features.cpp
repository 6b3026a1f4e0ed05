// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan/vulkan_ray_features.h"

#include <algorithm>
#include <cstring>

namespace hone {
namespace {

/// The extensions of the wanted kinds, with what they need in turn.
std::vector<const char*> extensionsOf(RayTracing wanted) {
    if (!wanted.query && !wanted.pipeline)
        return {};
    std::vector<const char*> names{VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME,
                                   VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME};
    if (wanted.query)
        names.push_back(VK_KHR_RAY_QUERY_EXTENSION_NAME);
    if (wanted.pipeline)
        names.push_back(VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME);
    return names;
}

/// Whether all of `wanted` are among `offered`.
bool hasAll(const std::vector<VkExtensionProperties>& offered,
            const std::vector<const char*>& wanted) {
    return std::ranges::all_of(wanted, [&](const char* name) {
        return std::ranges::any_of(offered, [name](const VkExtensionProperties& extension) {
            return std::strcmp(extension.extensionName, name) == 0;
        });
    });
}

} // namespace

VulkanRayFeatures::VulkanRayFeatures(RayTracing wanted) : extensions(extensionsOf(wanted)) {
    if (extensions.empty())
        return;
    tree.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR;
    tree.accelerationStructure = VK_TRUE;
    query.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR;
    query.rayQuery = VK_TRUE;
    pipeline.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR;
    pipeline.rayTracingPipeline = VK_TRUE;
    chain = &tree;
    if (wanted.query)
        tree.pNext = &query;
    if (wanted.pipeline) {
        pipeline.pNext = chain;
        chain = &pipeline;
    }
}

RayTracing findRayTracing(VkPhysicalDevice device) {
    std::uint32_t count = 0;
    HONE_VULKAN(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr));
    std::vector<VkExtensionProperties> offered(count);
    HONE_VULKAN(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, offered.data()));
    const RayTracing named{.query = hasAll(offered, extensionsOf({.query = true})),
                           .pipeline = hasAll(offered, extensionsOf({.pipeline = true}))};
    if (!named.query && !named.pipeline)
        return {};

    // An extension may be there and its feature not (a layer, a virtual device).
    VulkanRayFeatures rays(named);
    rays.tree.accelerationStructure = VK_FALSE;
    rays.query.rayQuery = VK_FALSE;
    rays.pipeline.rayTracingPipeline = VK_FALSE;
    VkPhysicalDeviceVulkan12Features v12{};
    v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    v12.pNext = rays.chain;
    VkPhysicalDeviceFeatures2 core{};
    core.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    core.pNext = &v12;
    vkGetPhysicalDeviceFeatures2(device, &core);
    const bool has_trees =
        rays.tree.accelerationStructure == VK_TRUE && v12.bufferDeviceAddress == VK_TRUE;
    return {.query = has_trees && rays.query.rayQuery == VK_TRUE,
            .pipeline = has_trees && rays.pipeline.rayTracingPipeline == VK_TRUE};
}

} // namespace hone

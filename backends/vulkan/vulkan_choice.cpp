// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan/vulkan_choice.h"

#include "hone/backends/vulkan/vulkan_import.h"
#include "hone/backends/vulkan/vulkan_ray_features.h"
#include "hone/core/error.h"

#include <algorithm>
#include <cctype>
#include <optional>

namespace hone {

VulkanFeatures::VulkanFeatures() {
    core.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    core.pNext = &v12;
    v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    v12.pNext = &v13;
    v13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
}

namespace {

std::string versionText(std::uint32_t version) {
    return std::to_string(VK_API_VERSION_MAJOR(version)) + "." +
           std::to_string(VK_API_VERSION_MINOR(version)) + "." +
           std::to_string(VK_API_VERSION_PATCH(version));
}

std::string lower(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char letter) {
        return static_cast<char>(std::tolower(letter));
    });
    return text;
}

/// A family that draws and computes; Vulkan promises one wherever there is graphics at all.
std::optional<std::uint32_t> findQueueFamily(VkPhysicalDevice device) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    constexpr VkQueueFlags kWanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (std::uint32_t i = 0; i < count; ++i)
        if ((families[i].queueFlags & kWanted) == kWanted)
            return i;
    return std::nullopt;
}

bool canBe(VkPhysicalDevice device, VkFormat format, VkFormatFeatureFlags features) {
    VkFormatProperties properties{};
    vkGetPhysicalDeviceFormatProperties(device, format, &properties);
    return (properties.optimalTilingFeatures & features) == features;
}

VulkanCandidate examine(VkPhysicalDevice device) {
    VulkanCandidate found;
    found.device = device;
    vkGetPhysicalDeviceProperties(device, &found.properties);
    found.report.name = found.properties.deviceName;
    found.report.api_version = versionText(found.properties.apiVersion);
    if (found.properties.apiVersion < VK_API_VERSION_1_3) {
        found.report.missing = "Vulkan 1.3 (it offers " + found.report.api_version + ")";
        return found;
    }

    VkPhysicalDeviceMaintenance4Properties sizes{};
    sizes.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_PROPERTIES;
    VkPhysicalDeviceVulkan11Properties v11{};
    v11.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES;
    v11.pNext = &sizes;
    VkPhysicalDeviceVulkan12Properties v12{};
    v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES;
    v12.pNext = &v11;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &v12;
    vkGetPhysicalDeviceProperties2(device, &properties);
    // Mesa's text names itself ("Mesa 22.3.6 (LLVM 15.0.6)"), others give a bare number or nothing.
    const std::string name = v12.driverName;
    const std::string version = v12.driverInfo;
    found.report.driver = version.empty()               ? name
                          : version.starts_with("Mesa") ? version
                                                        : name + " " + version;
    found.max_buffer_bytes = sizes.maxBufferSize;
    found.max_allocation_bytes = v11.maxMemoryAllocationSize;

    VulkanFeatures features;
    vkGetPhysicalDeviceFeatures2(device, &features.core);
    found.multi_draw = features.core.features.multiDrawIndirect == VK_TRUE;

    // Collect everything that is missing, so that one look is enough.
    std::string& missing = found.report.missing;
    const auto require = [&missing](bool present, const char* what) {
        if (!present)
            missing += (missing.empty() ? "" : ", ") + std::string(what);
    };
    const VkPhysicalDeviceFeatures& core = features.core.features;
    require(core.geometryShader, "geometryShader (gl_PrimitiveID in fragment shaders)");
    require(core.drawIndirectFirstInstance, "drawIndirectFirstInstance");
    require(core.shaderStorageBufferArrayDynamicIndexing,
            "shaderStorageBufferArrayDynamicIndexing");
    require(features.v12.scalarBlockLayout, "scalarBlockLayout");
    require(features.v13.dynamicRendering, "dynamicRendering");
    require(features.v13.synchronization2, "synchronization2");
    require(features.v13.maintenance4, "maintenance4");
    require(
        canBe(device, VK_FORMAT_D32_SFLOAT,
              VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_FORMAT_FEATURE_TRANSFER_SRC_BIT),
        "32-bit float depth images");
    require(canBe(device, VK_FORMAT_R32G32_UINT,
                  VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT | VK_FORMAT_FEATURE_TRANSFER_SRC_BIT),
            "two-channel 32-bit integer images");
    const auto queue_family = findQueueFamily(device);
    require(queue_family.has_value(), "a queue for graphics and compute");
    found.queue_family = queue_family.value_or(0);
    found.report.usable = missing.empty();
    found.host_import_alignment = hostImportAlignment(device);
    found.report.host_import = found.host_import_alignment > 0;

    const RayTracing rays = findRayTracing(device);
    found.report.ray_query = rays.query;
    found.report.ray_pipeline = rays.pipeline;
    return found;
}

int rank(const VulkanCandidate& candidate) {
    switch (candidate.properties.deviceType) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return 4;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return 3;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return 2;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return 1;
    default:
        return 0;
    }
}

/// "\n  0: llvmpipe (LLVM 15.0.6, 256 bits), Mesa 22.3.6, usable\n  1: ..."
std::string list(const std::vector<VulkanCandidate>& candidates) {
    if (candidates.empty())
        return " none (a software device comes with mesa-vulkan-drivers on Debian and Ubuntu)";
    std::string text;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        const VulkanDeviceReport& report = candidates[i].report;
        text += "\n  " + std::to_string(i) + ": " + report.name + ", " + report.driver + ", " +
                (report.usable ? "usable" : "lacks " + report.missing);
    }
    return text;
}

/// Whether the wish is this candidate's index (a wish of digits is nothing else) or a part of its
/// name, in any case of letters.
bool isWished(const VulkanCandidate& candidate, std::size_t index, const std::string& wish) {
    const bool is_index = !wish.empty() && wish.find_first_not_of("0123456789") == wish.npos;
    if (is_index)
        return wish == std::to_string(index);
    return lower(candidate.report.name).find(lower(wish)) != std::string::npos;
}

} // namespace

std::vector<VulkanCandidate> findCandidates(const VulkanInstance& instance) {
    std::vector<VulkanCandidate> candidates;
    for (VkPhysicalDevice device : instance.physicalDevices())
        candidates.push_back(examine(device));
    return candidates;
}

const VulkanCandidate& choose(const std::vector<VulkanCandidate>& candidates,
                              const std::string& wish) {
    const VulkanCandidate* best = nullptr;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        const VulkanCandidate& candidate = candidates[i];
        if (candidate.report.usable && isWished(candidate, i, wish) &&
            (best == nullptr || rank(candidate) > rank(*best)))
            best = &candidate;
    }
    if (best != nullptr)
        return *best;
    throw DeviceError((wish.empty() ? "no usable Vulkan device"
                                    : "no usable Vulkan device matches \"" + wish + "\"") +
                      std::string("; found:") + list(candidates));
}

std::vector<VulkanDeviceReport> listVulkanDevices() {
    const VulkanInstance instance{VulkanOptions{}};
    std::vector<VulkanDeviceReport> reports;
    for (const VulkanCandidate& candidate : findCandidates(instance))
        reports.push_back(candidate.report);
    return reports;
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan/vulkan_instance.h"

#include "hone/core/error.h"
#include "hone/core/log.h"

#include <array>
#include <cstring>

namespace hone {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL receive(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                       VkDebugUtilsMessageTypeFlagsEXT,
                                       const VkDebugUtilsMessengerCallbackDataEXT* data,
                                       void* callback) {
    const auto& on_message = *static_cast<std::function<void(std::string_view)>*>(callback);
    on_message(data->pMessage);
    return VK_FALSE;
}

bool hasValidationLayer() {
    std::uint32_t count = 0;
    HONE_VULKAN(vkEnumerateInstanceLayerProperties(&count, nullptr));
    std::vector<VkLayerProperties> layers(count);
    HONE_VULKAN(vkEnumerateInstanceLayerProperties(&count, layers.data()));
    for (const VkLayerProperties& layer : layers)
        if (std::strcmp(layer.layerName, kValidationLayer) == 0)
            return true;
    return false;
}

bool hasDebugUtils() {
    std::uint32_t count = 0;
    HONE_VULKAN(vkEnumerateInstanceExtensionProperties(nullptr, &count, nullptr));
    std::vector<VkExtensionProperties> extensions(count);
    HONE_VULKAN(vkEnumerateInstanceExtensionProperties(nullptr, &count, extensions.data()));
    for (const VkExtensionProperties& extension : extensions)
        if (std::strcmp(extension.extensionName, VK_EXT_DEBUG_UTILS_EXTENSION_NAME) == 0)
            return true;
    return false;
}

} // namespace

VulkanInstance::VulkanInstance(const VulkanOptions& options) : on_message_(options.on_message) {
    if (!on_message_)
        on_message_ = [](std::string_view message) { logger().warn("{}", message); };
    if (options.validation && !hasValidationLayer())
        throw DeviceError(std::string("Vulkan validation was asked for, but ") + kValidationLayer +
                          " is not installed (Debian, Ubuntu: vulkan-validationlayers)");

    const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                        .pNext = nullptr,
                                        .pApplicationName = "hone",
                                        .applicationVersion = 0,
                                        .pEngineName = "hone",
                                        .engineVersion = 0,
                                        .apiVersion = VK_API_VERSION_1_3};
    // Only what the layer says about our use of Vulkan; the loader's own remarks are not ours.
    const VkDebugUtilsMessengerCreateInfoEXT messenger{
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .pNext = nullptr,
        .flags = 0,
        .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
        .pfnUserCallback = receive,
        .pUserData = &on_message_};
    const auto synchronization = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    const VkValidationFeaturesEXT features{.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                           .pNext = &messenger,
                                           .enabledValidationFeatureCount = 1,
                                           .pEnabledValidationFeatures = &synchronization,
                                           .disabledValidationFeatureCount = 0,
                                           .pDisabledValidationFeatures = nullptr};
    const char* debug_utils = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    const bool names = hasDebugUtils();
    const VkInstanceCreateInfo info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                    .pNext = options.validation ? &features : nullptr,
                                    .flags = 0,
                                    .pApplicationInfo = &application,
                                    .enabledLayerCount = options.validation ? 1u : 0u,
                                    .ppEnabledLayerNames = &kValidationLayer,
                                    .enabledExtensionCount = names ? 1u : 0u,
                                    .ppEnabledExtensionNames = &debug_utils};

    VkInstance instance = VK_NULL_HANDLE;
    const VkResult result = vkCreateInstance(&info, nullptr, &instance);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER)
        throw DeviceError("no Vulkan driver was found; a software one that is enough for hone is "
                          "mesa-vulkan-drivers (Debian, Ubuntu)");
    checkResult(result, "vkCreateInstance");
    instance_ = OwnedInstance(instance);

    if (options.validation) {
        const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance, "vkCreateDebugUtilsMessengerEXT"));
        HONE_VULKAN(create(instance, &messenger, nullptr, &messenger_));
    }
}

VulkanInstance::~VulkanInstance() {
    if (messenger_ == VK_NULL_HANDLE)
        return;
    const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(handle(), "vkDestroyDebugUtilsMessengerEXT"));
    destroy(handle(), messenger_, nullptr);
}

std::vector<VkPhysicalDevice> VulkanInstance::physicalDevices() const {
    std::uint32_t count = 0;
    HONE_VULKAN(vkEnumeratePhysicalDevices(handle(), &count, nullptr));
    std::vector<VkPhysicalDevice> devices(count);
    HONE_VULKAN(vkEnumeratePhysicalDevices(handle(), &count, devices.data()));
    return devices;
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/backends/vulkan/vulkan_check.h"

#include <utility>

namespace hone {

/// Owns one Vulkan object of a device: created in the constructor, destroyed in the destructor,
/// move-only. An empty owner holds VK_NULL_HANDLE. Must not outlive the device.
template <class Traits> class VulkanObject {
public:
    using Handle = typename Traits::Handle;

    VulkanObject() = default;
    /// Throws OutOfMemory or DeviceError, naming `about`.
    VulkanObject(VkDevice device, const typename Traits::Info& info, const char* about = "")
        : device_(device) {
        checkResult(Traits::create(device, &info, nullptr, &handle_), Traits::kCreate, about);
    }
    VulkanObject(VulkanObject&& other) noexcept
        : device_(other.device_), handle_(std::exchange(other.handle_, Handle{})) {}
    VulkanObject& operator=(VulkanObject&& other) noexcept {
        std::swap(device_, other.device_);
        std::swap(handle_, other.handle_);
        return *this;
    }
    ~VulkanObject() {
        if (handle_ != Handle{})
            Traits::destroy(device_, handle_, nullptr);
    }

    [[nodiscard]] Handle handle() const { return handle_; }

private:
    VkDevice device_ = VK_NULL_HANDLE;
    Handle handle_{};
};

/// Owns an object that belongs to no device: VkInstance, VkDevice.
template <class Type, auto kDestroy> class VulkanRoot {
public:
    VulkanRoot() = default;
    explicit VulkanRoot(Type handle) : handle_(handle) {}
    VulkanRoot(VulkanRoot&& other) noexcept : handle_(std::exchange(other.handle_, Type{})) {}
    VulkanRoot& operator=(VulkanRoot&& other) noexcept {
        std::swap(handle_, other.handle_);
        return *this;
    }
    ~VulkanRoot() {
        if (handle_ != Type{})
            kDestroy(handle_, nullptr);
    }
    [[nodiscard]] Type handle() const { return handle_; }

private:
    Type handle_{};
};

using OwnedInstance = VulkanRoot<VkInstance, vkDestroyInstance>;
using OwnedDevice = VulkanRoot<VkDevice, vkDestroyDevice>;

#define HONE_VULKAN_OBJECT(Name, Type, InfoType, create_call, destroy_call)                        \
    struct Name##Traits {                                                                          \
        using Handle = Type;                                                                       \
        using Info = InfoType;                                                                     \
        static constexpr const char* kCreate = #create_call;                                       \
        static constexpr auto create = create_call;                                                \
        static constexpr auto destroy = destroy_call;                                              \
    };                                                                                             \
    using Name = VulkanObject<Name##Traits>;

// clang-format off
HONE_VULKAN_OBJECT(OwnedBuffer, VkBuffer, VkBufferCreateInfo, vkCreateBuffer, vkDestroyBuffer)
HONE_VULKAN_OBJECT(OwnedImage, VkImage, VkImageCreateInfo, vkCreateImage, vkDestroyImage)
HONE_VULKAN_OBJECT(OwnedImageView, VkImageView, VkImageViewCreateInfo, vkCreateImageView, vkDestroyImageView)
HONE_VULKAN_OBJECT(OwnedMemory, VkDeviceMemory, VkMemoryAllocateInfo, vkAllocateMemory, vkFreeMemory)
HONE_VULKAN_OBJECT(OwnedShaderModule, VkShaderModule, VkShaderModuleCreateInfo, vkCreateShaderModule, vkDestroyShaderModule)
HONE_VULKAN_OBJECT(OwnedSetLayout, VkDescriptorSetLayout, VkDescriptorSetLayoutCreateInfo, vkCreateDescriptorSetLayout, vkDestroyDescriptorSetLayout)
HONE_VULKAN_OBJECT(OwnedPipelineLayout, VkPipelineLayout, VkPipelineLayoutCreateInfo, vkCreatePipelineLayout, vkDestroyPipelineLayout)
HONE_VULKAN_OBJECT(OwnedDescriptorPool, VkDescriptorPool, VkDescriptorPoolCreateInfo, vkCreateDescriptorPool, vkDestroyDescriptorPool)
HONE_VULKAN_OBJECT(OwnedCommandPool, VkCommandPool, VkCommandPoolCreateInfo, vkCreateCommandPool, vkDestroyCommandPool)
HONE_VULKAN_OBJECT(OwnedFence, VkFence, VkFenceCreateInfo, vkCreateFence, vkDestroyFence)
HONE_VULKAN_OBJECT(OwnedQueryPool, VkQueryPool, VkQueryPoolCreateInfo, vkCreateQueryPool, vkDestroyQueryPool)
// clang-format on
#undef HONE_VULKAN_OBJECT

/// Pipelines are made in batches; hone makes one at a time and keeps no driver cache.
struct OwnedComputePipelineTraits {
    using Handle = VkPipeline;
    using Info = VkComputePipelineCreateInfo;
    static constexpr const char* kCreate = "vkCreateComputePipelines";
    static VkResult create(VkDevice device, const Info* info, const VkAllocationCallbacks* host,
                           VkPipeline* pipeline) {
        return vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, info, host, pipeline);
    }
    static constexpr auto destroy = vkDestroyPipeline;
};
struct OwnedGraphicsPipelineTraits {
    using Handle = VkPipeline;
    using Info = VkGraphicsPipelineCreateInfo;
    static constexpr const char* kCreate = "vkCreateGraphicsPipelines";
    static VkResult create(VkDevice device, const Info* info, const VkAllocationCallbacks* host,
                           VkPipeline* pipeline) {
        return vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, info, host, pipeline);
    }
    static constexpr auto destroy = vkDestroyPipeline;
};
using OwnedComputePipeline = VulkanObject<OwnedComputePipelineTraits>;
using OwnedGraphicsPipeline = VulkanObject<OwnedGraphicsPipelineTraits>;

/// A device function of an extension, which the loader's library does not export.
#define HONE_DEVICE_CALL(device, name)                                                             \
    reinterpret_cast<PFN_##name>(vkGetDeviceProcAddr((device), #name))

struct OwnedAccelerationStructureTraits {
    using Handle = VkAccelerationStructureKHR;
    using Info = VkAccelerationStructureCreateInfoKHR;
    static constexpr const char* kCreate = "vkCreateAccelerationStructureKHR";
    static VkResult create(VkDevice device, const Info* info, const VkAllocationCallbacks* host,
                           Handle* tree) {
        return HONE_DEVICE_CALL(device, vkCreateAccelerationStructureKHR)(device, info, host, tree);
    }
    static void destroy(VkDevice device, Handle tree, const VkAllocationCallbacks* host) {
        HONE_DEVICE_CALL(device, vkDestroyAccelerationStructureKHR)(device, tree, host);
    }
};
struct OwnedRayPipelineTraits {
    using Handle = VkPipeline;
    using Info = VkRayTracingPipelineCreateInfoKHR;
    static constexpr const char* kCreate = "vkCreateRayTracingPipelinesKHR";
    static VkResult create(VkDevice device, const Info* info, const VkAllocationCallbacks* host,
                           VkPipeline* pipeline) {
        return HONE_DEVICE_CALL(device, vkCreateRayTracingPipelinesKHR)(
            device, VK_NULL_HANDLE, VK_NULL_HANDLE, 1, info, host, pipeline);
    }
    static constexpr auto destroy = vkDestroyPipeline;
};
using OwnedAccelerationStructure = VulkanObject<OwnedAccelerationStructureTraits>;
using OwnedRayPipeline = VulkanObject<OwnedRayPipelineTraits>;

} // namespace hone

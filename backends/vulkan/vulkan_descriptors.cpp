// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan/vulkan_descriptors.h"

#include "hone/core/error.h"

#include <array>
#include <string>

namespace hone {
namespace {

constexpr std::uint32_t kSetsPerPool = 256;
constexpr std::uint32_t kDescriptorsPerSet = 16; ///< on average

OwnedDescriptorPool makePool(const VulkanContext& context) {
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                    kSetsPerPool * kDescriptorsPerSet};
    const VkDescriptorPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                          .pNext = nullptr,
                                          .flags = 0,
                                          .maxSets = kSetsPerPool,
                                          .poolSizeCount = 1,
                                          .pPoolSizes = &size};
    OwnedDescriptorPool pool(context.device(), info);
    context.setName(VK_OBJECT_TYPE_DESCRIPTOR_POOL, pool.handle(), "descriptor pool");
    return pool;
}

} // namespace

VulkanDescriptors::VulkanDescriptors(const VulkanContext& context, VulkanMemory& memory,
                                     VulkanSlots<VulkanBuffer>& buffers)
    : context_(&context), buffers_(&buffers), nothing_(context, memory, 4, "nothing bound") {}

VkDescriptorSet VulkanDescriptors::allocate(const ShaderInterface& interface) {
    const VkDescriptorSetLayout layout = interface.set_layout.handle();
    for (;; ++current_) {
        const bool is_new = current_ == pools_.size();
        if (is_new)
            pools_.push_back(makePool(*context_));
        const VkDescriptorSetAllocateInfo info{.sType =
                                                   VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                               .pNext = nullptr,
                                               .descriptorPool = pools_[current_].handle(),
                                               .descriptorSetCount = 1,
                                               .pSetLayouts = &layout};
        VkDescriptorSet set = VK_NULL_HANDLE;
        const VkResult result = vkAllocateDescriptorSets(context_->device(), &info, &set);
        const bool is_full =
            result == VK_ERROR_OUT_OF_POOL_MEMORY || result == VK_ERROR_FRAGMENTED_POOL;
        if (is_full && !is_new)
            continue;
        checkResult(result, "vkAllocateDescriptorSets", interface.name.c_str());
        return set;
    }
}

VkDescriptorBufferInfo VulkanDescriptors::describe(const ShaderInterface& interface,
                                                   const Argument& argument) {
    const BufferView& view = argument.buffer;
    if (view.bytes == 0)
        return {nothing_.handle(), 0, VK_WHOLE_SIZE};
    const VkPhysicalDeviceLimits& limits = context_->limits();
    const auto label = [&] { return interface.name + "." + std::string(argument.name); };
    HONE_ASSERT(view.offset % limits.minStorageBufferOffsetAlignment == 0,
                label() + " begins at byte " + std::to_string(view.offset) +
                    " of its buffer; it must be a multiple of " +
                    std::to_string(limits.minStorageBufferOffsetAlignment));
    if (view.bytes > limits.maxStorageBufferRange)
        throw DeviceError(label() + " binds " + std::to_string(view.bytes) + " bytes; " +
                          context_->chosen().report.name + " reads at most " +
                          std::to_string(limits.maxStorageBufferRange) + " from one buffer");
    return {buffers_->get(view.handle, argument.name).handle(), view.offset, view.bytes};
}

VkDescriptorSet VulkanDescriptors::bind(const ShaderInterface& interface,
                                        const Arguments& arguments) {
    std::array<VkDescriptorBufferInfo, kMaxDescriptors> infos;
    std::array<VkWriteDescriptorSet, kMaxDescriptors> writes;
    std::uint32_t info_count = 0;
    const VkDescriptorSet set = allocate(interface);
    const auto binding_count = static_cast<std::uint32_t>(interface.bindings.size());
    for (std::uint32_t i = 0; i < binding_count; ++i) {
        const ShaderBinding& binding = interface.bindings[i];
        writes[i] = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                     .pNext = nullptr,
                     .dstSet = set,
                     .dstBinding = i,
                     .dstArrayElement = 0,
                     .descriptorCount = binding.elements,
                     .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                     .pImageInfo = nullptr,
                     .pBufferInfo = &infos[info_count],
                     .pTexelBufferView = nullptr};
        for (std::uint32_t k = 0; k < binding.elements; ++k) {
            const Argument* argument = arguments.find(binding.name, k);
            HONE_ASSERT(argument != nullptr || binding.elements > 1,
                        interface.name + ": no buffer is bound to " + binding.name);
            infos[info_count++] = argument != nullptr
                                      ? describe(interface, *argument)
                                      : VkDescriptorBufferInfo{nothing_.handle(), 0, VK_WHOLE_SIZE};
        }
    }
    vkUpdateDescriptorSets(context_->device(), binding_count, writes.data(), 0, nullptr);
    return set;
}

void VulkanDescriptors::reset() {
    for (std::size_t i = 0; i < pools_.size() && i <= current_; ++i)
        HONE_VULKAN(vkResetDescriptorPool(context_->device(), pools_[i].handle(), 0));
    current_ = 0;
}

} // namespace hone

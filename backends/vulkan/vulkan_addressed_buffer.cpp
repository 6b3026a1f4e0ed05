// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan/vulkan_addressed_buffer.h"

#include "hone/backends/vulkan/vulkan_buffer.h"

namespace hone {

AddressedBuffer::AddressedBuffer(const VulkanContext& context, const VulkanMemory& memory,
                                 VkDeviceSize bytes, VkBufferUsageFlags usage, Place place,
                                 const char* name, VkDeviceSize alignment)
    : bytes_(bytes) {
    // A buffer's address may be less aligned than what is built in it asks for.
    buffer_ = createBuffer(context, bytes + alignment - 1, name, nullptr,
                           usage | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT);
    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(context.device(), buffer_.handle(), &needs);
    const bool is_mapped = place == Place::kMapped;
    memory_ = memory.allocateAddressed(needs, is_mapped, name);
    HONE_VULKAN(vkBindBufferMemory(context.device(), buffer_.handle(), memory_.handle(), 0));
    const VkBufferDeviceAddressInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO,
                                         .pNext = nullptr,
                                         .buffer = buffer_.handle()};
    const VkDeviceAddress begin = vkGetBufferDeviceAddress(context.device(), &info);
    address_ = (begin + alignment - 1) / alignment * alignment;
    if (is_mapped) {
        void* data = nullptr;
        HONE_VULKAN(vkMapMemory(context.device(), memory_.handle(), 0, VK_WHOLE_SIZE, 0, &data));
        data_ = static_cast<std::byte*>(data) + (address_ - begin);
    }
}

} // namespace hone

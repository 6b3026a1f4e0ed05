// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan/vulkan_buffer.h"

#include "hone/core/error.h"

#include <algorithm>
#include <cstring>
#include <string>

namespace hone {

OwnedBuffer createBuffer(const VulkanContext& context, VkDeviceSize bytes, const char* name,
                         const void* chain, VkBufferUsageFlags usage) {
    // Vulkan leaves sizes above its limits undefined, so they are refused here.
    const VulkanCandidate& device = context.chosen();
    const VkDeviceSize largest = std::min(device.max_buffer_bytes, device.max_allocation_bytes);
    if (bytes > largest)
        throw OutOfMemory(std::string(name) + " needs " + std::to_string(bytes) + " bytes; " +
                          device.report.name + " gives a buffer at most " +
                          std::to_string(largest));
    const VkBufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                  .pNext = chain,
                                  .flags = 0,
                                  .size = bytes,
                                  .usage = usage,
                                  .sharingMode = VK_SHARING_MODE_EXCLUSIVE,
                                  .queueFamilyIndexCount = 0,
                                  .pQueueFamilyIndices = nullptr};
    OwnedBuffer buffer(context.device(), info, name);
    context.setName(VK_OBJECT_TYPE_BUFFER, buffer.handle(), name);
    return buffer;
}

VulkanBuffer::VulkanBuffer(const VulkanContext& context, VulkanMemory& memory, std::size_t bytes,
                           std::string_view name)
    : memory_(&memory), bytes_(bytes) {
    const std::string about(name);
    buffer_ = createBuffer(context, bytes, about.c_str());
    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(context.device(), buffer_.handle(), &needs);
    range_ = memory.allocate(needs, about.c_str());
    try {
        HONE_VULKAN(
            vkBindBufferMemory(context.device(), buffer_.handle(), range_.memory, range_.offset));
    } catch (...) {
        memory.free(range_);
        throw;
    }
    data_ = range_.data;
    std::memset(data_, 0, bytes);
}

VulkanBuffer::~VulkanBuffer() {
    if (memory_ == nullptr)
        return;
    // The buffer must go before the memory that it is bound to.
    buffer_ = {};
    memory_->free(range_);
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/backends/vulkan/vulkan_memory.h"

#include <string_view>

namespace hone {

/// A mapped, zeroed buffer for every use that hone has. Move-only.
class VulkanBuffer {
public:
    /// Throws OutOfMemory naming the buffer.
    VulkanBuffer(const VulkanContext& context, VulkanMemory& memory, std::size_t bytes,
                 std::string_view name);
    VulkanBuffer(VulkanBuffer&& other) noexcept
        : memory_(std::exchange(other.memory_, nullptr)), range_(other.range_),
          bytes_(other.bytes_), buffer_(std::move(other.buffer_)) {}
    VulkanBuffer& operator=(VulkanBuffer&&) = delete;
    ~VulkanBuffer();

    [[nodiscard]] VkBuffer handle() const { return buffer_.handle(); }
    [[nodiscard]] std::byte* data() const { return range_.data; }
    [[nodiscard]] std::size_t bytes() const { return bytes_; }

private:
    VulkanMemory* memory_;
    MemoryRange range_;
    std::size_t bytes_ = 0;
    OwnedBuffer buffer_;
};

} // namespace hone

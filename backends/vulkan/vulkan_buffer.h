// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/backends/vulkan/vulkan_memory.h"

#include <span>
#include <string_view>

namespace hone {

/// Every use that hone has for a buffer.
inline constexpr VkBufferUsageFlags kBufferUsage =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
    VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT |
    VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;

/// A buffer without memory, which `chain` says more of. Throws OutOfMemory, naming it, for a size
/// that the device does not give.
[[nodiscard]] OwnedBuffer createBuffer(const VulkanContext& context, VkDeviceSize bytes,
                                       const char* name, const void* chain = nullptr,
                                       VkBufferUsageFlags usage = kBufferUsage);

/// A buffer for every use that hone has, and the bytes of the host that it is. Move-only.
class VulkanBuffer {
public:
    /// Mapped and zeroed.
    /// Throws OutOfMemory naming the buffer.
    VulkanBuffer(const VulkanContext& context, VulkanMemory& memory, std::size_t bytes,
                 std::string_view name);
    /// `buffer`, bound to `imported`, which is these bytes of somebody else.
    VulkanBuffer(OwnedBuffer buffer, OwnedMemory imported, std::span<std::byte> bytes)
        : data_(bytes.data()), bytes_(bytes.size()), imported_(std::move(imported)),
          buffer_(std::move(buffer)) {}
    VulkanBuffer(VulkanBuffer&& other) noexcept
        : memory_(std::exchange(other.memory_, nullptr)), range_(other.range_), data_(other.data_),
          bytes_(other.bytes_), imported_(std::move(other.imported_)),
          buffer_(std::move(other.buffer_)) {}
    VulkanBuffer& operator=(VulkanBuffer&&) = delete;
    ~VulkanBuffer();

    [[nodiscard]] VkBuffer handle() const { return buffer_.handle(); }
    [[nodiscard]] std::byte* data() const { return data_; }
    [[nodiscard]] std::size_t bytes() const { return bytes_; }

private:
    VulkanMemory* memory_ = nullptr; ///< that range_ came from; null if imported
    MemoryRange range_;
    std::byte* data_ = nullptr;
    std::size_t bytes_ = 0;
    OwnedMemory imported_;
    OwnedBuffer buffer_; // last, so that it goes before the memory that it is bound to
};

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/backends/vulkan/vulkan_memory.h"

#include <span>

namespace hone {

/// A buffer that the device reaches by its address, with memory of its own: what acceleration
/// structures and pipelines of rays are made from and live in. Move-only.
class AddressedBuffer {
public:
    enum class Place : std::uint8_t {
        kMapped, ///< the host writes it
        kDevice, ///< only the device sees it
    };

    AddressedBuffer() = default;
    /// Throws OutOfMemory naming the buffer. `alignment`: of the address, a power of two.
    AddressedBuffer(const VulkanContext& context, const VulkanMemory& memory, VkDeviceSize bytes,
                    VkBufferUsageFlags usage, Place place, const char* name,
                    VkDeviceSize alignment = 1);

    [[nodiscard]] VkBuffer handle() const { return buffer_.handle(); }
    [[nodiscard]] VkDeviceAddress address() const { return address_; }
    [[nodiscard]] VkDeviceSize bytes() const { return bytes_; }
    /// The host's view as elements of T; of mapped buffers only.
    template <class T> [[nodiscard]] std::span<T> as() const {
        return {reinterpret_cast<T*>(data_), bytes_ / sizeof(T)};
    }

private:
    OwnedMemory memory_; // first, so that it goes last
    OwnedBuffer buffer_;
    VkDeviceAddress address_ = 0;
    VkDeviceSize bytes_ = 0;
    std::byte* data_ = nullptr;
};

} // namespace hone

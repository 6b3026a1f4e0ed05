// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace hone {

class Device;

/// A stretch of a buffer: what is bound to kernels, copied, filled. Does not own.
/// `data` is the same bytes as the host sees them (every buffer of hone is mapped for its whole
/// life).
struct BufferView {
    std::uint64_t handle = 0; ///< the device's name for the buffer; 0 = none
    std::size_t offset = 0;   ///< bytes from the buffer's begin
    std::size_t bytes = 0;
    std::byte* data = nullptr; ///< already advanced by offset

    /// The bytes as elements of T. Host access: only while no submitted work uses them
    /// (CommandEncoder::finish).
    template <class T> [[nodiscard]] std::span<T> as() const {
        return {reinterpret_cast<T*>(data), bytes / sizeof(T)};
    }
    [[nodiscard]] BufferView part(std::size_t first_byte, std::size_t byte_count) const {
        return {handle, offset + first_byte, byte_count, data + first_byte};
    }
};

/// Owns one linear, mapped buffer of a device. Move-only; must not outlive its device.
class Buffer {
public:
    Buffer() = default;
    Buffer(Device& device, BufferView whole) : device_(&device), view_(whole) {}
    Buffer(Buffer&& other) noexcept
        : device_(std::exchange(other.device_, nullptr)), view_(std::exchange(other.view_, {})) {}
    Buffer& operator=(Buffer&& other) noexcept {
        std::swap(device_, other.device_);
        std::swap(view_, other.view_);
        return *this;
    }
    ~Buffer();

    [[nodiscard]] BufferView view() const { return view_; }
    [[nodiscard]] std::size_t bytes() const { return view_.bytes; }
    template <class T> [[nodiscard]] std::span<T> as() const { return view_.as<T>(); }
    explicit operator bool() const { return device_ != nullptr; }

private:
    Device* device_ = nullptr;
    BufferView view_;
};

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/device/device.h"
#include "hone/core/trace/ray.glsl.h"

#include <cstddef>
#include <span>
#include <string_view>

namespace hone {

/// Binds elements [first, first + count) of `view`. Returns where the first of them is in what was
/// bound: a binding may begin at every 256th byte only.
template <class T>
uint bindStretch(Arguments& arguments, std::string_view name, BufferView view, std::size_t first,
                 std::size_t count) {
    constexpr std::size_t kAlignment = 256;
    const std::size_t begin = view.offset + first * sizeof(T);
    const std::size_t before = begin % kAlignment;
    arguments.bind(name, {view.handle, begin - before, before + count * sizeof(T),
                          view.data + first * sizeof(T) - before});
    return static_cast<uint>(before / sizeof(T));
}

/// The lists of a query as a device sees them, for tracers that run on one: the asker's own bytes
/// where they lie in the device's buffers, else copies.
///
/// One query after another: bind(), run work over rays() and answers(), finish the device's
/// encoder, then collect(). Kept between queries, so that a steady state allocates nothing.
class QueryMemory {
public:
    /// Borrows `device`.
    explicit QueryMemory(Device& device) : device_(&device) {}

    /// Takes the lists of a query; both must stay until collect().
    void bind(std::span<const Ray> rays, std::span<std::byte> answers);

    /// Where the rays and the answers are: `offset` is a multiple of an element, not of what a
    /// device may bind at, so bind the whole buffer (offset 0) and count from offset / element.
    [[nodiscard]] BufferView rays() const { return rays_; }
    [[nodiscard]] BufferView answers() const { return answers_; }

    /// Hands answers that were copied to the asker.
    void collect();

    /// Bytes that were copied since this was made: 0 if every list lay in the device's buffers.
    [[nodiscard]] std::size_t copiedBytes() const { return copied_bytes_; }

private:
    BufferView place(std::span<const std::byte> bytes, Buffer& copy, bool& is_copied);

    Device* device_;
    Buffer ray_copy_, answer_copy_;
    BufferView rays_, answers_;
    std::span<std::byte> asked_;
    bool are_answers_copied_ = false;
    std::size_t copied_bytes_ = 0;
};

} // namespace hone

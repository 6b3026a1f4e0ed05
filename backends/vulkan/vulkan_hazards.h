// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/device/buffer.h"

#include <array>

namespace hone {

/// Bytes that an operation reads or writes.
struct BufferUse {
    BufferView buffer;
    bool is_written = false;
};

/// Which bytes were touched since the last barrier, to find whether the next operation must wait:
/// it must where one of two that meet writes. Buffers are told apart by where they are mapped, so
/// two that share memory are one.
class VulkanHazards {
public:
    /// Remembers the uses of an operation. Returns whether a barrier must come before it; what was
    /// touched before that is then forgotten.
    [[nodiscard]] bool mustWait(std::span<const BufferUse> uses);
    /// The same for an operation of which nothing is known.
    [[nodiscard]] bool mustWaitForAll();
    /// All that was recorded is done.
    void clear();

private:
    struct Touched {
        const std::byte* begin;
        const std::byte* end;
        bool is_written;
    };
    [[nodiscard]] bool meets(const BufferUse& use) const;

    /// An operation has at most 64 uses (kMaxDescriptors); more than this at once are waited for.
    static constexpr std::size_t kCapacity = 512;
    std::array<Touched, kCapacity> touched_{};
    std::size_t count_ = 0;
    bool is_unknown_ = false; ///< an operation was recorded of which nothing is known
    bool is_empty_ = true;
};

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/device/buffer.h"

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace hone {

/// A buffer bound to a kernel's port by name. A part of a buffer must start at a multiple of 256
/// bytes to be bound on every Vulkan device.
struct Argument {
    std::string_view name; ///< static or longer-lived than the dispatch
    BufferView buffer;
    std::uint32_t element = 0; ///< which edge, for a port that takes several
};

/// The arguments of one dispatch. Fixed capacity: a dispatch never allocates.
class Arguments {
public:
    static constexpr std::size_t kCapacity = 32;

    /// Binds `buffer` to `name`; a later binding of the same name replaces the earlier.
    void bind(std::string_view name, BufferView buffer, std::uint32_t element = 0);
    void bind(std::span<const Argument> several);

    [[nodiscard]] const Argument* find(std::string_view name, std::uint32_t element = 0) const;
    [[nodiscard]] std::span<const Argument> all() const { return {items_.data(), count_}; }

private:
    std::array<Argument, kCapacity> items_{};
    std::size_t count_ = 0;
};

/// One kernel in both its builds. Plain constant data; lives as long as the program, unless it has
/// a `content`.
struct Kernel {
    const char* name = "";
    std::span<const std::uint32_t> spirv; ///< empty: host only
    std::uint32_t params_bytes = 0;
    /// Runs invocations [begin, end) on the calling thread; safe to call from many threads for
    /// disjoint ranges.
    void (*run)(const Arguments& arguments, const void* params, std::uint32_t begin,
                std::uint32_t end) = nullptr;
    /// Of SPIR-V that was made at run time and need only outlive the dispatch: a hash of it, by
    /// which a device knows it again. 0: known by the address of the SPIR-V.
    std::uint64_t content = 0;
};

} // namespace hone

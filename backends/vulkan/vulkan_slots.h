// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/error.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hone {

/// Objects behind the 64-bit handles of core/device: slot + 1 below, the slot's generation above,
/// so that a stale or foreign handle is found out rather than followed. 0 is no object.
///
/// A retired object lives on until releaseRetired(): recorded work may still name it.
template <class T> class VulkanSlots {
public:
    [[nodiscard]] std::uint64_t add(T object) {
        if (free_.empty()) {
            free_.push_back(static_cast<std::uint32_t>(slots_.size()));
            slots_.emplace_back();
        }
        const std::uint32_t index = free_.back();
        free_.pop_back();
        Slot& slot = slots_[index];
        slot.object.emplace(std::move(object));
        return (std::uint64_t{slot.generation} << 32) | (index + 1u);
    }

    /// Throws std::logic_error, naming `what`, for a handle that is not alive here.
    [[nodiscard]] T& get(std::uint64_t handle, std::string_view what) {
        const std::uint64_t index = (handle & 0xffffffffu) - 1u;
        HONE_ASSERT(index < slots_.size() && slots_[index].generation == handle >> 32 &&
                        slots_[index].object.has_value(),
                    std::string(what) + " is empty, destroyed or belongs to another device");
        return *slots_[index].object;
    }

    /// Calls visit(handle, object) for each that is alive.
    template <class Visit> void forEach(const Visit& visit) const {
        for (std::size_t i = 0; i < slots_.size(); ++i)
            if (slots_[i].object.has_value())
                visit((std::uint64_t{slots_[i].generation} << 32) | (i + 1), *slots_[i].object);
    }

    void retire(std::uint64_t handle, std::string_view what) {
        T& object = get(handle, what);
        retired_.push_back(std::move(object));
        const auto index = static_cast<std::uint32_t>((handle & 0xffffffffu) - 1u);
        slots_[index].object.reset();
        ++slots_[index].generation;
        free_.push_back(index);
    }
    void releaseRetired() { retired_.clear(); }

private:
    struct Slot {
        std::optional<T> object;
        std::uint32_t generation = 0;
    };
    std::vector<Slot> slots_;
    std::vector<std::uint32_t> free_;
    std::vector<T> retired_;
};

} // namespace hone

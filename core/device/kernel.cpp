// SPDX-License-Identifier: Apache-2.0
#include "hone/core/device/kernel.h"

#include "hone/core/error.h"

namespace hone {

void Arguments::bind(std::string_view name, BufferView buffer, std::uint32_t element) {
    for (std::size_t i = 0; i < count_; ++i)
        if (items_[i].name == name && items_[i].element == element) {
            items_[i].buffer = buffer;
            return;
        }
    HONE_ASSERT(count_ < kCapacity,
                "a dispatch binds at most 32 buffers; one too many: " + std::string(name));
    items_[count_++] = {name, buffer, element};
}

void Arguments::bind(std::span<const Argument> several) {
    for (const Argument& argument : several)
        bind(argument.name, argument.buffer, argument.element);
}

const Argument* Arguments::find(std::string_view name, std::uint32_t element) const {
    for (std::size_t i = 0; i < count_; ++i)
        if (items_[i].name == name && items_[i].element == element)
            return &items_[i];
    return nullptr;
}

} // namespace hone

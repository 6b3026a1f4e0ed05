// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan/vulkan_hazards.h"

#include <algorithm>
#include <functional>

namespace hone {

bool VulkanHazards::meets(const BufferUse& use) const {
    const std::byte* begin = use.buffer.data;
    const std::byte* end = begin + use.buffer.bytes;
    return std::any_of(touched_.begin(), touched_.begin() + static_cast<std::ptrdiff_t>(count_),
                       [&](const Touched& touched) {
                           return (use.is_written || touched.is_written) &&
                                  std::less<>()(begin, touched.end) &&
                                  std::less<>()(touched.begin, end);
                       });
}

bool VulkanHazards::mustWait(std::span<const BufferUse> uses) {
    const bool waits = is_unknown_ || count_ + uses.size() > kCapacity ||
                       std::ranges::any_of(uses, [&](const BufferUse& use) { return meets(use); });
    if (waits)
        clear();
    for (const BufferUse& use : uses)
        if (use.buffer.bytes > 0)
            touched_[count_++] = {use.buffer.data, use.buffer.data + use.buffer.bytes,
                                  use.is_written};
    is_empty_ = false;
    return waits;
}

bool VulkanHazards::mustWaitForAll() {
    const bool waits = !is_empty_;
    clear();
    is_unknown_ = true;
    is_empty_ = false;
    return waits;
}

void VulkanHazards::clear() {
    count_ = 0;
    is_unknown_ = false;
    is_empty_ = true;
}

} // namespace hone

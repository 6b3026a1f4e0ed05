// SPDX-License-Identifier: Apache-2.0
#include "hone/core/trace/query_memory.h"

#include <algorithm>
#include <cstring>

namespace hone {

BufferView QueryMemory::place(std::span<const std::byte> bytes, Buffer& copy, bool& is_copied) {
    const BufferView own = device_->viewOf(bytes);
    is_copied = own.data == nullptr && !bytes.empty();
    if (!is_copied)
        return own;
    if (copy.bytes() < bytes.size())
        copy = device_->createBuffer(std::max(bytes.size(), 2 * copy.bytes()), "copy of a query");
    copied_bytes_ += bytes.size();
    return copy.view().part(0, bytes.size());
}

void QueryMemory::bind(std::span<const Ray> rays, std::span<std::byte> answers) {
    bool are_rays_copied = false;
    rays_ = place(std::as_bytes(rays), ray_copy_, are_rays_copied);
    if (are_rays_copied)
        std::memcpy(rays_.data, rays.data(), rays.size_bytes());
    answers_ = place(answers, answer_copy_, are_answers_copied_);
    asked_ = answers;
}

void QueryMemory::collect() {
    if (are_answers_copied_)
        std::memcpy(asked_.data(), answers_.data, asked_.size());
}

} // namespace hone

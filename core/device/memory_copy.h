// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace hone {

/// Bytes that exist twice, or that were carried from one memory to another, because a device or a
/// tracer cannot use them where they are. Copies that a graph itself asks for (a loop's initial
/// values) are not meant: dump() lists those.
struct MemoryCopy {
    std::string what; ///< "scene_positions", "rays and answers of vulkan.ray_query"
    std::size_t bytes = 0;
    std::string why;
    std::string cure; ///< what would avoid it
};

} // namespace hone

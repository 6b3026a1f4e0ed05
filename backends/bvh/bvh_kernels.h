// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/device/kernel.h"

namespace hone {

/// What traverse.glsl.h takes; the layout of its Params.
struct BvhQueryParams {
    std::uint32_t first_ray;
    std::uint32_t first_answer;
    std::uint32_t node_count;
    std::uint32_t step_limit;
    std::uint32_t is_resumed;
    float extent;
};

extern const Kernel kBvhClosest;  ///< answers "hits"
extern const Kernel kBvhOccluded; ///< answers "occluded"

} // namespace hone

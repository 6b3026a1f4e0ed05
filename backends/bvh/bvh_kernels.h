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
    std::uint32_t world_nodes;
    float extent;
};

/// One kind of query: `together` for devices with votes, `alone` for others and for what goes on.
struct BvhKernels {
    Kernel together;
    Kernel alone;
    const char* answers; ///< the port's name
};

extern const BvhKernels kBvhClosest;
extern const BvhKernels kBvhOccluded;

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/trace/bvh.h"

namespace hone {

float halfArea(const Bounds& bounds) {
    if (bounds.empty())
        return 0.0f;
    const vec3 size = bounds.high - bounds.low;
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

float sahCost(const Bvh& bvh) {
    double cost = 0;
    for (const Bvh::Node& node : bvh.nodes)
        cost += double{halfArea(node.bounds)} * (1.0 + node.count);
    const float whole = bvh.nodes.empty() ? 0.0f : halfArea(bvh.nodes.front().bounds);
    return whole > 0.0f ? static_cast<float>(cost / whole) : 0.0f;
}

} // namespace hone

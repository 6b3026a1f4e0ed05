// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/color_map.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hone::cli {

vec3 heatColor(float x) {
    if (std::isnan(x))
        return {0, 1, 0};
    static constexpr std::array<vec3, 6> kStops{
        vec3{0.00f, 0.00f, 0.02f}, vec3{0.25f, 0.04f, 0.41f}, vec3{0.58f, 0.15f, 0.40f},
        vec3{0.87f, 0.32f, 0.23f}, vec3{0.99f, 0.65f, 0.04f}, vec3{0.99f, 1.00f, 0.64f}};
    const float position = std::clamp(x, 0.0f, 1.0f) * (kStops.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(position), kStops.size() - 2);
    return glm::mix(kStops[below], kStops[below + 1], position - static_cast<float>(below));
}

vec3 idColor(uint id) {
    if (id == 0)
        return vec3(0);
    uint hash = id * 0x9e3779b9u;
    hash = (hash ^ (hash >> 16u)) * 0x85ebca6bu;
    hash ^= hash >> 13u;
    return vec3(0.25f) +
           vec3(hash & 255u, (hash >> 8u) & 255u, (hash >> 16u) & 255u) * (0.75f / 255.0f);
}

} // namespace hone::cli

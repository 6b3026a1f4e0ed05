// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/trace/ray.glsl.h"

#include <cmath>

namespace hone {

/// Whether `ray` can hit anything at all, as ray.glsl.h says. What a tracer asks before it trusts a
/// ray to a library: Embree's builds abort on some of the others.
[[nodiscard]] inline bool isTraceable(const Ray& ray) {
    constexpr float kLimit = 1e18f;
    // `&`, not `&&`: no branches. NaN is never in range.
    auto in_range = [](vec3 v) {
        return (std::fabs(v.x) < kLimit) & (std::fabs(v.y) < kLimit) & (std::fabs(v.z) < kLimit);
    };
    const vec3 d = ray.direction;
    const bool moves = (d.x != 0.0f) | (d.y != 0.0f) | (d.z != 0.0f);
    return in_range(ray.origin) & in_range(d) & moves & (ray.tmin <= ray.tmax) & (ray.tmax >= 0.0f);
}

} // namespace hone

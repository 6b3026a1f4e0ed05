// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/scene/scene.h"

#include <span>
#include <vector>

namespace hone::test {

/// A rectangle that faces lensCamera() and glows: its radiance is `emission` from everywhere.
struct Card {
    vec2 low{-100.0f}, high{100.0f}; ///< metres, x right and y up from the camera's axis
    float depth;                     ///< view depth in metres
    vec3 emission;
    float slant = 0; ///< metres that depth grows per metre of x
};

[[nodiscard]] Scene cardScene(std::span<const Card> cards);

/// Posts of many colours at several depths before a wall.
[[nodiscard]] Scene posts();

/// At the origin, looking along -z. Its focal length in pixels is the image's height.
[[nodiscard]] Camera lensCamera(float aperture, float focus);

/// The part of a disc of radius 1 that lies beyond a line at distance t from its centre: what a
/// half-plane covers of a lens (t < 0: more than half).
[[nodiscard]] float discBeyond(float t);

/// Each pixel's mean of `samples` samples: what pass trace says, by brute force.
[[nodiscard]] std::vector<vec3> tracedMeans(const Scene& scene, const Camera& camera, uvec2 extent,
                                            uint samples);

} // namespace hone::test

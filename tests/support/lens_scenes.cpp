// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/support/lens_scenes.h"

#include "hone/tests/support/scene_builder.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hone::test {

Scene cardScene(std::span<const Card> cards) {
    SceneBuilder builder;
    for (const Card& card : cards) {
        Material material = plainMaterial();
        material.base_color = vec3(0);
        material.emission = card.emission;
        const auto corner = [&](float x, float y) {
            return vec3(x, y, -(card.depth + card.slant * x));
        };
        const vec3 corners[] = {corner(card.low.x, card.low.y), corner(card.high.x, card.low.y),
                                corner(card.high.x, card.high.y), corner(card.low.x, card.high.y)};
        const uvec3 triangles[] = {{0, 1, 2}, {0, 2, 3}};
        builder.add(corners, triangles, builder.addMaterial(material));
    }
    return builder.finish();
}

Camera lensCamera(float aperture, float focus) {
    return {.position = vec3(0),
            .forward = vec3(0, 0, -1),
            .right = vec3(1, 0, 0),
            .up = vec3(0, 1, 0),
            .tan_half_fov_y = 0.5f,
            .near = 0.01f,
            .lens_radius = 0.5f * aperture,
            .focus = focus};
}

float discBeyond(float t) {
    t = std::clamp(t, -1.0f, 1.0f);
    return (std::acos(t) - t * std::sqrt(1 - t * t)) / std::numbers::pi_v<float>;
}

} // namespace hone::test

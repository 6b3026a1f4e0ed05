// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/support/lens_scenes.h"

#include "hone/backends/brute/brute_backend.h"
#include "hone/core/trace/sample.glsl.h"
#include "hone/passes/passes.h"
#include "hone/tests/support/run_pass.h"
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

Scene posts() {
    std::vector<Card> cards{{.depth = 9, .emission = vec3(0.2f, 0.3f, 0.5f)}};
    for (int i = -4; i <= 4; ++i) {
        const float x = static_cast<float>(i);
        cards.push_back({{0.9f * x - 0.15f, -10},
                         {0.9f * x + 0.15f, 0.3f * x},
                         6 + 0.3f * x,
                         vec3(0.8f, 0.5f + 0.1f * x, 0.2f)});
        cards.push_back({{0.4f * x - 0.05f, 0.1f * x},
                         {0.4f * x + 0.05f, 10},
                         2.5f,
                         vec3(0.1f, 0.6f - 0.1f * x, 0.1f * static_cast<float>(i & 1))});
    }
    return cardScene(cards);
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

std::vector<vec3> tracedMeans(const Scene& scene, const Camera& camera, uvec2 extent,
                              uint samples) {
    TraceBackendRegistry brute;
    brute.add("brute", "every triangle", [](const Devices&) { return makeBruteBackend(); });
    PassRun trace(tracePass());
    trace.extent(extent).scene(scene).camera(camera).tracers(brute).param("samples", samples);
    std::vector<uvec3> requests;
    for (uint pixel = 0; pixel < extent.x * extent.y; ++pixel)
        requests.push_back({pixel, 0, samples});
    trace.list("requests", requests).execute();
    std::vector<vec3> means(requests.size(), vec3(0));
    for (const Sample& sample : trace.output<Sample>("samples"))
        means[sample.pixel] += sample.radiance / static_cast<float>(samples);
    return means;
}

} // namespace hone::test

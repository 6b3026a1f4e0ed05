// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/builtin_scenes.h"
#include "hone/core/scene/builtin_shape.h"

namespace hone {
namespace {

/// A block standing on the floor, without the face it stands on. Corners (x, z) counter-clockwise
/// seen from above.
Shape block(const vec2 (&corners)[4], float height) {
    Shape shape;
    const auto at = [&](std::size_t i, float y) {
        return vec3(corners[i % 4].x, y, corners[i % 4].y);
    };
    for (std::size_t i = 0; i < 4; ++i)
        shape.addQuad(at(i, 0), at(i + 1, 0), at(i + 1, height), at(i, height));
    shape.addQuad(at(0, height), at(1, height), at(2, height), at(3, height));
    return shape;
}

Shape quad(vec3 a, vec3 b, vec3 c, vec3 d) {
    Shape shape;
    shape.addQuad(a, b, c, d);
    return shape;
}

} // namespace

/// The Cornell box (Goral et al. 1984; the measured data of Cornell's Program of Computer Graphics,
/// walls made square), 1 unit = 1 metre, x to the left as seen by the camera. The tall block is a
/// mirror.
Scene cornellScene() {
    Scene scene;
    const uint white = addMaterial(scene, "white", diffuse({0.73f, 0.73f, 0.73f}));
    const uint red = addMaterial(scene, "red", diffuse({0.63f, 0.065f, 0.05f}));
    const uint green = addMaterial(scene, "green", diffuse({0.14f, 0.45f, 0.091f}));
    const uint silver = addMaterial(scene, "mirror", mirror(vec3(0.95f)));
    const vec3 radiance(17.0f, 12.0f, 4.0f);
    Material lamp_material = diffuse(vec3(0.78f));
    lamp_material.emission = radiance;
    const uint lamp = addMaterial(scene, "lamp", lamp_material);

    constexpr float w = 5.5f, h = 5.488f, d = 5.592f;
    const auto add = [&](const char* name, const Shape& shape, uint material) {
        return addInstance(scene, name, addMesh(scene, shape, material));
    };
    add("floor", quad({0, 0, 0}, {0, 0, d}, {w, 0, d}, {w, 0, 0}), white);
    add("ceiling", quad({0, h, 0}, {w, h, 0}, {w, h, d}, {0, h, d}), white);
    add("back wall", quad({w, 0, d}, {0, 0, d}, {0, h, d}, {w, h, d}), white);
    add("red wall", quad({w, 0, 0}, {w, 0, d}, {w, h, d}, {w, h, 0}), red);
    add("green wall", quad({0, 0, d}, {0, 0, 0}, {0, h, 0}, {0, h, d}), green);
    // Seen from inside only: it gives the mirror something to show, and the camera looks through
    // it.
    add("front wall", quad({0, 0, 0}, {w, 0, 0}, {w, h, 0}, {0, h, 0}), white);
    add("short block",
        block({{0.82f, 2.25f}, {2.40f, 2.72f}, {2.90f, 1.14f}, {1.30f, 0.65f}}, 1.65f), white);
    const uint tall =
        add("tall block",
            block({{2.65f, 2.96f}, {3.14f, 4.56f}, {4.72f, 4.06f}, {4.23f, 2.47f}}, 3.3f), silver);
    // The lamp hangs a centimetre below the ceiling, its light a centimetre below the lamp.
    add("lamp",
        quad({2.13f, h - 0.01f, 2.27f}, {3.43f, h - 0.01f, 2.27f}, {3.43f, h - 0.01f, 3.32f},
             {2.13f, h - 0.01f, 3.32f}),
        lamp);
    scene.lights.push_back(
        rectangleLight({2.78f, h - 0.02f, 2.795f}, {0.65f, 0, 0}, {0, 0, 0.525f}, radiance));
    scene.environment.ambient = vec3(0.25f, 0.2f, 0.13f);
    scene.probes.push_back({{3.685f, 1.65f, 3.515f}, tall});
    scene.instances[tall].probe = 0;
    scene.cameras.push_back({.name = "front",
                             .position = {2.78f, 2.73f, -8.0f},
                             .target = {2.78f, 2.73f, 0},
                             .fov_y_degrees = 39.3f});
    return scene;
}

} // namespace hone

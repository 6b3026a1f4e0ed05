// SPDX-License-Identifier: Apache-2.0
//
// Scenes whose exact image is known on paper. Tests compute their expected values from the numbers
// in these comments.
#include "hone/core/scene/builtin_scenes.h"
#include "hone/core/scene/builtin_shape.h"
#include "hone/core/scene/builtin_textures.h"

#include <cmath>
#include <numbers>

namespace hone {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

Shape quad(vec3 a, vec3 b, vec3 c, vec3 d) {
    Shape shape;
    shape.addQuad(a, b, c, d);
    return shape;
}

/// A sphere about the origin; `stacks` from pole to pole. uv: longitude / 2 pi from -x over +z
/// (v = 0 at the top).
Shape sphere(float radius, uint slices, uint stacks, bool inward) {
    Shape shape;
    shape.addSheet({slices, stacks}, vec2(1), [&](float u, float v) {
        const float longitude = 2.0f * kPi * u, colatitude = kPi * v;
        return radius * vec3(-std::sin(colatitude) * std::cos(longitude), std::cos(colatitude),
                             std::sin(colatitude) * std::sin(longitude));
    });
    // Exact at the poles and the seam, where differences are not.
    for (std::size_t i = 0; i < shape.positions.size(); ++i) {
        const auto column = static_cast<uint>(i) % (slices + 1);
        const auto row = static_cast<uint>(i) / (slices + 1);
        if (row == 0 || row == stacks)
            shape.positions[i] = {0, row == 0 ? radius : -radius, 0};
        else if (column == slices)
            shape.positions[i] = shape.positions[i - slices];
        shape.normals[i] = shape.positions[i] / radius;
    }
    std::erase_if(shape.triangles, [&](uvec3 t) {
        const vec3 a = shape.positions[t.x], b = shape.positions[t.y], c = shape.positions[t.z];
        return a == b || b == c || c == a;
    });
    for (uvec3& triangle : shape.triangles) {
        const vec3 a = shape.positions[triangle.x];
        const vec3 normal = cross(shape.positions[triangle.y] - a, shape.positions[triangle.z] - a);
        if ((dot(normal, a) > 0.0f) == inward)
            std::swap(triangle.y, triangle.z);
    }
    if (inward)
        for (vec3& normal : shape.normals)
            normal = -normal;
    return shape;
}

/// A spherical room of radius 5 that shines L(w) = 1/2 + 1/2 w.x to its centre: a texture of L
/// under an ambient light of 1, without any other light.
void addShiningRoom(Scene& scene) {
    const uint texture = addTexture(
        scene, {1024, 256},
        [](vec2 p) {
            const float x = -std::sin(kPi * p.y) * std::cos(2.0f * kPi * p.x);
            return vec4(vec3(0.5f + 0.5f * x), 1.0f);
        },
        0, 1);
    const uint material = addMaterial(scene, "room", diffuse(vec3(1), texture));
    addInstance(scene, "room", addMesh(scene, sphere(5, 256, 128, true), material));
    scene.environment.ambient = vec3(1);
}

/// Side 2, 10 m above the origin, shining down; irradiance under its centre is about pi.
Light lightAboveOrigin() {
    return rectangleLight({0, 10, 0}, {1, 0, 0}, {0, 0, 1}, vec3(25.0f * kPi));
}

void useSky(Scene& scene) {
    scene.environment = {.zenith = {0.2f, 0.4f, 0.9f},
                         .horizon = {0.8f, 0.9f, 1.0f},
                         .ground = {0.2f, 0.18f, 0.15f},
                         .ambient = vec3(0.2f)};
}

} // namespace

/// A mirror sphere of radius 1 at the origin (reflectance 1) with its probe at its centre, in the
/// shining room of radius 5.
Scene mirrorSphereScene() {
    Scene scene;
    addShiningRoom(scene);
    const uint material = addMaterial(scene, "mirror", mirror(vec3(1)));
    const uint ball =
        addInstance(scene, "sphere", addMesh(scene, sphere(1, 256, 128, false), material));
    scene.probes.push_back({vec3(0), ball});
    scene.instances[ball].probe = 0;
    scene.cameras.push_back(
        {.name = "side", .position = {0, 0, 4}, .target = vec3(0), .fov_y_degrees = 32});
    scene.cameras.push_back(
        {.name = "axis", .position = {4, 0, 0}, .target = vec3(0), .fov_y_degrees = 32});
    return scene;
}

/// A mirror (reflectance 1) in the plane z = 0, x and y in [-2, 2], front to +z, in the shining
/// room of radius 5; the probe is at (0, 0, 1).
Scene planarMirrorScene() {
    Scene scene;
    addShiningRoom(scene);
    const uint material = addMaterial(scene, "mirror", mirror(vec3(1)));
    const uint plane =
        addInstance(scene, "mirror",
                    addMesh(scene, quad({-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}), material));
    scene.probes.push_back({{0, 0, 1}, plane});
    scene.instances[plane].probe = 0;
    scene.cameras.push_back(
        {.name = "front", .position = {0, 0, 3}, .target = vec3(0), .fov_y_degrees = 60});
    return scene;
}

/// A floor at y = 0 under a square light of side 2 at y = 10; an occluder at y = 4 covers x < 0.
/// The visible part of the light at (x, 0, z) is clamp(1/2 + x * 6 / 8, 0, 1) for |z| < 3.
Scene straightEdgeScene() {
    Scene scene;
    const uint grey = addMaterial(scene, "floor", diffuse(vec3(0.5f)));
    Material sheet = diffuse(vec3(0.5f));
    sheet.flags = kMaterialTwoSided;
    const uint occluder = addMaterial(scene, "occluder", sheet);
    addInstance(scene, "floor",
                addMesh(scene, quad({-6, 0, 6}, {6, 0, 6}, {6, 0, -6}, {-6, 0, -6}), grey));
    addInstance(scene, "occluder",
                addMesh(scene, quad({-8, 4, 8}, {0, 4, 8}, {0, 4, -8}, {-8, 4, -8}), occluder));
    scene.lights.push_back(lightAboveOrigin());
    useSky(scene);
    scene.cameras.push_back({.name = "edge",
                             .position = {0, 3.5f, 0},
                             .target = vec3(0),
                             .up = {0, 0, -1},
                             .fov_y_degrees = 60});
    return scene;
}

/// Receivers that nothing shadows: a floor at y = 0, x in [-5, -0.5], and a plane through the
/// origin that rises at 80 degrees, so that the square light of side 2 at y = 10 reaches it at
/// grazing angles. The whole light is above every point of both.
Scene litFloorScene() {
    Scene scene;
    const uint grey = addMaterial(scene, "grey", diffuse(vec3(0.5f)));
    addInstance(scene, "floor",
                addMesh(scene, quad({-5, 0, 3}, {-0.5f, 0, 3}, {-0.5f, 0, -3}, {-5, 0, -3}), grey));
    const vec3 rise(2.0f * std::cos(kPi * 80 / 180), 2.0f * std::sin(kPi * 80 / 180), 0);
    const vec3 near(0, 0, 2), far(0, 0, -2);
    addInstance(scene, "slanted plane",
                addMesh(scene, quad(far, near, near + rise, far + rise), grey));
    scene.lights.push_back(lightAboveOrigin());
    useSky(scene);
    scene.cameras.push_back({.name = "both",
                             .position = {-5, 3.5f, 2.5f},
                             .target = {-0.8f, 0.6f, 0},
                             .fov_y_degrees = 50});
    return scene;
}

/// Only the sky.
Scene emptyScene() {
    Scene scene;
    useSky(scene);
    scene.cameras.push_back({.name = "ahead"});
    return scene;
}

/// (-1,-1,0), (1,-1,0), (0,1,0), front to +z; light along -z of irradiance pi: albedo (1/2, 1/4,
/// 1/8) leaves as that much radiance, and a fifth of it more is ambient.
Scene oneTriangleScene() {
    Scene scene;
    Shape shape;
    shape.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
    shape.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    shape.uvs = {{0, 1}, {1, 1}, {0.5f, 0}};
    shape.triangles = {{0, 1, 2}};
    const uint material = addMaterial(scene, "plain", diffuse({0.5f, 0.25f, 0.125f}));
    addInstance(scene, "triangle", addMesh(scene, shape, material));
    scene.lights.push_back(directionalLight({0, 0, -1}, vec3(kPi)));
    useSky(scene);
    scene.cameras.push_back(
        {.name = "front", .position = {0, 0, 3}, .target = vec3(0), .fov_y_degrees = 45});
    return scene;
}

/// A square, x and y in [-1, 1] at z = 0, of 8 x 8 fields of which the lower left one and every
/// second are holes, before a white wall at z = -1. Field borders are texel borders.
Scene alphaQuadScene() {
    Scene scene;
    const uint texture = addTexture(
        scene, {64, 64},
        [](vec2 p) {
            const auto field = static_cast<uint>(p.x * 8) + static_cast<uint>(p.y * 8);
            return vec4(0.8f, 0.2f, 0.1f, field % 2 == 0 ? 1.0f : 0.0f);
        },
        1, 1);
    Material masked = diffuse(vec3(1), texture);
    masked.flags = kMaterialMasked | kMaterialTwoSided;
    const uint checker = addMaterial(scene, "checker", masked);
    const uint white = addMaterial(scene, "wall", diffuse(vec3(0.8f)));
    Shape square = quad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
    square.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    addInstance(scene, "checker", addMesh(scene, square, checker));
    addInstance(scene, "wall",
                addMesh(scene, quad({-3, -3, -1}, {3, -3, -1}, {3, 3, -1}, {-3, 3, -1}), white));
    scene.lights.push_back(rectangleLight({0.5f, 0.5f, 4}, {0, 0.5f, 0}, {0.5f, 0, 0}, vec3(50)));
    useSky(scene);
    scene.cameras.push_back(
        {.name = "front", .position = {0, 0, 3}, .target = vec3(0), .fov_y_degrees = 45});
    return scene;
}

/// Two squares seen from behind: the left, x in [-1.1, -0.1], single-sided, is not seen (but casts
/// a shadow); the right, x in [0.1, 1.1], two-sided, is.
Scene twoSidedScene() {
    Scene scene;
    const uint single = addMaterial(scene, "single-sided", diffuse({0.8f, 0.1f, 0.1f}));
    Material both = diffuse({0.1f, 0.8f, 0.1f});
    both.flags = kMaterialTwoSided;
    const uint two = addMaterial(scene, "two-sided", both);
    const auto facing_away = [](float left) {
        return quad({left + 1, -0.5f, 0}, {left, -0.5f, 0}, {left, 0.5f, 0}, {left + 1, 0.5f, 0});
    };
    addInstance(scene, "left", addMesh(scene, facing_away(-1.1f), single));
    addInstance(scene, "right", addMesh(scene, facing_away(0.1f), two));
    const uint white = addMaterial(scene, "wall", diffuse(vec3(0.8f)));
    addInstance(scene, "wall",
                addMesh(scene, quad({-3, -3, -1}, {3, -3, -1}, {3, 3, -1}, {-3, 3, -1}), white));
    scene.lights.push_back(directionalLight({0.3f, -0.4f, -1}, vec3(2)));
    useSky(scene);
    scene.cameras.push_back(
        {.name = "behind", .position = {0, 0, 3}, .target = vec3(0), .fov_y_degrees = 45});
    return scene;
}

} // namespace hone

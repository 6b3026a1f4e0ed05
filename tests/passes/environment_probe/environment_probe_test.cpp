// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/support/each_build.h"
#include "hone/tests/support/scene_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace hone {
namespace {

constexpr uint kSize = 16;

/// A wall that fills the view along `axis` at `distance` from the origin, facing it, glowing.
void addWall(test::SceneBuilder& builder, vec3 axis, float distance, vec3 glow) {
    Material material = test::plainMaterial();
    material.emission = glow;
    const vec3 side = std::abs(axis.y) > 0.5f ? vec3(1, 0, 0) : vec3(0, 1, 0);
    const vec3 u = 4.0f * distance * side;
    const vec3 v = 4.0f * distance * glm::cross(side, axis);
    const vec3 middle = distance * axis;
    const vec3 positions[] = {middle - u - v, middle + u - v, middle + u + v, middle - u + v};
    const uvec3 triangles[] = {{0, 1, 2}, {0, 2, 3}};
    builder.add(positions, triangles, builder.addMaterial(material));
}

class EnvironmentProbe : public EachRasterBuild {
protected:
    static std::vector<vec4> mapsOf(const Scene& scene) {
        PassRun run = pass(environmentProbePass());
        run.scene(scene).param("size", kSize).execute();
        return run.output<vec4>("maps");
    }
};

HONE_ON_EACH_BUILD(EnvironmentProbe);

vec4 texel(const std::vector<vec4>& maps, uint probe, uint face, uint x, uint y) {
    return maps[1 + ((probe * 6 + face) * kSize + y) * kSize + x];
}

TEST_P(EnvironmentProbe, SeesRadianceAndEuclideanDistanceOnEachFace) {
    const vec3 axes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    test::SceneBuilder builder;
    for (uint face = 0; face < 6; ++face)
        addWall(builder, axes[face], 2.0f, vec3(0.1f * static_cast<float>(face + 1), 0, 1));
    Scene scene = builder.finish();
    scene.probes = {{vec3(0), kNone}};
    const std::vector<vec4> maps = mapsOf(scene);
    EXPECT_EQ(maps[0], vec4(kSize, 1, 0, 0));
    for (uint face = 0; face < 6; ++face) {
        // Texel (8, 8) looks 1/16 to the right and down of the axis, texel (0, 0) 15/16 off.
        const vec4 middle = texel(maps, 0, face, 8, 8);
        EXPECT_NEAR(middle.x, 0.1f * static_cast<float>(face + 1), 1e-6f) << face;
        EXPECT_NEAR(middle.w, 2.0f * std::sqrt(1 + 2.0f / 256), 1e-5f) << face;
        const vec4 corner = texel(maps, 0, face, 0, 0);
        EXPECT_NEAR(corner.w, 2.0f * std::sqrt(1 + 2 * 225.0f / 256), 1e-5f) << face;
    }
}

TEST_P(EnvironmentProbe, LeavesItsOwnObjectOut) {
    test::SceneBuilder builder;
    addWall(builder, vec3(1, 0, 0), 2.0f, vec3(1, 0, 0));
    addWall(builder, vec3(1, 0, 0), 1.0f, vec3(0, 1, 0));
    Scene scene = builder.finish();
    scene.probes = {{vec3(0), 1}, {vec3(0), kNone}};
    const std::vector<vec4> maps = mapsOf(scene);
    EXPECT_NEAR(texel(maps, 0, 0, 8, 8).x, 1.0f, 1e-6f) << "the wall behind the object";
    EXPECT_NEAR(texel(maps, 1, 0, 8, 8).y, 1.0f, 1e-6f) << "another probe sees the object";
}

TEST_P(EnvironmentProbe, SeesTheSkyWhereNothingIs) {
    test::SceneBuilder builder;
    addWall(builder, vec3(1, 0, 0), 2.0f, vec3(1, 0, 0));
    Scene scene = builder.finish();
    scene.probes = {{vec3(0), kNone}};
    scene.environment.zenith = vec3(0.25f, 0.5f, 1.0f);
    scene.environment.horizon = vec3(0.25f, 0.5f, 1.0f);
    const vec4 up = texel(mapsOf(scene), 0, 2, 8, 8);
    EXPECT_EQ(vec3(up), vec3(0.25f, 0.5f, 1.0f));
    EXPECT_EQ(up.w, 1e30f);
}

TEST_P(EnvironmentProbe, DoesNotSeeBackFaces) {
    // The nearer wall is turned away: it faces -x as seen from x > 1 only.
    test::SceneBuilder builder;
    addWall(builder, vec3(1, 0, 0), 2.0f, vec3(1, 0, 0));
    const uint mesh =
        builder.addMesh(std::vector<vec3>{{1, -4, -4}, {1, 4, -4}, {1, 0, 8}},
                        std::vector<uvec3>{{0, 1, 2}}, builder.addMaterial(test::plainMaterial()));
    builder.addInstance(mesh);
    Scene scene = builder.finish();
    scene.probes = {{vec3(0), kNone}};
    EXPECT_NEAR(texel(mapsOf(scene), 0, 0, 8, 8).x, 1.0f, 1e-6f);
}

/// White, at y = -2 under a probe at the origin, and a lamp of 4 pi W/sr.
Scene litFloor(test::SceneBuilder& builder, vec3 position) {
    addWall(builder, vec3(0, -1, 0), 2.0f, vec3(0));
    Scene scene = builder.finish();
    scene.probes = {{vec3(0), kNone}};
    Light lamp{};
    lamp.kind = kLightPoint;
    lamp.position = position;
    lamp.intensity = vec3(4 * 3.14159265f);
    scene.lights = {lamp};
    return scene;
}

TEST_P(EnvironmentProbe, LightsWhatItSees) {
    test::SceneBuilder builder;
    // I cos / (pi d^2) with d = 2 / cos: cos^3. Texel (8, 8) looks 1/16 to two sides of the axis.
    const vec4 below = texel(mapsOf(litFloor(builder, vec3(0))), 0, 3, 8, 8);
    EXPECT_NEAR(below.x, std::pow(1 + 2.0f / 256, -1.5f), 1e-5f);
}

TEST_P(EnvironmentProbe, DarkensWhatShadowMapsSayIsInShadow) {
    test::SceneBuilder builder;
    // A lamp at y = 1.5 and a square of 0.8 at 0.5: its shadow on the floor is 3.5 times as wide.
    const vec3 positions[] = {
        {-0.4f, 0.5f, 0.4f}, {0.4f, 0.5f, 0.4f}, {0.4f, 0.5f, -0.4f}, {-0.4f, 0.5f, -0.4f}};
    const uvec3 triangles[] = {{0, 1, 2}, {0, 2, 3}};
    builder.add(positions, triangles, builder.addMaterial(test::plainMaterial()));
    const Scene scene = litFloor(builder, vec3(0, 1.5f, 0));
    PassRun shadows = pass(shadowMapPass()), probe = pass(environmentProbePass());
    shadows.scene(scene).param("size", 256u).execute();
    probe.scene(scene).param("size", kSize).input("shadow_maps", shadows.value("maps")).execute();
    const std::vector<vec4> maps = probe.output<vec4>("maps"), all_lit = mapsOf(scene);
    EXPECT_EQ(texel(maps, 0, 3, 8, 8).x, 0.0f);
    EXPECT_GT(texel(all_lit, 0, 3, 8, 8).x, 0.0f) << "without maps";
    const vec4 beside = texel(maps, 0, 3, 0, 8); // at 1.9 m
    EXPECT_GT(beside.x, 0.0f);
    EXPECT_EQ(beside.x, texel(all_lit, 0, 3, 0, 8).x);
}

TEST_P(EnvironmentProbe, SeesTheSkyInMirrors) {
    test::SceneBuilder builder;
    Material mirror = test::plainMaterial(kMaterialMirror | kMaterialTwoSided);
    mirror.base_color = vec3(0); // nothing but the reflection
    mirror.f0 = vec3(1);
    const vec3 positions[] = {{2, -8, 8}, {2, -8, -8}, {2, 8, -8}, {2, 8, 8}};
    const uvec3 triangles[] = {{0, 2, 1}, {0, 3, 2}};
    builder.add(positions, triangles, builder.addMaterial(mirror));
    Scene scene = builder.finish();
    scene.probes = {{vec3(0), kNone}};
    const vec3 sky(0.25f, 0.5f, 1.0f);
    scene.environment = {.zenith = sky, .horizon = sky, .ground = sky, .ambient = vec3(0)};
    const vec4 seen = texel(mapsOf(scene), 0, 0, 8, 8);
    EXPECT_LT(glm::distance(vec3(seen), sky), 1e-6f);
    EXPECT_NEAR(seen.w, 2.0f * std::sqrt(1 + 2.0f / 256), 1e-5f) << "the mirror's distance";
}

} // namespace
} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/support/each_build.h"
#include "hone/tests/support/scene_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace hone {
namespace {

constexpr uint kSize = 64;
constexpr uint kHeader = 8;

/// A horizontal square of half the edge `half` at height y, facing up.
void addFloor(test::SceneBuilder& builder, uint material, float y, float half) {
    const vec3 positions[] = {
        {-half, y, half}, {half, y, half}, {half, y, -half}, {-half, y, -half}};
    const uvec3 triangles[] = {{0, 1, 2}, {0, 2, 3}};
    const vec2 uvs[] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    builder.add(positions, triangles, material, uvs);
}

Light pointLight(vec3 position) {
    Light light{};
    light.kind = kLightPoint;
    light.position = position;
    light.intensity = vec3(1.0f);
    return light;
}

class ShadowMap : public EachRasterBuild {
protected:
    static std::vector<float> mapsOf(const Scene& scene, uint points = 5) {
        PassRun run = pass(shadowMapPass());
        run.scene(scene).param("size", kSize).param("points", points).execute();
        return run.output<float>("maps");
    }
};

HONE_ON_EACH_BUILD(ShadowMap);

float texel(const std::vector<float>& maps, uint map, uint face, uint x, uint y) {
    return maps[kHeader + ((map * 6 + face) * kSize + y) * kSize + x];
}

TEST_P(ShadowMap, HoldsDepthAlongTheAxisOfTheFace) {
    // A floor 5 below the light fills the face that looks down (3) with 5, corners included.
    test::SceneBuilder builder;
    addFloor(builder, builder.addMaterial(test::plainMaterial()), 0, 100);
    Scene scene = builder.finish();
    scene.lights = {pointLight({0, 5, 0})};
    const std::vector<float> maps = mapsOf(scene);
    EXPECT_EQ(maps[0], static_cast<float>(kSize));
    for (uint i : {0u, 13u, kSize - 1})
        EXPECT_NEAR(texel(maps, 0, 3, i, kSize - 1 - i), 5.0f, 1e-4f);
    EXPECT_EQ(texel(maps, 0, 2, 30, 30), 1e30f) << "nothing above";
    // Texel centre y of a side face looks down by 2 (y + 1/2) / 64 - 1: row 63 by 63/64.
    EXPECT_NEAR(texel(maps, 0, 0, 30, 63), 5.0f * 64 / 63, 1e-3f);
    EXPECT_EQ(texel(maps, 0, 0, 30, 31), 1e30f) << "above the horizon";
}

TEST_P(ShadowMap, SeesBothFaces) {
    test::SceneBuilder builder;
    addFloor(builder, builder.addMaterial(test::plainMaterial()), 0, 100);
    Scene scene = builder.finish();
    scene.lights = {pointLight({0, -2, 0})};
    EXPECT_NEAR(texel(mapsOf(scene), 0, 2, 30, 30), 2.0f, 1e-4f);
}

TEST_P(ShadowMap, LooksThroughHolesOfMaskedMaterials) {
    // A square at height 3 whose left half (u < 1/2) is a hole, over a floor.
    test::SceneBuilder builder;
    Material masked = test::plainMaterial(kMaterialMasked);
    masked.base_color_texture = builder.addTexture(2, 1, std::vector<uint>{0u, 0xffffffffu});
    addFloor(builder, builder.addMaterial(test::plainMaterial()), 0, 100);
    addFloor(builder, builder.addMaterial(masked), 3, 100);
    Scene scene = builder.finish();
    scene.lights = {pointLight({0, 5, 0})};
    const std::vector<float> maps = mapsOf(scene);
    // Face 3 looks down with up = -z and right = forward x up = -x... its columns run along
    // cross((0,-1,0), (0,0,-1)) = (1,0,0): the left half is x < 0.
    EXPECT_NEAR(texel(maps, 0, 3, 10, 30), 5.0f, 1e-4f);
    EXPECT_NEAR(texel(maps, 0, 3, 50, 30), 2.0f, 1e-4f);
}

TEST_P(ShadowMap, OfADirectionalLightIsABoxAroundTheScene) {
    // The floor's sphere has the radius 2 sqrt(2); the box begins that far above it.
    test::SceneBuilder builder;
    addFloor(builder, builder.addMaterial(test::plainMaterial()), 1, 2);
    Scene scene = builder.finish();
    Light sun{};
    sun.kind = kLightDirectional;
    sun.direction = vec3(0, -1, 0);
    sun.intensity = vec3(1.0f);
    scene.lights = {sun};
    const std::vector<float> maps = mapsOf(scene);
    const float radius = 2.0f * std::sqrt(2.0f);
    EXPECT_NEAR(maps[5], radius, 1e-5f);
    EXPECT_NEAR(texel(maps, 0, 0, 32, 32), radius, 1e-4f);
    // The square covers 2 / (2 radius) = 0.354 of the box to each side of the middle: +- 22 texels.
    EXPECT_NEAR(texel(maps, 0, 0, 32 + 21, 32), radius, 1e-4f);
    EXPECT_EQ(texel(maps, 0, 0, 32 + 24, 32), 1e30f);
    EXPECT_EQ(texel(maps, 0, 3, 32, 32), 1e30f) << "only the first face is used";
}

TEST_P(ShadowMap, OfARectangleHasFivePointsAndNothingBehind) {
    test::SceneBuilder builder;
    const uint material = builder.addMaterial(test::plainMaterial());
    addFloor(builder, material, 0, 100);
    addFloor(builder, material, 8, 100);
    Scene scene = builder.finish();
    Light light{};
    light.kind = kLightRectangle;
    light.position = vec3(0, 5, 0);
    light.direction = vec3(0, -1, 0);
    light.half_u = vec3(1, 0, 0);
    light.half_v = vec3(0, 1, 0); // leaning out of the plane, to tell the points apart
    light.intensity = vec3(1.0f);
    scene.lights = {light};
    const std::vector<float> maps = mapsOf(scene);
    ASSERT_EQ(maps.size(), kHeader + 5 * 6 * kSize * kSize);
    EXPECT_NEAR(texel(maps, 0, 3, 32, 32), 5.0f, 1e-4f);
    EXPECT_NEAR(texel(maps, 1, 3, 32, 32), 4.0f, 1e-4f);
    EXPECT_NEAR(texel(maps, 4, 3, 32, 32), 6.0f, 1e-4f);
    for (uint k = 0; k < 5; ++k)
        EXPECT_EQ(texel(maps, k, 2, 32, 32), 1e30f) << "the light does not shine up";
    EXPECT_EQ(mapsOf(scene, 1).size(), kHeader + 6 * kSize * kSize);
}

/// A floor 5 below the light.
Scene floorUnder(const Light& light) {
    test::SceneBuilder builder;
    addFloor(builder, builder.addMaterial(test::plainMaterial()), 0, 100);
    Scene scene = builder.finish();
    scene.lights = {light};
    return scene;
}

TEST_P(ShadowMap, OfADiscHasPointsOnItsRim) {
    Light disc = pointLight({0, 5, 0});
    disc.kind = kLightDisc;
    disc.direction = vec3(0, -1, 0);
    disc.half_u = vec3(1, 0, 0);
    disc.half_v = vec3(0, 1, 0); // leaning out of the plane: depth tells the points apart
    const std::vector<float> maps = mapsOf(floorUnder(disc));
    ASSERT_EQ(maps.size(), kHeader + 5 * 6 * kSize * kSize);
    const float rim = std::sqrt(0.5f); // halfway between the axes
    EXPECT_NEAR(texel(maps, 0, 3, 32, 32), 5.0f, 1e-4f);
    EXPECT_NEAR(texel(maps, 1, 3, 32, 32), 5.0f - rim, 1e-4f);
    EXPECT_NEAR(texel(maps, 4, 3, 32, 32), 5.0f + rim, 1e-4f);
    EXPECT_EQ(texel(maps, 0, 2, 32, 32), 1e30f);
}

TEST_P(ShadowMap, OfASphereHasPointsToAllSides) {
    Light sphere = pointLight({0, 5, 0});
    sphere.kind = kLightSphere;
    sphere.radius = 1.5f;
    const std::vector<float> maps = mapsOf(floorUnder(sphere));
    ASSERT_EQ(maps.size(), kHeader + 5 * 6 * kSize * kSize);
    // A regular tetrahedron: two corners below the centre, two above, by radius / sqrt(3).
    const float off = 1.5f / std::sqrt(3.0f);
    const float depths[] = {5, 5 - off, 5 - off, 5 + off, 5 + off};
    for (uint k = 0; k < 5; ++k)
        EXPECT_NEAR(texel(maps, k, 3, 32, 32), depths[k], 1e-4f) << k;
}

TEST_P(ShadowMap, OfTheSunIsSeenFromSeveralDirections) {
    Light sun = pointLight({0, 0, 0});
    sun.kind = kLightDirectional;
    sun.direction = vec3(0, -1, 0);
    sun.radius = 0.2f;
    Scene scene = floorUnder(sun);
    const std::vector<float> maps = mapsOf(scene);
    ASSERT_EQ(maps.size(), kHeader + 5 * 6 * kSize * kSize);
    // Depth changes along a floor by the tangent of the tilt, whichever way that is.
    const float step = 16 * 2 * maps[5] / kSize;
    for (uint k = 0; k < 5; ++k) {
        const float u = (texel(maps, k, 0, 40, 32) - texel(maps, k, 0, 24, 32)) / step;
        const float v = (texel(maps, k, 0, 32, 40) - texel(maps, k, 0, 32, 24)) / step;
        EXPECT_NEAR(std::hypot(u, v), k == 0 ? 0.0f : 0.2f, 1e-4f) << k;
    }
    scene.lights[0].radius = 0;
    EXPECT_EQ(mapsOf(scene).size(), kHeader + 6 * kSize * kSize) << "one direction";
}

TEST_P(ShadowMap, OfALightThatNothingBlocksIsNone) {
    Light light = pointLight({0, 5, 0});
    Scene scene = floorUnder(light);
    scene.lights = {light, light};
    scene.lights[0].shadowless = 1;
    const std::vector<float> maps = mapsOf(scene);
    ASSERT_EQ(maps.size(), kHeader + 6 * kSize * kSize);
    EXPECT_NEAR(texel(maps, 0, 3, 32, 32), 5.0f, 1e-4f) << "the second light's comes first";
}

} // namespace
} // namespace hone

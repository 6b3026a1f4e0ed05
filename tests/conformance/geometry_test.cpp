// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/conformance/conformance.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace hone::test {
namespace {

using Triangles = std::vector<uvec3>;
using Positions = std::vector<vec3>;

/// Single-sided triangles at the given heights, larger than the unit square, seen from above.
SceneBuilder layers(const std::vector<float>& heights) {
    SceneBuilder builder;
    const uint material = builder.addMaterial(plainMaterial());
    for (const float z : heights)
        builder.add(Positions{{-4, -4, z}, {8, -4, z}, {-4, 8, z}}, Triangles{{0, 1, 2}}, material);
    return builder;
}

TEST_P(TracerConformance, SeesATriangleThroughItsCentre) {
    build(layers({0}));
    EXPECT_EQ(closest({{0, 0, 5}, 0, {0, 0, -1}, 1e30f}), (Hit{0, 0}));
    EXPECT_TRUE(occluded({{0, 0, 5}, 0, {0, 0, -1}, 1e30f}));
}

TEST_P(TracerConformance, SeesNothingBesideATriangle) {
    build(layers({0}));
    EXPECT_EQ(closest({{2.1f, 2.1f, 5}, 0, {0, 0, -1}, 1e30f}), kMiss);
    EXPECT_EQ(closest({{-4.1f, 0, 5}, 0, {0, 0, -1}, 1e30f}), kMiss);
    EXPECT_FALSE(occluded({{2.1f, 2.1f, 5}, 0, {0, 0, -1}, 1e30f}));
}

TEST_P(TracerConformance, SeesTheNearestOfManyLayers) {
    build(layers({0, 3, 1, 4, 2}));
    EXPECT_EQ(closest({{0, 0, 5}, 0, {0, 0, -1}, 1e30f}), (Hit{3, 0}));
    EXPECT_EQ(closest({{0, 0, 3.5f}, 0, {0, 0, -1}, 1e30f}), (Hit{1, 0}));
    EXPECT_EQ(closest({{0, 0, 2.5f}, 0, {0.1f, 0.1f, -1}, 1e30f}), (Hit{4, 0}));
}

TEST_P(TracerConformance, CountsPrimitivesInsideTheirMesh) {
    SceneBuilder builder;
    const uint material = builder.addMaterial(plainMaterial());
    const UnitSquare square;
    builder.add(Positions{{9, 9, 9}, {10, 9, 9}, {9, 10, 9}}, Triangles{{0, 1, 2}}, material);
    const uint instance = square.addTo(builder, material);
    build(builder);
    EXPECT_EQ(closest(rayTo({0.75f, 0.25f, 1}, {0.75f, 0.25f, 0})), (Hit{instance, 0}));
    EXPECT_EQ(closest(rayTo({0.25f, 0.75f, 1}, {0.25f, 0.75f, 0})), (Hit{instance, 1}));
}

TEST_P(TracerConformance, SeesOneOfTwoTrianglesWhereARayMeetsTheirEdgeExactly) {
    SceneBuilder builder;
    UnitSquare().addTo(builder, builder.addMaterial(plainMaterial()));
    build(builder);
    for (int i = 1; i < 64; ++i) {
        const float s = static_cast<float>(i) / 64.0f; // exact, and so is all arithmetic on it
        for (const Hit& hit : closestInAllModes({{s, s, 2}, 0, {0, 0, -1}, 1e30f})) {
            EXPECT_EQ(hit.instance, 0u) << "at " << s;
            EXPECT_LE(hit.primitive, 1u);
        }
        EXPECT_TRUE(occluded({{s, s, 2}, 0, {0, 0, -1}, 1e30f})) << "at " << s;
    }
}

TEST_P(TracerConformance, SeesATriangleWhereAnAxisRayMeetsTheHubOfAFan) {
    Positions positions{{0, 0, 0}};
    Triangles triangles;
    for (uint i = 0; i < 12; ++i) {
        const float angle = static_cast<float>(i) * 0.5235988f;
        positions.emplace_back(std::cos(angle), std::sin(angle), 0);
        triangles.emplace_back(0, i + 1, (i + 1) % 12 + 1);
    }
    SceneBuilder builder;
    builder.add(positions, triangles, builder.addMaterial(plainMaterial()));
    build(builder);
    for (const Hit& hit : closestInAllModes({{0, 0, 1}, 0, {0, 0, -1}, 1e30f}))
        EXPECT_EQ(hit.instance, 0u);
    EXPECT_TRUE(occluded({{0, 0, 1}, 0, {0, 0, -1}, 1e30f}));
}

// Rays aimed from anywhere at points on a shared edge that no float holds exactly. Tracers need not
// be watertight, but a crack must be thinner than rounding: fewer than one in ten thousand of these
// worst rays may slip through.
TEST_P(TracerConformance, LetsAlmostNoRayThroughASharedEdge) {
    SceneBuilder builder;
    builder.add(
        Positions{
            {-1.1f, -0.7f, 0.13f}, {1.3f, -0.2f, -0.4f}, {0.9f, 1.7f, 0.31f}, {-1.2f, 0.8f, 0.2f}},
        Triangles{{0, 1, 2}, {0, 2, 3}}, builder.addMaterial(plainMaterial(kMaterialTwoSided)));
    build(builder);
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<Ray> rays(rayCount(100'000));
    for (Ray& ray : rays) {
        const float s = 0.01f + 0.98f * unit(random);
        const vec3 target = glm::mix(vec3(-1.1f, -0.7f, 0.13f), vec3(0.9f, 1.7f, 0.31f), s);
        ray = rayTo({4 * unit(random) - 2, 4 * unit(random) - 2, 2 + 3 * unit(random)}, target);
    }
    for (const Mode& mode : kModes) {
        const std::vector<Hit> hits = closestOf(rays, mode);
        const std::vector<uint> occluded = occludedOf(rays, mode);
        EXPECT_LE(std::ranges::count(hits, kMiss), 10);
        EXPECT_LE(std::ranges::count(occluded, 0u), 10);
    }
}

TEST_P(TracerConformance, SeesOneOfTwoTrianglesInTheSamePlace) {
    build(layers({1, 1}));
    for (const Hit& hit : closestInAllModes({{0, 0, 5}, 0, {0.1f, 0, -1}, 1e30f})) {
        EXPECT_LE(hit.instance, 1u);
        EXPECT_EQ(hit.primitive, 0u);
    }
}

TEST_P(TracerConformance, SeesNothingOfATriangleFromItsPlane) {
    build(layers({0}));
    EXPECT_EQ(closest({{-9, 0, 0}, 0, {1, 0, 0}, 1e30f}), kMiss);
    EXPECT_EQ(closest({{0, 0, 0}, 0, {1, 1, 0}, 1e30f}), kMiss);
    EXPECT_FALSE(occluded({{-9, 0, 0}, 0, {1, 0, 0}, 1e30f}));
}

TEST_P(TracerConformance, SeesATriangleAtAGrazingAngle) {
    build(layers({0}));
    EXPECT_EQ(closest({{-100, 0, 0.1f}, 0, {1, 0, -0.001f}, 1e30f}), (Hit{0, 0})); // meets at x = 0
}

TEST_P(TracerConformance, NeverSeesTrianglesWithoutArea) {
    SceneBuilder builder;
    const uint material = builder.addMaterial(plainMaterial(kMaterialTwoSided));
    builder.add(Positions{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 2, 0}},
                Triangles{{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 2}, {3, 3, 0}}, material);
    const uint behind = builder.add(Positions{{-9, -9, -1}, {9, -9, -1}, {0, 9, -1}},
                                    Triangles{{0, 1, 2}}, material);
    build(builder);
    for (const vec2 at : {vec2(0, 0), vec2(0.5f, 0), vec2(1, 0), vec2(2, 0), vec2(0, 1)}) {
        EXPECT_EQ(closest({{at.x, at.y, 1}, 0, {0, 0, -1}, 1e30f}), (Hit{behind, 0}));
        EXPECT_EQ(closest(rayTo({at.x + 0.3f, 1, 1}, {at.x, at.y, 0})), (Hit{behind, 0}));
        EXPECT_FALSE(occluded({{at.x, at.y, 1}, 0, {0, 0, -1}, 1.5f}));
    }
}

TEST_P(TracerConformance, SeesTinyTriangles) {
    SceneBuilder builder;
    const float s = 1e-4f;
    builder.add(Positions{{0, 0, 0}, {s, 0, 0}, {0, s, 0}}, Triangles{{0, 1, 2}},
                builder.addMaterial(plainMaterial()));
    build(builder);
    EXPECT_EQ(closest(rayTo({0.01f, 0.02f, 1}, {0.3f * s, 0.3f * s, 0})), (Hit{0, 0}));
    EXPECT_EQ(closest(rayTo({0.01f, 0.02f, 1}, {0.7f * s, 0.7f * s, 0})), kMiss);
}

TEST_P(TracerConformance, SeesHugeTriangles) {
    SceneBuilder builder;
    const float s = 1e6f;
    builder.add(Positions{{-s, -s, 0}, {s, -s, 0}, {0, s, 0}}, Triangles{{0, 1, 2}},
                builder.addMaterial(plainMaterial()));
    build(builder);
    EXPECT_EQ(closest(rayTo({3, 4, 5}, {1, 2, 0})), (Hit{0, 0}));
    EXPECT_EQ(closest(rayTo({3, 4, 5}, {0.2f * s, 0.1f * s, 0})), (Hit{0, 0}));
    EXPECT_EQ(closest(rayTo({3, 4, 5}, {1.1f * s, 0, 0})), kMiss);
}

TEST_P(TracerConformance, SeesASceneFarFromTheOrigin) {
    SceneBuilder builder;
    const uint mesh = UnitSquare().addMeshTo(builder, builder.addMaterial(plainMaterial()));
    const vec3 far(100'000, -50'000, 20'000); // a float's step is 1/128 there
    mat4 place(1);
    place[3] = vec4(far, 1);
    builder.addInstance(mesh, place);
    build(builder);
    EXPECT_EQ(closest(rayTo(far + vec3(0.75f, 0.25f, 8), far + vec3(0.75f, 0.25f, 0))),
              (Hit{0, 0}));
    EXPECT_EQ(closest(rayTo(far + vec3(0.25f, 0.75f, 8), far + vec3(0.25f, 0.75f, 0))),
              (Hit{0, 1}));
    EXPECT_EQ(closest(rayTo(far + vec3(1.5f, 0.5f, 8), far + vec3(1.5f, 0.5f, 0))), kMiss);
}

TEST_P(TracerConformance, SeesNothingInAnEmptyScene) {
    build(SceneBuilder());
    EXPECT_EQ(closest({{0, 0, 5}, 0, {0, 0, -1}, 1e30f}), kMiss);
    EXPECT_FALSE(occluded({{0, 0, 5}, 0, {0, 0, -1}, 1e30f}));
}

TEST_P(TracerConformance, PassesByMeshesWithoutTriangles) {
    SceneBuilder builder;
    const uint material = builder.addMaterial(plainMaterial());
    const uint nothing = builder.addMesh({}, {}, material);
    builder.addInstance(nothing);
    builder.addInstance(nothing);
    const uint square = UnitSquare().addTo(builder, material);
    build(builder);
    EXPECT_EQ(closest({{0.75f, 0.25f, 5}, 0, {0, 0, -1}, 1e30f}), (Hit{square, 0}));
}

} // namespace
} // namespace hone::test

// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/conformance/conformance.h"

#include <glm/gtc/matrix_transform.hpp>

namespace hone::test {
namespace {

Ray downAt(float x, float y, float from = 50) {
    return {{x, y, from}, 0, {0, 0, -1}, 1e30f};
}

/// Instances of one mesh, the unit square of a single-sided material.
SceneBuilder squares(const std::vector<mat4>& places) {
    SceneBuilder builder;
    const uint mesh = UnitSquare().addMeshTo(builder, builder.addMaterial(plainMaterial()));
    for (const mat4& place : places)
        builder.addInstance(mesh, place);
    return builder;
}

TEST_P(TracerConformance, NamesTheInstanceThatIsSeen) {
    build(squares({glm::translate(mat4(1), vec3(0, 0, 0)), glm::translate(mat4(1), vec3(5, 0, 0)),
                   glm::translate(mat4(1), vec3(0, 5, 0))}));
    EXPECT_EQ(closest(downAt(0.75f, 0.25f)), (Hit{0, 0}));
    EXPECT_EQ(closest(downAt(5.75f, 0.25f)), (Hit{1, 0}));
    EXPECT_EQ(closest(downAt(0.25f, 5.75f)), (Hit{2, 1}));
    EXPECT_EQ(closest(downAt(5.5f, 5.25f)), kMiss);
    EXPECT_TRUE(occluded(downAt(5.75f, 0.25f)));
    EXPECT_FALSE(occluded(downAt(5.5f, 5.25f)));
}

TEST_P(TracerConformance, PlacesAScaledInstance) {
    build(squares({glm::scale(mat4(1), vec3(10, 4, 1)), glm::translate(mat4(1), vec3(90))}));
    EXPECT_EQ(closest(downAt(9.5f, 0.5f)), (Hit{0, 0})); // (0.95, 0.125) in the mesh
    EXPECT_EQ(closest(downAt(2.0f, 3.5f)), (Hit{0, 1})); // (0.2, 0.875)
    EXPECT_EQ(closest(downAt(9.5f, 4.5f)), kMiss);
    EXPECT_EQ(closest(downAt(10.5f, 0.5f)), kMiss);
}

TEST_P(TracerConformance, PlacesARotatedInstance) {
    // A quarter turn about z takes (x, y) to (-y, x).
    build(squares(
        {glm::rotate(mat4(1), 1.57079633f, vec3(0, 0, 1)), glm::translate(mat4(1), vec3(90))}));
    EXPECT_EQ(closest(downAt(-0.25f, 0.75f)), (Hit{0, 0})); // (0.75, 0.25) in the mesh
    EXPECT_EQ(closest(downAt(-0.75f, 0.25f)), (Hit{0, 1})); // (0.25, 0.75)
    EXPECT_EQ(closest(downAt(0.25f, 0.75f)), kMiss);
}

TEST_P(TracerConformance, PlacesAShearedInstance) {
    mat4 shear(1);
    shear[1][0] = 2; // x' = x + 2 y
    shear[0][2] = 3; // z' = z + 3 x
    build(squares({shear, glm::translate(mat4(1), vec3(90))}));
    EXPECT_EQ(closest(downAt(1.25f, 0.25f)), (Hit{0, 0})); // (0.75, 0.25) in the mesh
    EXPECT_EQ(closest(downAt(1.75f, 0.75f)), (Hit{0, 1})); // (0.25, 0.75)
    EXPECT_EQ(closest(downAt(0.25f, 0.25f)), kMiss);       // (-0.25, 0.25)
    // Height 3 x = 2.25 above (0.75, 0.25): t is 47.75 from height 50.
    Ray ray = downAt(1.25f, 0.25f);
    ray.tmax = 47.74f;
    EXPECT_EQ(closest(ray), kMiss);
    ray.tmax = 47.76f;
    EXPECT_EQ(closest(ray), (Hit{0, 0}));
}

TEST_P(TracerConformance, OrdersOverlappingInstancesByDistance) {
    // Boxes of squares inside each other: larger squares higher up.
    std::vector<mat4> places;
    for (int i = 0; i < 8; ++i) {
        const float size = static_cast<float>(1 << i);
        places.push_back(glm::scale(glm::translate(mat4(1), vec3(-size / 2, -size / 2, i)),
                                    vec3(size, size, 1)));
    }
    build(squares(places));
    EXPECT_EQ(closest(downAt(0.2f, 0.1f)).instance, 7u);
    EXPECT_EQ(closest(downAt(0.2f, 0.1f, 6.5f)).instance, 6u);
    EXPECT_EQ(closest(downAt(0.2f, 0.1f, 0.5f)).instance, 0u);
    EXPECT_EQ(closest(downAt(3.0f, 0.1f, 2.5f)), kMiss);
    EXPECT_EQ(closest(downAt(3.0f, 0.1f, 3.5f)).instance, 3u);
}

TEST_P(TracerConformance, NamesThousandsOfInstances) {
    std::vector<mat4> places;
    for (int y = 0; y < 50; ++y)
        for (int x = 0; x < 50; ++x)
            places.push_back(glm::translate(mat4(1), vec3(x, y, (x * 7 + y * 3) % 5)));
    build(squares(places));
    for (uint i = 0; i < 2500; i += 83) {
        const auto x = static_cast<float>(i % 50);
        const auto y = static_cast<float>(i / 50);
        EXPECT_EQ(closest(downAt(x + 0.75f, y + 0.25f)), (Hit{i, 0}));
        EXPECT_EQ(closest(downAt(x + 0.25f, y + 0.75f)), (Hit{i, 1}));
    }
}

TEST_P(TracerConformance, SeesAnInstanceFlattenedToAPlane) {
    build(squares({glm::scale(mat4(1), vec3(1, 1, 0)), glm::translate(mat4(1), vec3(90))}));
    EXPECT_EQ(closest(downAt(0.75f, 0.25f)).instance, 0u);
    EXPECT_TRUE(occluded(downAt(0.75f, 0.25f)));
}

} // namespace
} // namespace hone::test

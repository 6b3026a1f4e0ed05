// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/conformance/conformance.h"

#include <glm/gtc/matrix_transform.hpp>

namespace hone::test {
namespace {

constexpr Ray kDown{{0.75f, 0.125f, 5}, 0, {0, 0, -1}, 1e30f}; // sees the square's front
constexpr Ray kUp{{0.75f, 0.125f, -5}, 0, {0, 0, 1}, 1e30f};   // sees its back

/// Two instances of the unit square, so that tracers may instance it: one placed by `place`, one
/// far away.
SceneBuilder placedSquare(uint flags, const mat4& place) {
    SceneBuilder builder;
    const uint mesh = UnitSquare().addMeshTo(builder, builder.addMaterial(plainMaterial(flags)));
    builder.addInstance(mesh, place);
    builder.addInstance(mesh, glm::translate(mat4(1), vec3(1000, 1000, 1000)));
    return builder;
}

TEST_P(TracerConformance, DoesNotSeeBackFacesOfSingleSidedMaterials) {
    build(placedSquare(0, mat4(1)));
    EXPECT_EQ(closest(kDown), (Hit{0, 0}));
    EXPECT_EQ(closest(kUp), kMiss);
}

TEST_P(TracerConformance, SeesBothFacesOfTwoSidedMaterials) {
    build(placedSquare(kMaterialTwoSided, mat4(1)));
    EXPECT_EQ(closest(kDown), (Hit{0, 0}));
    EXPECT_EQ(closest(kUp), (Hit{0, 0}));
}

TEST_P(TracerConformance, IsOccludedByBothFaces) {
    build(placedSquare(0, mat4(1)));
    EXPECT_TRUE(occluded(kDown));
    EXPECT_TRUE(occluded(kUp));
}

TEST_P(TracerConformance, SeesTheFrontFacesOfAMirroredInstance) {
    // Mirrored in x: the square spans [0,1] again, and its corners turn clockwise seen from above,
    // which is the front of a mirrored instance.
    build(placedSquare(0, glm::scale(glm::translate(mat4(1), vec3(1, 0, 0)), vec3(-1, 1, 1))));
    ASSERT_EQ(scene_.instances[0].flipped, 1u);
    EXPECT_EQ(closest(kDown), (Hit{0, 0})); // (0.25, 0.125) in the mesh
    EXPECT_EQ(closest(kUp), kMiss);
    EXPECT_TRUE(occluded(kDown));
    EXPECT_TRUE(occluded(kUp));
}

TEST_P(TracerConformance, SeesTheFrontFacesOfAnInstanceTurnedOver) {
    // Mirrored in z: front faces look down now.
    build(placedSquare(0, glm::scale(mat4(1), vec3(1, 1, -1))));
    EXPECT_EQ(closest(kDown), kMiss);
    EXPECT_EQ(closest(kUp), (Hit{0, 0}));
}

TEST_P(TracerConformance, SeesTheFrontFacesOfARotatedInstance) {
    // Half a turn about x takes (x, y, z) to (x, -y, -z): not mirrored, but looking down.
    const mat4 turn =
        glm::rotate(glm::translate(mat4(1), vec3(0, 1, 0)), 3.14159265f, vec3(1, 0, 0));
    build(placedSquare(0, turn));
    ASSERT_EQ(scene_.instances[0].flipped, 0u);
    EXPECT_EQ(closest(kDown), kMiss);
    EXPECT_EQ(closest({{0.5f, 0.9f, -5}, 0, {0, 0, 1}, 1e30f}),
              (Hit{0, 0})); // (0.5, 0.1) in the mesh
    EXPECT_EQ(closest({{0.5f, 0.1f, -5}, 0, {0, 0, 1}, 1e30f}), (Hit{0, 1}));
}

TEST_P(TracerConformance, SeesTheFrontFaceBehindBackFaces) {
    SceneBuilder builder;
    const uint material = builder.addMaterial(plainMaterial());
    const uint mesh = UnitSquare().addMeshTo(builder, material);
    for (int i = 0; i < 20; ++i) // looking down: back faces for kDown
        builder.addInstance(
            mesh, glm::scale(glm::translate(mat4(1), vec3(0, 0, 1 + 0.1 * i)), vec3(1, 1, -1)));
    const uint front = builder.addInstance(mesh);
    build(builder);
    EXPECT_EQ(closest(kDown), (Hit{front, 0}));
    EXPECT_EQ(closest(kUp), (Hit{0, 0}));
}

TEST_P(TracerConformance, SeesASheetOfTwoSingleSidedFacesFromEitherSide) {
    SceneBuilder builder;
    const uint material = builder.addMaterial(plainMaterial());
    UnitSquare square;
    const uint up = square.addTo(builder, material);
    square.triangles = {{0, 2, 1}, {0, 3, 2}};
    const uint down = square.addTo(builder, material);
    build(builder);
    EXPECT_EQ(closest(kDown), (Hit{up, 0}));
    EXPECT_EQ(closest(kUp), (Hit{down, 0}));
}

TEST_P(TracerConformance, TellsSingleSidedFromTwoSidedInOneScene) {
    SceneBuilder builder;
    const uint single = builder.addMaterial(plainMaterial());
    const uint two_sided = builder.addMaterial(plainMaterial(kMaterialTwoSided));
    const UnitSquare square;
    const uint near = square.addMeshTo(builder, single);
    const uint far = square.addMeshTo(builder, two_sided);
    builder.addInstance(near, glm::translate(mat4(1), vec3(0, 0, -1)));
    const uint seen = builder.addInstance(far);
    build(builder);
    EXPECT_EQ(closest(kUp), (Hit{seen, 0}));
    EXPECT_EQ(closest(kDown), (Hit{seen, 0}));
}

} // namespace
} // namespace hone::test

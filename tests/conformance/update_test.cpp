// SPDX-License-Identifier: Apache-2.0
//
// Instances that move: answers are as if the tracer had been built where they stand now.
#include "hone/tests/conformance/conformance.h"

#include <glm/gtc/matrix_transform.hpp>

#include <array>

namespace hone::test {
namespace {

Ray downAt(float x, float y) {
    return {{x, y, 50}, 0, {0, 0, -1}, 1e30f};
}

Ray upAt(float x, float y) {
    return {{x, y, -50}, 0, {0, 0, 1}, 1e30f};
}

mat4x3 shifted(float x, float y, float z = 0) {
    return mat4x3(glm::translate(mat4(1), vec3(x, y, z)));
}

/// Down at the first triangle of a unit square whose corner is at x.
Ray at(float x) {
    return downAt(x + 0.75f, 0.25f);
}

/// Two unit squares of one mesh, single-sided, at x = 0 and x = 5, and a third of another mesh at
/// x = 10.
SceneBuilder threeSquares() {
    SceneBuilder builder;
    const uint material = builder.addMaterial(plainMaterial());
    const uint mesh = UnitSquare().addMeshTo(builder, material);
    builder.addInstance(mesh);
    builder.addInstance(mesh, glm::translate(mat4(1), vec3(5, 0, 0)));
    builder.addInstance(UnitSquare().addMeshTo(builder, material),
                        glm::translate(mat4(1), vec3(10, 0, 0)));
    return builder;
}

TEST_P(TracerConformance, FindsAnInstanceWhereItMovedAndNotWhereItWas) {
    build(threeSquares());
    move(1, shifted(20, 0));
    EXPECT_EQ(closest(at(0)), (Hit{0, 0}));
    EXPECT_EQ(closest(at(5)), kMiss);
    EXPECT_EQ(closest(at(10)), (Hit{2, 0}));
    EXPECT_EQ(closest(at(20)), (Hit{1, 0}));
    EXPECT_TRUE(occluded(at(20)));
    EXPECT_FALSE(occluded(at(5)));
    move(1, shifted(30, 0));
    EXPECT_EQ(closest(at(5)), kMiss);
    EXPECT_EQ(closest(at(20)), kMiss);
    EXPECT_EQ(closest(at(30)), (Hit{1, 0}));
}

TEST_P(TracerConformance, FindsAnInstanceThatCameBack) {
    build(threeSquares());
    move(0, shifted(20, 0));
    move(0, shifted(0, 0));
    EXPECT_EQ(closest(at(0)), (Hit{0, 0}));
    EXPECT_EQ(closest(at(5)), (Hit{1, 0}));
    EXPECT_EQ(closest(at(20)), kMiss);
}

TEST_P(TracerConformance, FindsSeveralInstancesThatMovedAtOnce) {
    build(threeSquares());
    for (uint i = 0; i < 3; ++i)
        moveInstance(scene_, i, shifted(20 + 5 * static_cast<float>(i), 0));
    const std::array<uint, 3> all{0, 1, 2};
    tracer_->update(all);
    for (const float x : {0.0f, 5.0f, 10.0f}) {
        EXPECT_EQ(closest(at(x)), kMiss);
        EXPECT_FALSE(occluded(at(x)));
    }
    EXPECT_EQ(closest(at(20)), (Hit{0, 0}));
    EXPECT_EQ(closest(at(25)), (Hit{1, 0}));
    EXPECT_EQ(closest(at(30)), (Hit{2, 0}));
}

TEST_P(TracerConformance, SeesTheNearerOfAMovedAndAStillInstance) {
    build(threeSquares());
    move(1, shifted(0, 0, 1));
    EXPECT_EQ(closest(at(0)), (Hit{1, 0}));
    move(1, shifted(0, 0, -1));
    EXPECT_EQ(closest(at(0)), (Hit{0, 0}));
    if (tracer_->caps().settles_ties) {
        move(1, shifted(0, 0));
        EXPECT_EQ(closest(at(0)), (Hit{0, 0})); // at equal distance the lesser instance
        move(0, shifted(0, 0));
        EXPECT_EQ(closest(at(0)), (Hit{0, 0}));
    }
}

TEST_P(TracerConformance, SeesTheFrontOfAnInstanceThatIsMirroredAsItMoves) {
    build(threeSquares());
    // x' = 21 - x: seen from the same side, turned.
    mat4x3 place = shifted(21, 0);
    place[0] = vec3(-1, 0, 0);
    move(1, place);
    EXPECT_EQ(closest(downAt(20.25f, 0.25f)), (Hit{1, 0})); // (0.75, 0.25) in the mesh
    EXPECT_EQ(closest(upAt(20.25f, 0.25f)), kMiss);
    EXPECT_TRUE(occluded(upAt(20.25f, 0.25f)));
    // Turned over: z' = -z and x' = 21 - x.
    place[2] = vec3(0, 0, -1);
    move(1, place);
    EXPECT_EQ(closest(upAt(20.25f, 0.25f)), (Hit{1, 0}));
    EXPECT_EQ(closest(downAt(20.25f, 0.25f)), kMiss);
}

TEST_P(TracerConformance, FollowsAnInstanceThatIsFlattenedAndUnfolds) {
    build(threeSquares());
    mat4x3 place = shifted(20, 0);
    place[2] = vec3(0); // all z become 0: no inverse
    move(1, place);
    EXPECT_EQ(closest(at(20)), (Hit{1, 0}));
    EXPECT_EQ(closest(at(5)), kMiss);
    move(1, shifted(30, 0));
    EXPECT_EQ(closest(at(30)), (Hit{1, 0}));
    EXPECT_EQ(closest(at(20)), kMiss);
}

TEST_P(TracerConformance, MovesHolesWithTheirInstance) {
    SceneBuilder builder;
    const uint texels[] = {0xff'ff'ff'ffu, 0x00'ff'ff'ffu}; // left solid, right hole
    Material material = plainMaterial(kMaterialMasked);
    material.base_color_texture = builder.addTexture(2, 1, texels);
    UnitSquare().addTo(builder, builder.addMaterial(material));
    build(builder);
    move(0, shifted(20, 0));
    EXPECT_EQ(closest(downAt(20.2f, 0.1f)), (Hit{0, 0}));
    EXPECT_EQ(closest(downAt(20.8f, 0.1f)), kMiss);
    EXPECT_FALSE(occluded(downAt(20.8f, 0.1f)));
    EXPECT_EQ(closest(downAt(0.2f, 0.1f)), kMiss);
}

} // namespace
} // namespace hone::test

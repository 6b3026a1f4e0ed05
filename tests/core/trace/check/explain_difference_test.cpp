// SPDX-License-Identifier: Apache-2.0
#include "hone/core/trace/check/explain_difference.h"

#include "hone/tests/support/scene_builder.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <limits>

namespace hone {
namespace {

using test::plainMaterial;
using test::SceneBuilder;
using Positions = std::vector<vec3>;
using Triangles = std::vector<uvec3>;

constexpr Hit kMiss{kNone, kNone};
/// Two steps of a float at 1: what a tracer may round, hundreds of times less than a wrong answer.
constexpr float kStep = 2.4e-7f;

/// The triangle (0,0,z) (1,0,z) (0,1,z), seen from above.
uint addCorner(SceneBuilder& builder, float z, uint material) {
    return builder.add(Positions{{0, 0, z}, {1, 0, z}, {0, 1, z}}, Triangles{{0, 1, 2}}, material);
}

/// Corners at z = 0 and z = -1, so at t = 1 and t = 2 from downAt().
Scene twoLayers(uint flags = 0) {
    SceneBuilder builder;
    const uint material = builder.addMaterial(plainMaterial(flags));
    addCorner(builder, 0, material);
    addCorner(builder, -1, material);
    return builder.finish();
}

Ray downAt(float x, float y, float tmin = 0, float tmax = 1e30f) {
    return {{x, y, 1}, tmin, {0, 0, -1}, tmax};
}

TEST(ExplainDifference, FindsRightWhatIsRight) {
    const Scene scene = twoLayers();
    const DifferenceExplainer explainer(scene);
    const Difference seen = explainer.explainClosest(downAt(0.25f, 0.25f), {0, 0}, {0, 0});
    EXPECT_EQ(seen.kind, DifferenceKind::kNone);
    EXPECT_DOUBLE_EQ(seen.t_a, 1.0);
    const Difference missed = explainer.explainClosest(downAt(2, 2), kMiss, kMiss);
    EXPECT_EQ(missed.kind, DifferenceKind::kNone);
    EXPECT_TRUE(std::isinf(missed.t_a));
}

TEST(ExplainDifference, BlamesAnAnswerBehindWhatIsSurelySeen) {
    const Scene scene = twoLayers();
    const Difference difference =
        DifferenceExplainer(scene).explainClosest(downAt(0.25f, 0.25f), {0, 0}, {1, 0});
    EXPECT_EQ(difference.kind, DifferenceKind::kUnexplained);
    EXPECT_TRUE(difference.is_a_right);
    EXPECT_FALSE(difference.is_b_right);
    EXPECT_DOUBLE_EQ(difference.t_a, 1.0);
    EXPECT_DOUBLE_EQ(difference.t_b, 2.0);
    EXPECT_EQ(difference.witness.instance, 0u);
    EXPECT_DOUBLE_EQ(difference.witness_t, 1.0);
}

TEST(ExplainDifference, BlamesAMissOfWhatIsSurelySeenAndAHitOfNothing) {
    const Scene scene = twoLayers();
    const DifferenceExplainer explainer(scene);
    const Difference missed = explainer.explainClosest(downAt(0.25f, 0.25f), kMiss, {0, 0});
    EXPECT_FALSE(missed.is_a_right);
    EXPECT_TRUE(missed.is_b_right);
    const Difference invented = explainer.explainClosest(downAt(2, 2), kMiss, {1, 0});
    EXPECT_TRUE(invented.is_a_right);
    EXPECT_FALSE(invented.is_b_right);
    EXPECT_TRUE(std::isnan(invented.t_b));
    EXPECT_EQ(invented.witness.instance, kNone);
}

TEST(ExplainDifference, BlamesAWrongAnswerThatBothGive) {
    const Scene scene = twoLayers();
    const Difference difference =
        DifferenceExplainer(scene).explainClosest(downAt(0.25f, 0.25f), {1, 0}, {1, 0});
    EXPECT_EQ(difference.kind, DifferenceKind::kUnexplained);
    EXPECT_FALSE(difference.is_a_right);
    EXPECT_FALSE(difference.is_b_right);
}

TEST(ExplainDifference, BlamesNamesOfNothing) {
    const Scene scene = twoLayers();
    const DifferenceExplainer explainer(scene);
    for (const Hit wrong : {Hit{2, 0}, Hit{0, 1}, Hit{0, kNone}, Hit{kNone, 0}})
        EXPECT_FALSE(explainer.explainClosest(downAt(0.25f, 0.25f), {0, 0}, wrong).is_b_right);
}

TEST(ExplainDifference, CallsTwinsInOnePlaceATie) {
    SceneBuilder builder;
    const uint material = builder.addMaterial(plainMaterial());
    addCorner(builder, 0, material);
    addCorner(builder, 0, material);
    addCorner(builder, -kStep, material);
    addCorner(builder, -1e-3f, material);
    const Scene scene = builder.finish();
    const DifferenceExplainer explainer(scene);
    const Ray ray = downAt(0.25f, 0.25f);
    EXPECT_EQ(explainer.explainClosest(ray, {0, 0}, {1, 0}).kind, DifferenceKind::kTie);
    EXPECT_EQ(explainer.explainClosest(ray, {2, 0}, {1, 0}).kind, DifferenceKind::kTie);
    EXPECT_EQ(explainer.explainClosest(ray, {0, 0}, {3, 0}).kind, DifferenceKind::kUnexplained);
}

TEST(ExplainDifference, CallsTheTwoTrianglesOfAnEdgeATie) {
    SceneBuilder builder;
    builder.add(Positions{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                Triangles{{0, 1, 2}, {0, 2, 3}}, builder.addMaterial(plainMaterial()));
    const Scene scene = builder.finish();
    const DifferenceExplainer explainer(scene);
    EXPECT_EQ(explainer.explainClosest(downAt(0.3f, 0.3f), {0, 0}, {0, 1}).kind,
              DifferenceKind::kTie);
    EXPECT_EQ(explainer.explainClosest(downAt(0.3f, 0.3f + kStep), {0, 0}, {0, 1}).kind,
              DifferenceKind::kTie);
    const Difference clear = explainer.explainClosest(downAt(0.3f, 0.301f), {0, 0}, {0, 1});
    EXPECT_EQ(clear.kind, DifferenceKind::kUnexplained);
    EXPECT_FALSE(clear.is_a_right);
    EXPECT_TRUE(clear.is_b_right);
}

TEST(ExplainDifference, CallsAnOutlineASilhouette) {
    const Scene scene = twoLayers();
    const DifferenceExplainer explainer(scene);
    // The edge along x, from just inside and from just outside; then past a corner.
    for (const Ray& ray : {downAt(0.5f, kStep), downAt(0.5f, -kStep), downAt(1 + kStep, 0)}) {
        const Difference difference = explainer.explainClosest(ray, {0, 0}, {1, 0});
        EXPECT_EQ(difference.kind, DifferenceKind::kSilhouette);
        EXPECT_EQ(difference.border, Border::kEdge);
        EXPECT_EQ(explainer.explainClosest(ray, kMiss, {1, 0}).kind, DifferenceKind::kSilhouette);
    }
    EXPECT_EQ(explainer.explainClosest(downAt(0.5f, 1e-4f), {0, 0}, {1, 0}).kind,
              DifferenceKind::kUnexplained);
    EXPECT_EQ(explainer.explainClosest(downAt(0.5f, -1e-4f), {0, 0}, kMiss).kind,
              DifferenceKind::kUnexplained);
}

// In the lines of two edges that meet at a needle's tip, but far past the tip.
TEST(ExplainDifference, EndsAnEdgeAtItsCorners) {
    SceneBuilder builder;
    builder.add(Positions{{0, 0, 0}, {1, 0, 0}, {1, 1e-6f, 0}}, Triangles{{0, 1, 2}},
                builder.addMaterial(plainMaterial()));
    const Scene scene = builder.finish();
    const DifferenceExplainer explainer(scene);
    EXPECT_EQ(explainer.explainClosest(downAt(-1e-6f, 0), kMiss, {0, 0}).kind,
              DifferenceKind::kSilhouette);
    EXPECT_EQ(explainer.explainClosest(downAt(-0.1f, 0), kMiss, {0, 0}).kind,
              DifferenceKind::kUnexplained);
}

TEST(ExplainDifference, DoubtsBothFacesOfATriangleSeenEdgeOn) {
    const Scene scene = twoLayers();
    const DifferenceExplainer explainer(scene);
    const Ray in_plane{{-1, 0.25f, 0}, 0, {1, 0, 0}, 1e30f};
    const Ray from_below{{-1, 0.25f, -kStep}, 0, {1, 0, kStep / 4}, 1e30f};
    for (const Ray& ray : {in_plane, from_below}) {
        const Difference difference = explainer.explainClosest(ray, {0, 0}, kMiss);
        EXPECT_EQ(difference.kind, DifferenceKind::kSilhouette);
        EXPECT_EQ(difference.border, Border::kGrazing);
    }
    const Ray slanted{{-1, 0.25f, -0.0125f}, 0, {1, 0, 0.01f}, 1e30f}; // sees its back
    EXPECT_EQ(explainer.explainClosest(slanted, {0, 0}, kMiss).kind, DifferenceKind::kUnexplained);
    EXPECT_EQ(explainer.explainOccluded(slanted, 1, 0).kind, DifferenceKind::kUnexplained);
}

TEST(ExplainDifference, SeesBackFacesOnlyWhereTheyAreSeen) {
    const Ray up{{0.25f, 0.25f, -3}, 0, {0, 0, 1}, 1e30f};
    const Scene single_sided = twoLayers();
    EXPECT_TRUE(DifferenceExplainer(single_sided).explainClosest(up, kMiss, {1, 0}).is_a_right);
    EXPECT_FALSE(DifferenceExplainer(single_sided).explainClosest(up, kMiss, {1, 0}).is_b_right);
    const Scene two_sided = twoLayers(kMaterialTwoSided);
    EXPECT_FALSE(DifferenceExplainer(two_sided).explainClosest(up, kMiss, {1, 0}).is_a_right);
    EXPECT_TRUE(DifferenceExplainer(two_sided).explainClosest(up, kMiss, {1, 0}).is_b_right);
}

TEST(ExplainDifference, TurnsFacesOverWithAMirroredInstance) {
    SceneBuilder builder;
    const uint mesh = builder.addMesh(Positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                      Triangles{{0, 1, 2}}, builder.addMaterial(plainMaterial()));
    builder.addInstance(mesh, glm::scale(mat4(1), vec3(-1, 1, 1)));
    const Scene scene = builder.finish();
    EXPECT_EQ(DifferenceExplainer(scene).explainClosest(downAt(-0.25f, 0.25f), {0, 0}, {0, 0}).kind,
              DifferenceKind::kNone);
}

TEST(ExplainDifference, DoubtsTheBordersOfTheRange) {
    const Scene scene = twoLayers();
    const DifferenceExplainer explainer(scene);
    for (const Ray& ray : {downAt(0.25f, 0.25f, 1), downAt(0.25f, 0.25f, 1 + kStep)}) {
        const Difference difference = explainer.explainClosest(ray, {0, 0}, {1, 0});
        EXPECT_EQ(difference.kind, DifferenceKind::kSilhouette);
        EXPECT_EQ(difference.border, Border::kRange);
    }
    EXPECT_EQ(explainer.explainClosest(downAt(0.25f, 0.25f, 0, 1), {0, 0}, kMiss).kind,
              DifferenceKind::kSilhouette);
    EXPECT_EQ(explainer.explainOccluded(downAt(0.25f, 0.25f, 0, 1), 1, 0).border, Border::kRange);
    const Difference beyond =
        explainer.explainClosest(downAt(0.25f, 0.25f, 0, 0.999f), {0, 0}, kMiss);
    EXPECT_FALSE(beyond.is_a_right);
    EXPECT_TRUE(beyond.is_b_right);
}

// Alpha is 1.5 - 2 u between the centres of two texels, so the cutoff 0.5 lies at u = x = 0.5.
TEST(ExplainDifference, DoubtsTheBorderOfAMask) {
    SceneBuilder builder;
    Material material = plainMaterial(kMaterialMasked);
    const uint texels[] = {0xff'ff'ff'ffu, 0x00'ff'ff'ffu};
    material.base_color_texture = builder.addTexture(2, 1, texels);
    builder.add(Positions{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                Triangles{{0, 1, 2}, {0, 2, 3}}, builder.addMaterial(material),
                std::vector<vec2>{{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    const Scene scene = builder.finish();
    const DifferenceExplainer explainer(scene);
    for (const float x : {0.5f - kStep, 0.5f + kStep}) {
        const Difference difference = explainer.explainClosest(downAt(x, 0.1f), {0, 0}, kMiss);
        EXPECT_EQ(difference.kind, DifferenceKind::kSilhouette);
        EXPECT_EQ(difference.border, Border::kMask);
        EXPECT_EQ(explainer.explainOccluded(downAt(x, 0.1f), 0, 1).border, Border::kMask);
    }
    EXPECT_FALSE(explainer.explainClosest(downAt(0.499f, 0.1f), {0, 0}, kMiss).is_b_right);
    EXPECT_FALSE(explainer.explainClosest(downAt(0.501f, 0.1f), {0, 0}, kMiss).is_a_right);
}

TEST(ExplainDifference, JudgesOcclusionByAnythingInTheRange) {
    const Scene scene = twoLayers();
    const DifferenceExplainer explainer(scene);
    const Ray hits = downAt(0.25f, 0.25f);
    const Ray outline = downAt(0.5f, -kStep);
    EXPECT_EQ(explainer.explainOccluded(hits, 1, 1).kind, DifferenceKind::kNone);
    EXPECT_FALSE(explainer.explainOccluded(hits, 1, 0).is_b_right);
    EXPECT_EQ(explainer.explainOccluded(outline, 1, 0).kind, DifferenceKind::kSilhouette);
    EXPECT_FALSE(explainer.explainOccluded(downAt(2, 2), 1, 0).is_a_right);
    EXPECT_FALSE(explainer.explainOccluded(hits, 2, 1).is_a_right);
    EXPECT_FALSE(explainer.explainOccluded(downAt(0.25f, 0.25f, 0, 0.5f), 1, 0).is_a_right);
}

TEST(ExplainDifference, ExpectsNothingOfRaysThatHitNothing) {
    const Scene scene = twoLayers();
    const DifferenceExplainer explainer(scene);
    Ray nan = downAt(0.25f, 0.25f);
    nan.direction.x = std::numeric_limits<float>::quiet_NaN();
    const Ray still{{0.25f, 0.25f, 0}, 0, {0, 0, 0}, 1};
    const Ray backwards = downAt(0.25f, 0.25f, 5, 1);
    for (const Ray& ray : {nan, still, backwards}) {
        EXPECT_EQ(explainer.explainClosest(ray, kMiss, kMiss).kind, DifferenceKind::kNone);
        EXPECT_FALSE(explainer.explainClosest(ray, {0, 0}, kMiss).is_a_right);
        EXPECT_FALSE(explainer.explainOccluded(ray, 1, 0).is_a_right);
    }
}

TEST(ExplainDifference, NeverMeetsTrianglesWithoutArea) {
    SceneBuilder builder;
    builder.add(Positions{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, Triangles{{0, 1, 2}, {0, 0, 1}},
                builder.addMaterial(plainMaterial(kMaterialTwoSided)));
    const Scene scene = builder.finish();
    EXPECT_FALSE(
        DifferenceExplainer(scene).explainClosest(downAt(0.5f, 0), kMiss, {0, 0}).is_b_right);
}

// A float's step is 1/128 m there: half a step beside an edge is rounding, a metre is not.
TEST(ExplainDifference, DoubtsMoreFarFromTheOrigin) {
    SceneBuilder builder;
    const uint mesh = builder.addMesh(Positions{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}},
                                      Triangles{{0, 1, 2}}, builder.addMaterial(plainMaterial()));
    builder.addInstance(mesh, glm::translate(mat4(1), vec3(100'000, 0, 0)));
    const Scene scene = builder.finish();
    const DifferenceExplainer explainer(scene);
    EXPECT_EQ(explainer.explainClosest(downAt(100'000.0f - 1.0f / 128, 1), {0, 0}, kMiss).kind,
              DifferenceKind::kSilhouette);
    EXPECT_FALSE(explainer.explainClosest(downAt(100'000.0f - 1, 1), {0, 0}, kMiss).is_a_right);
}

TEST(ExplainDifference, FollowsInstancesThatMove) {
    Scene scene = twoLayers();
    const DifferenceExplainer explainer(scene);
    moveInstance(scene, 0, mat4x3(glm::translate(mat4(1), vec3(5, 0, 0))));
    EXPECT_FALSE(explainer.explainClosest(downAt(0.25f, 0.25f), {0, 0}, {1, 0}).is_a_right);
    EXPECT_TRUE(explainer.explainClosest(downAt(0.25f, 0.25f), {0, 0}, {1, 0}).is_b_right);
    EXPECT_TRUE(explainer.explainClosest(downAt(5.25f, 0.25f), {0, 0}, kMiss).is_a_right);
}

TEST(ExplainDifference, NamesHitsForATerminal) {
    Scene scene = twoLayers();
    scene.instance_names[1] = "a\x1b[31m";
    EXPECT_EQ(nameOf(scene, {0, 0}), "instance 0 \"instance 0\", primitive 0");
    EXPECT_EQ(nameOf(scene, {1, 0}), "instance 1 \"a?[31m\", primitive 0");
    EXPECT_EQ(nameOf(scene, {77, 3}), "instance 77, primitive 3");
    EXPECT_EQ(nameOf(scene, kMiss), "nothing");
}

TEST(ExplainDifference, SpellsRaysInFullPrecision) {
    const Ray ray{{0.1f, 1.0f / 3, -5}, 0, {1e-20f, 0, -1}, std::numeric_limits<float>::infinity()};
    EXPECT_EQ(toText(ray),
              "origin (0.1, 0.33333334, -5), direction (1e-20, 0, -1), tmin 0, tmax inf");
}

} // namespace
} // namespace hone

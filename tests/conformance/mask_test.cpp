// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/conformance/conformance.h"

#include <glm/gtc/matrix_transform.hpp>

namespace hone::test {
namespace {

/// Alpha 255 in the left texel, 0 in the right one.
constexpr uint kHalf[] = {0xff'ff'ff'ffu, 0x00'ff'ff'ffu};

/// The unit square, masked by kHalf across x, over a plain square at z = -1; both twice, so that
/// tracers may instance them.
SceneBuilder maskedSquare(Material material, uint wrap = 1, float uv_scale = 1) {
    SceneBuilder builder;
    material.base_color_texture = builder.addTexture(2, 1, kHalf, wrap);
    UnitSquare square;
    for (vec2& uv : square.uvs)
        uv *= uv_scale;
    const uint masked = square.addMeshTo(builder, builder.addMaterial(material));
    const uint plain = square.addMeshTo(builder, builder.addMaterial(plainMaterial()));
    builder.addInstance(masked);
    builder.addInstance(plain, glm::translate(mat4(1), vec3(0, 0, -1)));
    builder.addInstance(masked, glm::scale(glm::translate(mat4(1), vec3(10, 0, 0)), vec3(4, 2, 1)));
    builder.addInstance(plain, glm::translate(mat4(1), vec3(30, 0, 0)));
    return builder;
}

Ray downAt(float x, float y, float tmax = 1e30f) {
    return {{x, y, 2}, 0, {0, 0, -1}, tmax};
}

TEST_P(TracerConformance, SeesTheSolidPartOfAMask) {
    build(maskedSquare(plainMaterial(kMaterialMasked)));
    EXPECT_EQ(closest(downAt(0.2f, 0.1f)), (Hit{0, 0}));
    EXPECT_EQ(closest(downAt(0.1f, 0.8f)), (Hit{0, 1}));
}

TEST_P(TracerConformance, SeesThroughTheHoleOfAMask) {
    build(maskedSquare(plainMaterial(kMaterialMasked)));
    EXPECT_EQ(closest(downAt(0.8f, 0.1f)), (Hit{1, 0}));
    EXPECT_EQ(closest(downAt(0.8f, 0.9f)), (Hit{1, 1}));
}

// Bilinear between texel centres at u = 0.25 and 0.75: alpha(u) = 1.5 - 2 u, so 0.5 at u = 0.5.
TEST_P(TracerConformance, EndsAMaskWhereAlphaFallsBelowTheCutoff) {
    build(maskedSquare(plainMaterial(kMaterialMasked)));
    EXPECT_EQ(closest(downAt(0.499f, 0.1f)), (Hit{0, 0}));
    EXPECT_EQ(closest(downAt(0.501f, 0.1f)), (Hit{1, 0}));
    Material stricter = plainMaterial(kMaterialMasked);
    stricter.alpha_cutoff = 0.8f; // at u = 0.35
    build(maskedSquare(stricter));
    EXPECT_EQ(closest(downAt(0.349f, 0.1f)), (Hit{0, 0}));
    EXPECT_EQ(closest(downAt(0.351f, 0.1f)), (Hit{1, 0}));
}

TEST_P(TracerConformance, IsOccludedByTheSolidPartOfAMaskOnly) {
    build(maskedSquare(plainMaterial(kMaterialMasked)));
    EXPECT_TRUE(occluded(downAt(0.2f, 0.1f, 2.5f)));
    EXPECT_FALSE(occluded(downAt(0.8f, 0.1f, 2.5f)));
    EXPECT_TRUE(occluded(downAt(0.8f, 0.1f, 3.5f))) << "by the plain square below";
}

TEST_P(TracerConformance, MultipliesTheMaterialsAlpha) {
    Material material = plainMaterial(kMaterialMasked);
    material.alpha = 0.8f; // 0.8 (1.5 - 2 u) is 0.5 at u = 0.4375
    build(maskedSquare(material));
    EXPECT_EQ(closest(downAt(0.43f, 0.1f)), (Hit{0, 0}));
    EXPECT_EQ(closest(downAt(0.445f, 0.1f)), (Hit{1, 0}));
}

TEST_P(TracerConformance, MasksWithoutATextureByTheMaterialsAlpha) {
    for (const float alpha : {0.4f, 0.6f}) {
        Material material = plainMaterial(kMaterialMasked);
        material.alpha = alpha;
        SceneBuilder builder;
        UnitSquare().addTo(builder, builder.addMaterial(material));
        build(builder);
        EXPECT_EQ(closest(downAt(0.8f, 0.1f)), alpha < 0.5f ? kMiss : (Hit{0, 0}));
        EXPECT_EQ(occluded(downAt(0.8f, 0.1f)), alpha >= 0.5f);
    }
}

TEST_P(TracerConformance, IgnoresAlphaOfMaterialsThatAreNotMasked) {
    build(maskedSquare(plainMaterial()));
    EXPECT_EQ(closest(downAt(0.8f, 0.1f)), (Hit{0, 0}));
    EXPECT_TRUE(occluded(downAt(0.8f, 0.1f, 2.5f)));
}

TEST_P(TracerConformance, MasksATransformedInstanceInItsOwnTexture) {
    build(maskedSquare(plainMaterial(kMaterialMasked)));
    EXPECT_EQ(closest(downAt(11.9f, 0.2f)), (Hit{2, 0})); // u = 0.475
    EXPECT_EQ(closest(downAt(12.1f, 0.2f)), kMiss);       // u = 0.525
    EXPECT_TRUE(occluded(downAt(11.9f, 1.8f)));
    EXPECT_FALSE(occluded(downAt(12.1f, 1.8f)));
    // A slanted ray is masked where it meets the square, at x = 11.9.
    EXPECT_EQ(closest(rayTo({20, 1, 8}, {11.9f, 0.2f, 0})), (Hit{2, 0}));
    EXPECT_EQ(closest(rayTo({20, 1, 8}, {12.1f, 0.2f, 0})), kMiss);
}

// Three repeats across the square; u = 3 x. Bilinear across the border too: solid for the fraction
// of u below 0.5, to within an edge at 0 and 0.5.
TEST_P(TracerConformance, RepeatsAMask) {
    build(maskedSquare(plainMaterial(kMaterialMasked), 0, 3));
    EXPECT_EQ(closest(downAt(0.05f, 0.01f)), (Hit{0, 0})); // u = 0.15
    EXPECT_EQ(closest(downAt(0.25f, 0.01f)), (Hit{1, 0})); // u = 0.75
    EXPECT_EQ(closest(downAt(0.40f, 0.01f)), (Hit{0, 0})); // u = 1.2
    EXPECT_EQ(closest(downAt(0.60f, 0.01f)), (Hit{1, 0})); // u = 1.8
}

TEST_P(TracerConformance, SeesNeitherBackFacesNorHolesOfASingleSidedMask) {
    build(maskedSquare(plainMaterial(kMaterialMasked)));
    const auto up_at = [](float x) { return Ray{{x, 0.1f, -0.5f}, 0, {0, 0, 1}, 1e30f}; };
    EXPECT_EQ(closest(up_at(0.2f)), kMiss);
    EXPECT_TRUE(occluded(up_at(0.2f)));
    EXPECT_FALSE(occluded(up_at(0.8f)));
    build(maskedSquare(plainMaterial(kMaterialMasked | kMaterialTwoSided)));
    EXPECT_EQ(closest(up_at(0.2f)), (Hit{0, 0}));
    EXPECT_EQ(closest(up_at(0.8f)), kMiss);
}

} // namespace
} // namespace hone::test

// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/conformance/conformance.h"

#include <array>
#include <bit>
#include <limits>

namespace hone::test {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

/// Squares at z = 0 and z = -1. From (0.75, 0.25, 4) straight down they are at t = 4 and t = 5.
SceneBuilder twoSquares() {
    SceneBuilder builder;
    const uint material = builder.addMaterial(plainMaterial(kMaterialTwoSided));
    UnitSquare square;
    square.addTo(builder, material);
    for (vec3& position : square.positions)
        position.z = -1;
    square.addTo(builder, material);
    return builder;
}

Ray down(float tmin, float tmax) {
    return {{0.75f, 0.25f, 4}, tmin, {0, 0, -1}, tmax};
}

constexpr Hit kUpper{0, 0};
constexpr Hit kLower{1, 0};

TEST_P(TracerConformance, SeesNothingBeyondTmax) {
    build(twoSquares());
    EXPECT_EQ(closest(down(0, 3.999f)), kMiss);
    EXPECT_EQ(closest(down(0, 4.001f)), kUpper);
    EXPECT_FALSE(occluded(down(0, 3.999f)));
    EXPECT_TRUE(occluded(down(0, 4.001f)));
}

TEST_P(TracerConformance, SeesNothingBeforeTmin) {
    build(twoSquares());
    EXPECT_EQ(closest(down(3.999f, 1e30f)), kUpper);
    EXPECT_EQ(closest(down(4.001f, 1e30f)), kLower);
    EXPECT_EQ(closest(down(4.001f, 4.999f)), kMiss);
    EXPECT_EQ(closest(down(5.001f, 1e30f)), kMiss);
    EXPECT_TRUE(occluded(down(4.001f, 1e30f)));
    EXPECT_FALSE(occluded(down(4.001f, 4.999f)));
    EXPECT_FALSE(occluded(down(5.001f, 1e30f)));
}

TEST_P(TracerConformance, SeesARangeAroundOneHit) {
    build(twoSquares());
    EXPECT_EQ(closest(down(4.999f, 5.001f)), kLower);
    EXPECT_TRUE(occluded(down(4.999f, 5.001f)));
}

// Whether t == tmin and t == tmax count is left to rounding; what is further is not seen instead.
TEST_P(TracerConformance, MaySeeAHitOnTheBorderOfTheRange) {
    build(twoSquares());
    for (const Hit& hit : closestInAllModes(down(0, 4)))
        EXPECT_TRUE(hit == kUpper || hit == kMiss);
    for (const Hit& hit : closestInAllModes(down(4, 1e30f)))
        EXPECT_TRUE(hit == kUpper || hit == kLower);
}

TEST_P(TracerConformance, SeesToInfinity) {
    build(twoSquares());
    EXPECT_EQ(closest(down(0, kInf)), kUpper);
    EXPECT_TRUE(occluded(down(0, kInf)));
}

TEST_P(TracerConformance, SeesNothingBehindTheOrigin) {
    build(twoSquares());
    const Ray up{{0.75f, 0.25f, 4}, 0, {0, 0, 1}, 1e30f};
    EXPECT_EQ(closest(up), kMiss);
    EXPECT_FALSE(occluded(up));
}

TEST_P(TracerConformance, TakesANegativeTminForZero) {
    build(twoSquares());
    EXPECT_EQ(closest(down(-10, 1e30f)), kUpper);
    const Ray from_between{{0.75f, 0.25f, -0.5f}, -10, {0, 0, -1}, 1e30f};
    EXPECT_EQ(closest(from_between), kLower);
    const Ray up{{0.75f, 0.25f, 4}, -100, {0, 0, 1}, 1e30f};
    EXPECT_EQ(closest(up), kMiss);
    EXPECT_FALSE(occluded(up));
    EXPECT_EQ(closest(down(-10, -1)), kMiss);
    EXPECT_FALSE(occluded(down(-10, -1)));
    EXPECT_EQ(closest(down(-kInf, kInf)), kUpper);
}

TEST_P(TracerConformance, MeasuresTInLengthsOfTheDirection) {
    build(twoSquares());
    const vec3 origin(0.75f, 0.25f, 4);
    for (const float length : {1e-3f, 0.25f, 100.0f, 1e4f}) {
        const vec3 direction(0, 0, -length);
        EXPECT_EQ(closest({origin, 0, direction, 4.01f / length}), kUpper);
        EXPECT_EQ(closest({origin, 0, direction, 3.99f / length}), kMiss);
        EXPECT_EQ(closest({origin, 4.01f / length, direction, 1e30f}), kLower);
        EXPECT_FALSE(occluded({origin, 0, direction, 3.99f / length}));
    }
}

TEST_P(TracerConformance, HitsNothingWithoutADirection) {
    build(twoSquares());
    EXPECT_EQ(closest({{0.75f, 0.25f, 4}, 0, {0, 0, 0}, 1e30f}), kMiss);
    EXPECT_EQ(closest({{0.75f, 0.25f, 0}, 0, {0, 0, -0.0f}, 1e30f}), kMiss);
    EXPECT_FALSE(occluded({{0.75f, 0.25f, 0}, 0, {0, 0, 0}, 1e30f}));
}

TEST_P(TracerConformance, HitsNothingWhereTminExceedsTmax) {
    build(twoSquares());
    EXPECT_EQ(closest(down(10, 1)), kMiss);
    EXPECT_FALSE(occluded(down(10, 1)));
    EXPECT_EQ(closest(down(kInf, 1)), kMiss);
}

/// All rays that come of setting one number of a good ray to `value`.
std::vector<Ray> spoiled(float value, std::size_t first, std::size_t last) {
    std::vector<Ray> rays;
    for (std::size_t i = first; i <= last; ++i) {
        // origin, tmin, direction, tmax
        auto numbers = std::bit_cast<std::array<float, 8>>(down(0, 1e30f));
        numbers[i] = value;
        rays.push_back(std::bit_cast<Ray>(numbers));
    }
    return rays;
}

TEST_P(TracerConformance, HitsNothingWithANaN) {
    build(twoSquares());
    for (const Ray& ray : spoiled(kNaN, 0, 7)) {
        EXPECT_EQ(closest(ray), kMiss);
        EXPECT_FALSE(occluded(ray));
    }
}

TEST_P(TracerConformance, HitsNothingFromOrTowardsInfinity) {
    build(twoSquares());
    for (const float value : {kInf, -kInf, 1e20f, std::numeric_limits<float>::max()})
        for (const auto& rays : {spoiled(value, 0, 2), spoiled(value, 4, 6)})
            for (const Ray& ray : rays) {
                EXPECT_EQ(closest(ray), kMiss);
                EXPECT_FALSE(occluded(ray));
            }
}

TEST_P(TracerConformance, AnswersGoodRaysAmongBadOnes) {
    build(twoSquares());
    for (std::size_t count : {3u, 16u, 40u}) {
        std::vector<Ray> rays(count, down(0, 1e30f));
        for (std::size_t i = 0; i < count; i += 3)
            rays[i].direction = i % 2 == 0 ? vec3(0) : vec3(kNaN);
        for (const Mode& mode : kModes) {
            const std::vector<Hit> hits = closestOf(rays, mode);
            const std::vector<uint> occluded = occludedOf(rays, mode);
            for (std::size_t i = 0; i < count; ++i) {
                EXPECT_EQ(hits[i], i % 3 == 0 ? kMiss : kUpper) << i << " of " << count;
                EXPECT_EQ(occluded[i], i % 3 == 0 ? 0u : 1u) << i << " of " << count;
            }
        }
    }
}

} // namespace
} // namespace hone::test

// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/conformance/conformance.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <random>

namespace hone::test {
namespace {

/// side x side unit squares in the plane z = 0 in one mesh. The ray to (x, y) meets triangle
/// 2 (floor(y) side + floor(x)), plus 1 where the fraction of y exceeds that of x.
SceneBuilder grid(uint side) {
    std::vector<vec3> positions;
    std::vector<uvec3> triangles;
    for (uint y = 0; y <= side; ++y)
        for (uint x = 0; x <= side; ++x)
            positions.emplace_back(x, y, 0);
    for (uint y = 0; y < side; ++y)
        for (uint x = 0; x < side; ++x) {
            const uint corner = y * (side + 1) + x;
            triangles.emplace_back(corner, corner + 1, corner + side + 2);
            triangles.emplace_back(corner, corner + side + 2, corner + side + 1);
        }
    SceneBuilder builder;
    builder.add(positions, triangles, builder.addMaterial(plainMaterial()));
    return builder;
}

/// A ray to a square of the grid, away from all edges, and what it meets.
struct GridRay {
    Ray ray;
    Hit expected;
};

GridRay gridRay(std::mt19937& random, uint side) {
    const uint x = static_cast<uint>(random()) % side;
    const uint y = static_cast<uint>(random()) % side;
    const uint upper = static_cast<uint>(random()) % 2;
    // (0.5 .. 0.75, 0.2 .. 0.4) in the square, mirrored at the diagonal for the upper triangle.
    float u = 0.5f + 0.25f * static_cast<float>(random() % 1024) / 1024.0f;
    float v = 0.2f + 0.2f * static_cast<float>(random() % 1024) / 1024.0f;
    if (upper == 1)
        std::swap(u, v);
    const vec3 target(static_cast<float>(x) + u, static_cast<float>(y) + v, 0);
    const vec3 origin(static_cast<float>(random() % side), static_cast<float>(random() % side), 7);
    return {rayTo(origin, target), {0, 2 * (y * side + x) + upper}};
}

std::vector<GridRay> gridRays(std::size_t count, uint side) {
    std::mt19937 random(7);
    std::vector<GridRay> result(count);
    for (GridRay& ray : result)
        ray = gridRay(random, side);
    return result;
}

TEST_P(TracerConformance, AnswersListsOfEveryLength) {
    build(grid(4));
    const std::vector<GridRay> all = gridRays(100, 4);
    for (const std::size_t count : {0u, 1u, 2u, 15u, 16u, 17u, 31u, 33u, 100u}) {
        std::vector<Ray> rays;
        for (std::size_t i = 0; i < count; ++i)
            rays.push_back(all[i].ray);
        for (const Mode& mode : kModes) {
            const std::vector<Hit> hits = closestOf(rays, mode);
            for (std::size_t i = 0; i < count; ++i)
                EXPECT_EQ(hits[i], all[i].expected) << i << " of " << count;
            EXPECT_EQ(occludedOf(rays, mode), std::vector<uint>(count, 1u));
        }
    }
}

TEST_P(TracerConformance, AnswersAMillionRays) {
    const uint side = GetParam().is_brute ? 2 : 60;
    build(grid(side));
    const std::vector<GridRay> all = gridRays(rayCount(1'000'000) + 3, side);
    std::vector<Ray> rays;
    for (const GridRay& ray : all)
        rays.push_back(ray.ray);
    rays.back().tmax = 0.5f; // the last falls short
    for (const Mode& mode : {kModes[0], kModes[2]}) {
        const std::vector<Hit> hits = closestOf(rays, mode);
        const std::vector<uint> occluded = occludedOf(rays, mode);
        std::size_t wrong = 0;
        for (std::size_t i = 0; i + 1 < rays.size(); ++i)
            wrong += hits[i] == all[i].expected && occluded[i] == 1u ? 0 : 1;
        EXPECT_EQ(wrong, 0u);
        EXPECT_EQ(hits.back(), kMiss);
        EXPECT_EQ(occluded.back(), 0u);
    }
}

/// Triangles anywhere in a cube.
SceneBuilder soup(std::size_t count, uint seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(-1, 1);
    const auto vector = [&] {
        const float x = unit(random);
        const float y = unit(random);
        return vec3(x, y, unit(random));
    };
    std::vector<vec3> positions;
    std::vector<uvec3> triangles;
    for (std::size_t i = 0; i < count; ++i) {
        const vec3 center = vector();
        const auto first = static_cast<uint>(positions.size());
        for (int corner = 0; corner < 3; ++corner)
            positions.push_back(center + 0.3f * vector());
        triangles.emplace_back(first, first + 1, first + 2);
    }
    SceneBuilder builder;
    builder.add(positions, triangles, builder.addMaterial(plainMaterial()));
    return builder;
}

/// A pinhole image of the cube, row by row.
std::vector<Ray> cameraRays(uint width, uint height) {
    std::vector<Ray> rays;
    for (uint y = 0; y < height; ++y)
        for (uint x = 0; x < width; ++x)
            rays.push_back({{0.3f, 0.2f, 3},
                            0,
                            {static_cast<float>(x) / static_cast<float>(width) - 0.5f,
                             static_cast<float>(y) / static_cast<float>(height) - 0.5f, -1},
                            1e30f});
    return rays;
}

TEST_P(TracerConformance, AnswersEachRayAlikeInAnyOrderAndCompany) {
    build(soup(GetParam().is_brute ? 200 : 5000, 3));
    const std::vector<Ray> rays = GetParam().is_slow ? cameraRays(50, 38) : cameraRays(200, 150);
    std::vector<uint> order(rays.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::shuffle(order, std::mt19937(5));
    order.resize(rays.size() / 3); // a third of the rays, in another order
    std::vector<Ray> shuffled;
    for (const uint i : order)
        shuffled.push_back(rays[i]);

    const std::vector<Hit> hits = closestOf(rays, kModes[0]);
    const std::vector<uint> occluded = occludedOf(rays, kModes[0]);
    EXPECT_GT(static_cast<std::size_t>(std::ranges::count(occluded, 1u)), rays.size() / 30);
    for (const Mode& mode : kModes) {
        EXPECT_EQ(closestOf(rays, mode), hits);
        EXPECT_EQ(occludedOf(rays, mode), occluded);
        const std::vector<Hit> shuffled_hits = closestOf(shuffled, mode);
        const std::vector<uint> shuffled_occluded = occludedOf(shuffled, mode);
        for (std::size_t i = 0; i < order.size(); ++i) {
            EXPECT_EQ(shuffled_hits[i], hits[order[i]]);
            EXPECT_EQ(shuffled_occluded[i], occluded[order[i]]);
        }
    }
}

// Rays at edges, which several triangles share, and at coplanar twins: where company shows first.
TEST_P(TracerConformance, AnswersExactlyWhateverTheCompany) {
    const uint side = GetParam().is_brute ? 3 : 30;
    SceneBuilder builder = grid(side);
    builder.addInstance(0); // the same triangles again, in the same place
    build(builder);
    std::mt19937 random(9);
    std::uniform_real_distribution<float> along(0, static_cast<float>(side));
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < rayCount(20'000); ++i) {
        const float x = along(random);
        const vec3 origin(along(random), along(random), 3);
        rays.push_back(rayTo(origin, {x, i % 2 == 0 ? x : std::floor(x), 0}));
    }
    for (const Coherence coherence : {Coherence::kCoherent, Coherence::kIncoherent}) {
        const Mode exact{coherence, {.exact = true}};
        const std::vector<Hit> together = closestOf(rays, exact);
        const std::vector<uint> occluded_together = occludedOf(rays, exact);
        for (std::size_t i = 0; i < rays.size(); i += 7) {
            EXPECT_EQ(closestOf({&rays[i], 1}, exact).front(), together[i]);
            EXPECT_EQ(occludedOf({&rays[i], 1}, exact).front(), occluded_together[i]);
        }
    }
}

TEST_P(TracerConformance, ForgetsTheOldSceneWhenBuiltAgain) {
    SceneBuilder one;
    UnitSquare().addTo(one, one.addMaterial(plainMaterial()));
    SceneBuilder other;
    const uint material = other.addMaterial(plainMaterial());
    other.add(std::vector<vec3>{{5, 0, 0}, {6, 0, 0}, {5, 1, 0}}, std::vector<uvec3>{{0, 1, 2}},
              material);
    const Ray at_one{{0.75f, 0.25f, 1}, 0, {0, 0, -1}, 1e30f};
    const Ray at_other{{5.25f, 0.25f, 1}, 0, {0, 0, -1}, 1e30f};
    for (int round = 0; round < 2; ++round) {
        build(one);
        EXPECT_EQ(closest(at_one), (Hit{0, 0}));
        EXPECT_EQ(closest(at_other), kMiss);
        build(other);
        EXPECT_EQ(closest(at_one), kMiss);
        EXPECT_EQ(closest(at_other), (Hit{0, 0}));
    }
    build(SceneBuilder());
    EXPECT_EQ(closest(at_other), kMiss);
}

TEST_P(TracerConformance, LooksUpEachInstancesOwnMaterial) {
    // 300 squares side by side, each with a material of its own: single-sided, two-sided, a hole,
    // and so on.
    SceneBuilder builder;
    UnitSquare square;
    for (uint i = 0; i < 300; ++i) {
        Material material = plainMaterial(
            std::array{0u, kMaterialTwoSided, kMaterialTwoSided | kMaterialMasked}[i % 3]);
        material.alpha = 0.1f;
        square.addTo(builder, builder.addMaterial(material));
        for (vec3& position : square.positions)
            position.x += 1;
    }
    build(builder);
    for (uint i = 0; i < 300; i += 7) {
        const float x = static_cast<float>(i) + 0.75f;
        const Ray down{{x, 0.25f, 1}, 0, {0, 0, -1}, 1e30f};
        const Ray up{{x, 0.25f, -1}, 0, {0, 0, 1}, 1e30f};
        EXPECT_EQ(closest(down), i % 3 == 2 ? kMiss : (Hit{i, 0}));
        EXPECT_EQ(closest(up), i % 3 == 1 ? (Hit{i, 0}) : kMiss);
        EXPECT_EQ(occluded(up), i % 3 != 2);
    }
}

TEST_P(TracerConformance, SaysWhatItBuilt) {
    build(grid(8));
    const BuildStats stats = tracer_->build(scene_);
    EXPECT_EQ(stats.triangles, 128u);
    EXPECT_GE(stats.ms, 0.0);
    EXPECT_FALSE(tracer_->caps().name.empty());
    EXPECT_FALSE(tracer_->caps().version.empty());
}

} // namespace
} // namespace hone::test

// SPDX-License-Identifier: Apache-2.0
//
// Instances that move: answers are as if the tracer had been built where they stand now.
#include "hone/tests/conformance/conformance.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <array>
#include <random>

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

/// Three squares of one mesh at x = 0, 10 and 20, and one of another mesh at x = 30.
SceneBuilder fourSquares(uint flags = 0) {
    SceneBuilder builder;
    const uint material = builder.addMaterial(plainMaterial(flags));
    const uint mesh = UnitSquare().addMeshTo(builder, material);
    for (const float x : {0.0f, 10.0f, 20.0f})
        builder.addInstance(mesh, glm::translate(mat4(1), vec3(x, 0, 0)));
    builder.addInstance(UnitSquare().addMeshTo(builder, material),
                        glm::translate(mat4(1), vec3(30, 0, 0)));
    return builder;
}

TEST_P(TracerConformance, FollowsARotatedAndScaledInstance) {
    build(fourSquares());
    // A quarter turn about z takes (x, y) to (-y, x); then four times as large.
    const mat4 place = glm::scale(glm::rotate(mat4(1), 1.57079633f, vec3(0, 0, 1)), vec3(4));
    move(2, mat4x3(place));
    EXPECT_EQ(closest(downAt(-1, 3)), (Hit{2, 0})); // (0.75, 0.25) in the mesh
    EXPECT_EQ(closest(downAt(-3, 1)), (Hit{2, 1})); // (0.25, 0.75)
    EXPECT_EQ(closest(downAt(20.75f, 0.25f)), kMiss);
}

TEST_P(TracerConformance, FollowsTheSameInstanceTimeAndAgain) {
    build(fourSquares());
    for (int step = 1; step <= 20; ++step) {
        const auto y = static_cast<float>(3 * step);
        move(1, mat4x3(glm::translate(mat4(1), vec3(10, y, 0))));
        EXPECT_EQ(closest(downAt(10.75f, y + 0.25f)), (Hit{1, 0}));
        EXPECT_EQ(closest(downAt(10.75f, y - 2.75f)), kMiss);
    }
    tracer_->update({}); // nothing moved
    EXPECT_EQ(closest(downAt(10.75f, 60.25f)), (Hit{1, 0}));
}

TEST_P(TracerConformance, ForgetsWhatMovedWhenBuiltAgain) {
    build(fourSquares());
    move(1, mat4x3(glm::translate(mat4(1), vec3(10, 50, 0))));
    build(fourSquares());
    EXPECT_EQ(closest(downAt(10.75f, 0.25f)), (Hit{1, 0}));
    EXPECT_EQ(closest(downAt(10.75f, 50.25f)), kMiss);
    move(1, mat4x3(glm::translate(mat4(1), vec3(10, 50, 0))));
    EXPECT_EQ(closest(downAt(10.75f, 50.25f)), (Hit{1, 0}));
}

// Many instances anywhere, half of them moved at once: as if built anew.
TEST_P(TracerConformance, AnswersAfterAnUpdateAsAfterABuild) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> unit(-1, 1);
    const auto anywhere = [&] {
        mat4 place(1);
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 3; ++row)
                place[column][row] += (column < 3 ? 0.5f : 4.0f) * unit(random);
        return place;
    };
    SceneBuilder builder;
    const uint single = builder.addMaterial(plainMaterial());
    const uint both = builder.addMaterial(plainMaterial(kMaterialTwoSided));
    const uint meshes[] = {UnitSquare().addMeshTo(builder, single),
                           UnitSquare().addMeshTo(builder, both)};
    for (uint i = 0; i < 40; ++i)
        builder.addInstance(meshes[i % 2], anywhere());
    build(builder);
    std::vector<uint> moved;
    for (uint i = 0; i < 40; i += i % 3 == 0 ? 1 : 2) {
        moveInstance(scene_, i, mat4x3(anywhere()));
        moved.push_back(i);
    }
    tracer_->update(moved);

    std::vector<Ray> rays(rayCount(16'000));
    for (Ray& ray : rays) {
        const vec3 from(8 * unit(random), 8 * unit(random), 8 * unit(random));
        ray = rayTo(from, vec3(4 * unit(random), 4 * unit(random), 4 * unit(random)));
    }
    const std::unique_ptr<TraceBackend> fresh = GetParam().make();
    fresh->build(scene_);
    std::vector<Hit> expected(rays.size());
    fresh->closest(rays, expected, Coherence::kIncoherent, {.exact = true});
    const std::vector<Hit> hits = closestOf(rays, kModes[3]);
    std::size_t differing = 0, seen = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        differing += hits[i] == expected[i] ? 0 : 1;
        seen += expected[i] == kMiss ? 0 : 1;
    }
    EXPECT_GT(seen, rays.size() / 50);
    // A structure that was refitted may round otherwise where a ray meets an edge.
    EXPECT_LE(differing, rays.size() / 2000);
}

TEST_P(TracerConformance, AnswersListsInsideAndOutsideOfADevicesBuffers) {
    Device* device = GetParam().memory ? GetParam().memory() : nullptr;
    if (device == nullptr)
        GTEST_SKIP() << "no device was named whose buffers lists could lie in";
    build(fourSquares());
    const std::vector<Ray> rays{downAt(0.75f, 0.25f), downAt(5, 5), downAt(10.25f, 0.75f)};
    const std::vector<Hit> expected{{0, 0}, kMiss, {1, 1}};
    const std::vector<uint> expected_occluded{1, 0, 1};
    // Not at the buffer's begin, and in one buffer.
    const Buffer buffer = device->createBuffer(4096, "lists of a test");
    const std::span<Ray> device_rays = buffer.view().part(5 * sizeof(Ray), 96).as<Ray>();
    const std::span<Hit> device_hits = buffer.view().part(1024, 24).as<Hit>();
    const std::span<uint> device_occluded = buffer.view().part(2052, 12).as<uint>();
    std::ranges::copy(rays, device_rays.begin());
    for (const Mode& mode : kModes) {
        std::vector<Hit> hits(3, Hit{7, 7});
        std::vector<uint> occluded(3, 7u);
        std::ranges::fill(device_hits, Hit{7, 7});
        std::ranges::fill(device_occluded, 7u);
        tracer_->closest(device_rays, device_hits, mode.coherence, mode.options);
        tracer_->occluded(device_rays, device_occluded, mode.coherence, mode.options);
        EXPECT_TRUE(std::ranges::equal(device_hits, expected));
        EXPECT_TRUE(std::ranges::equal(device_occluded, expected_occluded));
        tracer_->closest(device_rays, hits, mode.coherence, mode.options); // mixed
        EXPECT_EQ(hits, expected);
        tracer_->occluded(rays, device_occluded, mode.coherence, mode.options);
        EXPECT_TRUE(std::ranges::equal(device_occluded, expected_occluded));
    }
    EXPECT_EQ(buffer.as<uint>()[(1024 + 24) / 4], 0u) << "written past the list";
}

TEST_P(TracerConformance, TakesEmptyListsInEveryState) {
    build(fourSquares());
    for (const Mode& mode : kModes) {
        tracer_->closest({}, {}, mode.coherence, mode.options);
        tracer_->occluded({}, {}, mode.coherence, mode.options);
    }
    build(SceneBuilder());
    tracer_->update({});
    tracer_->closest({}, {}, Coherence::kCoherent, {});
    build(fourSquares());
    EXPECT_EQ(closest(downAt(0.75f, 0.25f)), (Hit{0, 0}));
}

} // namespace
} // namespace hone::test

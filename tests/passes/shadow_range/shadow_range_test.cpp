// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/passes.h"
#include "hone/tests/support/run_pass.h"
#include "hone/tests/support/shadow_scenes.h"

#include "hone/core/device/kernel.glsl.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace hone {
namespace {

constexpr uint kSize = 36; // cells along an edge: 18, 9, 5, 3, 2, 1
constexpr uint kCells = kSize / 2;

struct Ranges : HostKernel {
    using HostKernel::HostKernel;
#include "hone/core/scene/texture.glsl.h"

#include "hone/core/scene/surface.glsl.h"

#include "hone/passes/shading/shading.glsl.h"

#include "hone/passes/shading/shadow_range.glsl.h"
};

/// A map of a light, by hand: depth(face, column, row).
template <class Depth> std::vector<float> mapOf(const Light& light, Depth depth) {
    std::vector<float> map{kSize, 1, 0, 0, 0, 1, 0, 0};
    for (uint face = 0; face < 6; ++face)
        for (uint row = 0; row < kSize; ++row)
            for (uint column = 0; column < kSize; ++column)
                map.push_back(
                    light.kind == kLightDirectional && face > 0 ? 1e30f : depth(face, column, row));
    return map;
}

float hills(uint face, uint column, uint row) {
    return 1.0f + static_cast<float>((column * 7919 + row * 104729 + face * 31) % 1009) / 100.0f;
}

class ShadowRange : public testing::Test {
protected:
    ShadowRange() {
        test::SceneBuilder builder;
        test::addSquare(builder, vec3(0), vec3(1, 0, 0), vec3(0, 0, -1));
        scene_ = builder.finish();
        scene_.lights = {test::lampOf(kLightPoint)};
    }

    /// What areas of face 3 are asked of, one light alone.
    Ranges& rangesOf(const char* query, const std::vector<float>& map) {
        run_ = std::make_unique<PassRun>(shadowRangePass());
        run_->scene(scene_).param("size", kSize).param("query", query).param("levels", 2u);
        run_->list("shadow_maps", map).execute();
        arguments_.bind("shadow_ranges", run_->value("ranges").buffer);
        for (const char* name : {"scene_texels", "scene_srgb", "scene_textures", "scene_positions",
                                 "scene_normals", "scene_uvs", "scene_triangles", "scene_meshes",
                                 "scene_instances", "scene_materials", "scene_environment"})
            arguments_.bind(name, {});
        arguments_.bind("scene_lights",
                        {.handle = 0,
                         .offset = 0,
                         .bytes = scene_.lights.size() * sizeof(Light),
                         .data = reinterpret_cast<std::byte*>(scene_.lights.data())});
        ranges_ = std::make_unique<Ranges>(arguments_, nullptr);
        return *ranges_;
    }

    Scene scene_;
    std::unique_ptr<PassRun> run_;
    Arguments arguments_;
    std::unique_ptr<Ranges> ranges_;
};

/// Over all texels of the cells from low to high of face 3.
vec2 expectedRange(uvec2 low, uvec2 high) {
    vec2 range(1e30f, 0.0f);
    for (uint row = 2 * low.y; row < 2 * high.y + 2; ++row)
        for (uint column = 2 * low.x; column < 2 * high.x + 2; ++column) {
            range.x = std::min(range.x, hills(3, column, row));
            range.y = std::max(range.y, hills(3, column, row));
        }
    return range;
}

TEST_F(ShadowRange, AnswersAnyAreaExactlyWithNbuffers) {
    Ranges& ranges = rangesOf("nbuffer", mapOf(scene_.lights[0], hills));
    const uint first = ranges.rangeLevelsFirst(3);
    for (uvec2 low : {uvec2(0, 0), uvec2(3, 5), uvec2(11, 2), uvec2(17, 17)})
        for (uint width = 1; low.x + width <= kCells; ++width)
            for (uint height = 1; low.y + height <= kCells; ++height) {
                const uvec2 high = low + uvec2(width - 1, height - 1);
                const auto found = ranges.areaRange(first, low, high, 1);
                EXPECT_EQ(vec2(found.nearest, found.farthest), expectedRange(low, high));
            }
}

TEST_F(ShadowRange, AnswersMoreThanTheAreaWithThePyramid) {
    Ranges& ranges = rangesOf("hsm", mapOf(scene_.lights[0], hills));
    const uint first = ranges.rangeLevelsFirst(3);
    for (uint most_blocks : {1u, 4u})
        for (uvec2 low : {uvec2(0, 0), uvec2(3, 5), uvec2(17, 17)})
            for (uvec2 high : {low, min(low + uvec2(2, 4), uvec2(17)), uvec2(17)}) {
                // Blocks along an edge are at most most_blocks + 1.
                uint level = 0;
                while ((high.x >> level) - (low.x >> level) > most_blocks ||
                       (high.y >> level) - (low.y >> level) > most_blocks)
                    ++level;
                const uvec2 from = (low >> level) << level;
                const uvec2 to = min(((high >> level) << level) + ((1u << level) - 1), uvec2(17));
                const auto found = ranges.areaRange(first, low, high, most_blocks);
                EXPECT_EQ(vec2(found.nearest, found.farthest), expectedRange(from, to));
            }
}

TEST_F(ShadowRange, KnowsWhatAFaceHoldsAndHowFarTheLightReaches) {
    scene_.lights = {test::lampOf(kLightPoint), test::lampOf()};
    scene_.lights[0].shadowless = 1; // has no faces
    for (const char* query : {"hsm", "nbuffer"}) {
        Ranges& ranges = rangesOf(query, mapOf(scene_.lights[1], hills));
        EXPECT_EQ(ranges.rangeFirstFace(1), 0u);
        EXPECT_EQ(ranges.rangeOfFace(3).x, expectedRange({0, 0}, {17, 17}).x);
        EXPECT_EQ(ranges.rangeOfFace(3).y, 0.0f) << "down, the lamp is flat";
        EXPECT_EQ(ranges.rangeOfFace(0).y, 1.0f) << "to the side, half its edge";
        EXPECT_EQ(ranges.rangeOfFace(2).x, 1e30f) << "the lamp does not shine up";
    }
}

TEST_F(ShadowRange, TellsWhereDepthsBreakOff) {
    // A plane leaning by one in ten, in nearness linear, that steps back from column 20 on.
    const auto stepped = [](uint, uint column, uint) {
        const float nearness = 0.2f + 0.001f * static_cast<float>(column);
        return 1 / (column < 20 ? nearness : 0.8f * nearness);
    };
    Ranges& ranges = rangesOf("nbuffer", mapOf(scene_.lights[0], stepped));
    const uint first = ranges.rangeLevelsFirst(3);
    EXPECT_FALSE(ranges.areaRange(first, {0, 0}, {8, 17}, 1).is_broken);
    EXPECT_TRUE(ranges.areaRange(first, {0, 0}, {9, 17}, 1).is_broken) << "towards column 20";
    EXPECT_FALSE(ranges.areaRange(first, {10, 0}, {17, 17}, 1).is_broken);
    // A crease goes on: flat to one side, steep to the other.
    const auto creased = [](uint, uint column, uint row) {
        return 1 / (0.2f + 0.004f * static_cast<float>(std::max(column, 15u) + row));
    };
    Ranges& bent = rangesOf("nbuffer", mapOf(scene_.lights[0], creased));
    EXPECT_FALSE(bent.areaRange(first, {0, 0}, {17, 17}, 1).is_broken);
    // Something one texel wide does not.
    const auto wire = [](uint, uint column, uint) { return column == 11 ? 2.0f : 5.0f; };
    Ranges& wired = rangesOf("nbuffer", mapOf(scene_.lights[0], wire));
    EXPECT_TRUE(wired.areaRange(first, {5, 3}, {5, 3}, 1).is_broken);
    EXPECT_FALSE(wired.areaRange(first, {6, 0}, {17, 17}, 1).is_broken);
}

TEST_F(ShadowRange, AsksForTheMapsSize) {
    PassRun run(shadowRangePass());
    run.scene(scene_).param("size", 64u);
    run.list("shadow_maps", mapOf(scene_.lights[0], hills));
    try {
        run.execute();
        FAIL();
    } catch (const GraphError& error) {
        EXPECT_STREQ(error.what(),
                     "shadow_range: the shadow maps have faces of 36 texels, but room was made for "
                     "64; set this pass's parameter \"size\" to that of shadow_map");
    }
}

} // namespace
} // namespace hone

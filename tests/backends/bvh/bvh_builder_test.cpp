// SPDX-License-Identifier: Apache-2.0
//
// What every BvhBuilder promises (core/trace/bvh.h).
#include "hone/backends/bvh/binned_builder.h"
#include "hone/backends/embree/embree_bvh.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

namespace hone {
namespace {

/// Triangles with their boxes.
struct Triangles {
    std::vector<std::array<vec3, 3>> corners;
    std::vector<Bounds> boxes;

    void add(vec3 a, vec3 b, vec3 c) {
        corners.push_back({a, b, c});
        Bounds& box = boxes.emplace_back();
        for (const vec3& corner : corners.back())
            box.add(corner);
    }
    [[nodiscard]] BvhInput input(uint leaf_size = 4) const {
        return {.boxes = boxes, .triangles = corners, .leaf_size = leaf_size};
    }
};

/// Triangles anywhere in a cube; `size` of the slivers among them, which are worth cutting.
Triangles soup(std::size_t count, float size) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> unit(-1, 1);
    const auto vector = [&] {
        const float x = unit(random);
        const float y = unit(random);
        return vec3(x, y, unit(random));
    };
    Triangles result;
    for (std::size_t i = 0; i < count; ++i) {
        const vec3 at = vector();
        const vec3 along = i % 5 == 0 ? size * vector() : 0.02f * vector();
        result.add(at, at + along, at + 0.02f * vector());
    }
    return result;
}

uint depthOf(const Bvh& bvh) {
    std::vector<uint> depth(bvh.nodes.size(), 1);
    uint deepest = 0;
    for (uint i = 0; i < bvh.nodes.size(); ++i) {
        deepest = std::max(deepest, depth[i]);
        if (bvh.nodes[i].count == 0)
            depth[i + 1] = depth[bvh.nodes[i].link] = depth[i] + 1;
    }
    return deepest;
}

bool holds(const Bounds& outer, const Bounds& inner) {
    return glm::all(glm::lessThanEqual(outer.low, inner.low)) &&
           glm::all(glm::greaterThanEqual(outer.high, inner.high));
}

/// A tree that halves the boxes at the median centre of the longest axis, in the same measure.
double halvingCost(const std::vector<Bounds>& boxes, std::vector<uint> order, uint leaf_size) {
    Bounds whole, centers;
    for (const uint i : order) {
        whole.add(boxes[i].low);
        whole.add(boxes[i].high);
        centers.add(boxes[i].center());
    }
    if (order.size() <= leaf_size)
        return halfArea(whole) * (1.0 + static_cast<double>(order.size()));
    const vec3 size = centers.high - centers.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    std::ranges::sort(order, {}, [&](uint i) { return boxes[i].center()[axis]; });
    const auto middle = order.begin() + static_cast<std::ptrdiff_t>(order.size() / 2);
    return halfArea(whole) + halvingCost(boxes, {order.begin(), middle}, leaf_size) +
           halvingCost(boxes, {middle, order.end()}, leaf_size);
}

struct Tested {
    const char* name;
    BvhBuilder build;
    bool cuts; ///< boxes of triangles
};

class BvhBuilderTest : public testing::TestWithParam<Tested> {
protected:
    static Bvh build(const BvhInput& input) { return GetParam().build(input); }

    /// What holds for every tree, whatever the boxes.
    static void check(const Bvh& bvh, const BvhInput& input) {
        std::set<uint> named;
        ASSERT_LE(depthOf(bvh), kBvhDepth);
        std::size_t children = 0;
        for (uint i = 0; i < bvh.nodes.size(); ++i) {
            const Bvh::Node& node = bvh.nodes[i];
            if (node.count == 0) {
                ASSERT_LT(node.axis, 3u);
                ASSERT_GT(node.link, i + 1);
                ASSERT_LT(node.link, bvh.nodes.size());
                EXPECT_TRUE(holds(node.bounds, bvh.nodes[i + 1].bounds)) << "node " << i;
                EXPECT_TRUE(holds(node.bounds, bvh.nodes[node.link].bounds)) << "node " << i;
                children += 2;
                continue;
            }
            EXPECT_LE(node.count, input.leaf_size);
            for (uint k = 0; k < node.count; ++k)
                named.insert(bvh.order[node.link + k]);
        }
        EXPECT_EQ(children + (bvh.nodes.empty() ? 0 : 1), bvh.nodes.size());
        EXPECT_EQ(named.size(), input.boxes.size());
        EXPECT_TRUE(named.empty() || *named.rbegin() == input.boxes.size() - 1);
    }
};

TEST_P(BvhBuilderTest, PutsEveryPrimitiveIntoALeaf) {
    const Triangles triangles = soup(3000, 0.8f);
    check(build(triangles.input()), triangles.input());
}

TEST_P(BvhBuilderTest, PutsEveryPointOfATriangleIntoABoxOfItsLeaves) {
    const Triangles triangles = soup(1000, 1.5f);
    const Bvh bvh = build(triangles.input());
    std::vector<std::vector<Bounds>> boxes(triangles.boxes.size());
    for (const Bvh::Node& node : bvh.nodes)
        for (uint k = 0; k < node.count; ++k)
            boxes[bvh.order[node.link + k]].push_back(node.bounds);
    if (GetParam().cuts) {
        EXPECT_GT(bvh.order.size(), triangles.boxes.size() + 50);
    }
    for (std::size_t i = 0; i < boxes.size(); ++i)
        for (uint step = 0; step <= 200; ++step) {
            // Along the triangle's long edge, and halfway to the third corner.
            const auto& [a, b, c] = triangles.corners[i];
            const double s = step / 200.0;
            const glm::dvec3 on_edge = glm::mix(glm::dvec3(a), glm::dvec3(b), s);
            for (const glm::dvec3& point : {on_edge, 0.5 * (on_edge + glm::dvec3(c))})
                EXPECT_TRUE(std::ranges::any_of(
                    boxes[i],
                    [&](const Bounds& box) {
                        return glm::all(glm::greaterThanEqual(point, glm::dvec3(box.low))) &&
                               glm::all(glm::lessThanEqual(point, glm::dvec3(box.high)));
                    }))
                    << "triangle " << i << " at " << s;
        }
}

TEST_P(BvhBuilderTest, CostsLessThanHalving) {
    const Triangles triangles = soup(3000, 0.8f);
    std::vector<uint> all(triangles.boxes.size());
    std::iota(all.begin(), all.end(), 0u);
    const Bvh bvh = build(triangles.input());
    EXPECT_LT(sahCost(bvh), halvingCost(triangles.boxes, all, 4) / halfArea(bvh.nodes[0].bounds));
}

TEST_P(BvhBuilderTest, MakesTheSameTreeAtAnyNumberOfThreads) {
    const Triangles triangles = soup(60'000, 0.3f); // enough for builders to share out
    const Bvh expected = build(triangles.input());
    for (const std::size_t threads : {1u, 2u, 8u, 1u, 8u}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        const Bvh bvh = build(triangles.input());
        ASSERT_EQ(bvh.order, expected.order) << threads << " threads";
        ASSERT_EQ(bvh.nodes.size(), expected.nodes.size());
        for (std::size_t i = 0; i < bvh.nodes.size(); ++i) {
            ASSERT_EQ(bvh.nodes[i].bounds.low, expected.nodes[i].bounds.low);
            ASSERT_EQ(bvh.nodes[i].bounds.high, expected.nodes[i].bounds.high);
            ASSERT_EQ(bvh.nodes[i].link, expected.nodes[i].link);
            ASSERT_EQ(bvh.nodes[i].count, expected.nodes[i].count);
            ASSERT_EQ(bvh.nodes[i].axis, expected.nodes[i].axis);
        }
    }
}

TEST_P(BvhBuilderTest, PutsTheLowerChildOnTheLeft) {
    Triangles triangles;
    for (const float x : {9.0f, 0.0f, 6.0f, 3.0f})
        triangles.add({x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0});
    const Bvh bvh = build(triangles.input(1));
    for (uint i = 0; i < bvh.nodes.size(); ++i)
        if (bvh.nodes[i].count == 0) {
            EXPECT_EQ(bvh.nodes[i].axis, 0u);
            EXPECT_LT(bvh.nodes[i + 1].bounds.high.x, bvh.nodes[bvh.nodes[i].link].bounds.low.x);
        }
    EXPECT_EQ(bvh.nodes.size(), 7u);
}

TEST_P(BvhBuilderTest, TakesNothingAndOneTriangle) {
    EXPECT_TRUE(build({}).nodes.empty());
    EXPECT_TRUE(build({}).order.empty());
    Triangles one;
    one.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const Bvh bvh = build(one.input());
    ASSERT_EQ(bvh.nodes.size(), 1u);
    EXPECT_EQ(bvh.nodes[0].count, 1u);
    EXPECT_EQ(bvh.order, std::vector<uint>{0});
}

TEST_P(BvhBuilderTest, TakesBoxesWithoutTriangles) {
    const Triangles triangles = soup(500, 0.8f);
    const BvhInput input{.boxes = triangles.boxes, .triangles = {}, .leaf_size = 1};
    const Bvh bvh = build(input);
    check(bvh, input);
    EXPECT_EQ(bvh.order.size(), 500u);
}

TEST_P(BvhBuilderTest, TakesAThousandTrianglesInOnePlace) {
    Triangles triangles;
    for (int i = 0; i < 1000; ++i)
        triangles.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    check(build(triangles.input()), triangles.input());
}

TEST_P(BvhBuilderTest, TakesPoints) {
    Triangles triangles;
    for (int i = 0; i < 100; ++i) {
        const vec3 at(static_cast<float>(i % 7));
        triangles.add(at, at, at);
    }
    check(build(triangles.input()), triangles.input());
}

TEST_P(BvhBuilderTest, TakesSizesOfAllMagnitudes) {
    Triangles triangles; // each a thousand times nearer to the origin than the last: 36 decades
    for (int i = 0; i < 400; ++i) {
        const float size = std::pow(10.0f, 17.0f - 0.09f * static_cast<float>(i));
        triangles.add({size, 0, 0}, {2 * size, 0, size}, {size, size, 0});
    }
    check(build(triangles.input(1)), triangles.input(1));
}

INSTANTIATE_TEST_SUITE_P(All, BvhBuilderTest,
                         testing::Values(Tested{"binned", buildBinnedBvh, false},
                                         Tested{"embree", buildEmbreeBvh, true}),
                         [](const testing::TestParamInfo<Tested>& tested) {
                             return tested.param.name;
                         });

} // namespace
} // namespace hone

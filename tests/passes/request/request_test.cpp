// SPDX-License-Identifier: Apache-2.0
#include "hone/core/image/tile_order.h"
#include "hone/passes/passes.h"
#include "hone/tests/support/run_pass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace hone {
namespace {

/// All lists until the first empty one.
std::vector<std::vector<uvec3>> allLists(PassRun& run) {
    std::vector<std::vector<uvec3>> lists;
    while (true) {
        std::vector<uvec3> list = run.execute().output<uvec3>("requests");
        if (list.empty())
            return lists;
        lists.push_back(std::move(list));
    }
}

TEST(Request, TakesBatchesOfTheOrderInTileOrder) {
    PassRun run(requestPass());
    run.extent({4, 2}).param("batch", 3u);
    // Tile order of 4 x 2 pixels is 0 1 4 5 2 3 6 7.
    run.list<uint>("order", {7, 2, 5, 0, 1, 3, 6, 4});
    EXPECT_EQ(allLists(run), (std::vector<std::vector<uvec3>>{{{5, 0, 1}, {2, 0, 1}, {7, 0, 1}},
                                                              {{0, 0, 1}, {1, 0, 1}, {3, 0, 1}},
                                                              {{4, 0, 1}, {6, 0, 1}}}));
    EXPECT_EQ(run.counter("pixels"), 8);
}

TEST(Request, TakesAllPixelsInTileOrderWithoutAnOrder) {
    PassRun run(requestPass());
    run.extent({4, 2}).param("batch", 5u).param("samples", 3u);
    EXPECT_EQ(allLists(run), (std::vector<std::vector<uvec3>>{
                                 {{0, 0, 3}, {1, 0, 3}, {4, 0, 3}, {5, 0, 3}, {2, 0, 3}},
                                 {{3, 0, 3}, {6, 0, 3}, {7, 0, 3}}}));
}

TEST(Request, VisitsAgainUntilAllSamplesAreRequested) {
    PassRun run(requestPass());
    run.extent({2, 1}).param("batch", 1u).param("samples", 5u).param("per_visit", 2u);
    run.list<uint>("order", {1, 0});
    EXPECT_EQ(allLists(run),
              (std::vector<std::vector<uvec3>>{
                  {{1, 0, 2}}, {{0, 0, 2}}, {{1, 2, 2}}, {{0, 2, 2}}, {{1, 4, 1}}, {{0, 4, 1}}}));
}

TEST(Request, GoesOnWhereTheStateStands) {
    PassRun run(requestPass());
    run.extent({4, 1}).param("batch", 1u);
    run.list<uint>("order", {3, 2, 1, 0}).list<uint>("state", {2}).execute();
    EXPECT_EQ(run.output<uvec3>("requests"), (std::vector<uvec3>{{1, 0, 1}}));
    EXPECT_EQ(run.output<uint>("state"), std::vector<uint>{3});
}

TEST(Request, IsEmptyForAnEmptyOrder) {
    PassRun run(requestPass());
    run.extent({4, 1}).list<uint>("order", {}, 4).execute();
    EXPECT_TRUE(run.output<uvec3>("requests").empty());
}

class RequestBatch : public testing::TestWithParam<uint> {};

TEST_P(RequestBatch, CoversEveryPixelOnceWithAndWithoutAnOrder) {
    const uvec2 extent{131, 77};
    std::vector<uint> order(extent.x * extent.y);
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::shuffle(order, std::mt19937(1));
    const TileOrder tiles(extent);
    for (bool has_order : {false, true}) {
        PassRun run(requestPass());
        run.extent(extent).param("batch", GetParam());
        if (has_order)
            run.list("order", order);
        std::vector<uint> requested;
        for (const std::vector<uvec3>& list : allLists(run)) {
            EXPECT_TRUE(std::ranges::is_sorted(
                list, {}, [&](uvec3 request) { return tiles.key(request.x); }));
            for (uvec3 request : list)
                requested.push_back(request.x);
        }
        std::ranges::sort(requested);
        std::vector<uint> expected(order.size());
        std::iota(expected.begin(), expected.end(), 0u);
        EXPECT_EQ(requested, expected);
    }
}
INSTANTIATE_TEST_SUITE_P(Sizes, RequestBatch, testing::Values(1u, 7u, 1000u, 0u));

TEST(Request, ListsTheSameForBothStrategiesOfSort) {
    const uvec2 extent{131, 77};
    std::mt19937 random(5);
    std::vector<vec2> errors(extent.x * extent.y);
    for (vec2& error : errors)
        error = vec2(static_cast<float>(random() % 50) / 50.0f);
    std::vector<std::vector<std::vector<uvec3>>> lists;
    for (const char* strategy : {"select", "radix"}) {
        PassRun sort(sortPass());
        sort.extent(extent).param("strategy", strategy).param("batch", 512u);
        sort.plane("error", errors).execute();
        PassRun run(requestPass());
        run.extent(extent).param("batch", 512u).input("order", sort.value("order"));
        lists.push_back(allLists(run));
    }
    EXPECT_EQ(lists[0], lists[1]);
}

} // namespace
} // namespace hone

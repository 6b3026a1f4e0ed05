// SPDX-License-Identifier: Apache-2.0
#include "hone/core/image/tile_order.h"
#include "hone/core/trace/sample.glsl.h"
#include "hone/passes/passes.h"
#include "hone/tests/support/run_pass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
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

/// Executes with what the pixels have so far, and gives them what was requested.
std::vector<uvec3> nextVisit(PassRun& run, std::vector<uint>& taken) {
    std::vector<Accumulated> accumulation;
    for (uint count : taken)
        accumulation.push_back({vec3(0), count});
    run.plane("accumulation", accumulation).execute();
    const std::vector<uvec3> requests = run.output<uvec3>("requests");
    for (uvec3 request : requests) {
        EXPECT_EQ(request.y, taken[request.x]) << "samples follow those that were taken";
        taken[request.x] += request.z;
    }
    return requests;
}

TEST(Request, VisitsBadPixelsForMoreSamplesAndTheOthersUntilAllHaveAll) {
    PassRun run(requestPass());
    run.extent({3, 1}).param("batch", 2u).param("samples", 5u);
    run.list<uint>("order", {2, 0, 1}).plane<uint>("counts", {2, 1, 4});
    std::vector<uint> taken{0, 0, 0};
    using Requests = std::vector<uvec3>;
    EXPECT_EQ(nextVisit(run, taken), (Requests{{0, 0, 2}, {2, 0, 4}}));
    EXPECT_EQ(nextVisit(run, taken), (Requests{{1, 0, 1}})); // the order ends
    EXPECT_EQ(nextVisit(run, taken), (Requests{{0, 2, 2}, {2, 4, 1}}));
    EXPECT_EQ(nextVisit(run, taken), (Requests{{1, 1, 1}}));
    EXPECT_EQ(nextVisit(run, taken), (Requests{{0, 4, 1}, {1, 2, 1}})); // 2 is finished
    EXPECT_EQ(nextVisit(run, taken), (Requests{{1, 3, 1}}));
    EXPECT_EQ(nextVisit(run, taken), (Requests{{1, 4, 1}}));
    EXPECT_EQ(nextVisit(run, taken), Requests{});
    EXPECT_EQ(taken, (std::vector<uint>{5, 5, 5}));
}

TEST(Request, EndsABatchBeforeItsSamplesAreTooMany) {
    PassRun run(requestPass());
    run.extent({4, 1}).param("samples", 9u).param("max_samples", 5u);
    run.list<uint>("order", {0, 1, 2, 3}).plane<uint>("counts", {3, 2, 9, 1});
    std::vector<uint> taken{0, 0, 0, 0};
    using Requests = std::vector<uvec3>;
    EXPECT_EQ(nextVisit(run, taken), (Requests{{0, 0, 3}, {1, 0, 2}}));
    EXPECT_EQ(nextVisit(run, taken), (Requests{{2, 0, 9}})); // one pixel at least
    EXPECT_EQ(nextVisit(run, taken), (Requests{{3, 0, 1}}));
}

TEST(Request, GivesEveryPixelItsSamplesWhateverCountsAndBatchesAre) {
    const uvec2 extent{37, 21};
    std::mt19937 random(3);
    std::vector<uint> order(extent.x * extent.y), counts(order.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::shuffle(order, random);
    for (uint& count : counts)
        count = static_cast<uint>(random() % 9); // 0 counts as 1
    for (const auto& [batch, max_samples] : {std::pair{1u, 0u}, {7u, 0u}, {0u, 0u}, {0u, 50u}})
        for (bool has_order : {false, true}) {
            PassRun run(requestPass());
            run.extent(extent).param("batch", batch).param("max_samples", max_samples);
            run.param("samples", 6u).plane("counts", counts);
            if (has_order)
                run.list("order", order);
            std::vector<uint> taken(order.size());
            while (!nextVisit(run, taken).empty()) {
            }
            EXPECT_EQ(taken, std::vector<uint>(order.size(), 6)) << batch << " " << max_samples;
        }
}

TEST(Request, OfCountsSaysWhatToConnect) {
    for (bool has_counts : {false, true}) {
        PassRun run(requestPass());
        run.extent({1, 1});
        if (has_counts)
            run.plane<uint>("counts", {1});
        else
            run.param("max_samples", 4u);
        try {
            run.execute();
            FAIL() << "ran without accumulation";
        } catch (const GraphError& error) {
            EXPECT_NE(std::string(error.what()).find("accumulation"), std::string::npos);
        }
    }
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

TEST(Request, TellsTheWorstOfItsBatch) {
    PassRun run(requestPass());
    run.extent({4, 1}).param("batch", 2u);
    run.list<uint>("order", {3, 0, 2, 1}).list<uint>("state", {0});
    run.plane<vec2>("error", {{0.5f, 9}, {0.125f, 9}, {0.25f, 9}, {0.75f, 9}});
    std::vector<float> worst;
    for (int i = 0; i < 3; ++i) {
        run.execute();
        worst.push_back(run.output<float>("worst").front());
        run.list<uint>("state", run.output<uint>("state"));
    }
    EXPECT_EQ(worst, (std::vector<float>{0.75f, 0.25f, 0})) << "3 and 0, 2 and 1, nothing";
}

TEST(Request, IsBelowNoLimitWhereNobodyKnowsTheErrors) {
    PassRun run(requestPass());
    run.extent({4, 1}).execute();
    EXPECT_EQ(run.output<float>("worst").front(), std::numeric_limits<float>::max());
}

} // namespace
} // namespace hone

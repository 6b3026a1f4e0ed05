// SPDX-License-Identifier: Apache-2.0
#include "hone/core/image/tile_order.h"
#include "hone/passes/passes.h"
#include "hone/tests/support/run_pass.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace hone {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kDenormal = 1e-40f;

/// What the order means, in plain words: what is not finite is 1, what is not positive is 0.
float meaning(float expect) {
    if (!std::isfinite(expect))
        return 1.0f;
    return expect > 0.0f ? expect : 0.0f;
}

/// The total order by std::stable_sort.
std::vector<uint> expectedOrder(const std::vector<vec2>& errors, bool flagged_only = false) {
    std::vector<uint> order;
    for (uint pixel = 0; pixel < errors.size(); ++pixel)
        if (!flagged_only || errors[pixel].y > 0.0f)
            order.push_back(pixel);
    std::ranges::stable_sort(order, std::greater{},
                             [&](uint pixel) { return meaning(errors[pixel].x); });
    return order;
}

/// The same with every batch in tile order.
std::vector<uint> expectedBatches(std::vector<uint> order, std::size_t batch, uvec2 extent) {
    const TileOrder tiles(extent);
    for (std::size_t begin = 0; begin < order.size(); begin += batch)
        std::ranges::sort(std::span(order).subspan(begin, std::min(batch, order.size() - begin)),
                          {}, [&](uint pixel) { return tiles.key(pixel); });
    return order;
}

std::vector<uint> sorted(const std::vector<vec2>& errors, uvec2 extent, const char* strategy,
                         uint batch = 0, const char* scope = "all") {
    PassRun run(sortPass());
    run.extent(extent).param("strategy", strategy).param("batch", batch).param("scope", scope);
    return run.plane("error", errors).execute().output<uint>("order");
}

/// All kinds of values: 2/3 zeros, many ties, all scales, everything that is special.
std::vector<vec2> mixedErrors(std::size_t count, uint seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    const float special[] = {0.0f,      -0.0f,
                             kDenormal, 2 * kDenormal,
                             1.0f,      std::nextafter(1.0f, 0.0f),
                             kNan,      std::numeric_limits<float>::infinity(),
                             -1.0f,     3e38f};
    std::vector<vec2> errors(count);
    for (vec2& error : errors) {
        const auto kind = random() % 12;
        float expect = 0.0f;
        if (kind == 0)
            expect = special[random() % 10];
        else if (kind == 1)
            expect = static_cast<float>(random() % 4) * 0.25f;
        else if (kind == 2)
            expect = std::exp(-20.0f * unit(random));
        else if (kind == 3)
            expect = unit(random);
        error = {expect, random() % 3 == 0 ? 1.0f : 0.0f};
    }
    return errors;
}

class SortStrategy : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Both, SortStrategy, testing::Values("select", "radix"),
                         [](const auto& tested) { return tested.param; });

TEST_P(SortStrategy, PutsTheGreatestErrorFirstAndBreaksTiesByPixel) {
    const std::vector<vec2> errors{{0.5f, 1}, {-0.0f, 0}, {0.0f, 0},
                                   {2.0f, 1}, {0.5f, 1},  {kNan, 1}};
    // One pixel a batch, so that tile order says nothing.
    EXPECT_EQ(sorted(errors, {6, 1}, GetParam(), 1), (std::vector<uint>{3, 5, 0, 4, 1, 2}));
}

TEST_P(SortStrategy, TellsNeighbouringFloatsApart) {
    const float below = std::nextafter(1.0f, 0.0f);
    const std::vector<vec2> errors{
        {kDenormal, 1}, {below, 1}, {0.0f, 1}, {1.0f, 1}, {2 * kDenormal, 1}};
    EXPECT_EQ(sorted(errors, {5, 1}, GetParam(), 1), (std::vector<uint>{3, 1, 4, 0, 2}));
}

TEST_P(SortStrategy, ListsOnePixel) {
    EXPECT_EQ(sorted({{0.0f, 0.0f}}, {1, 1}, GetParam()), std::vector<uint>{0});
}

TEST_P(SortStrategy, ListsNothingWhenNothingIsFlagged) {
    EXPECT_TRUE(sorted({{1.0f, 0.0f}, {0.5f, 0.0f}}, {2, 1}, GetParam(), 1, "flagged").empty());
}

TEST_P(SortStrategy, ListsOnlyFlaggedPixels) {
    const uvec2 extent{131, 67};
    const std::vector<vec2> errors = mixedErrors(131 * 67, 7);
    for (uint batch : {1u, 7u, 500u}) {
        std::vector<uint> expected = expectedOrder(errors, true);
        if (std::string_view(GetParam()) == "select")
            expected = expectedBatches(std::move(expected), batch, extent);
        EXPECT_EQ(sorted(errors, extent, GetParam(), batch, "flagged"), expected) << batch;
    }
}

TEST_P(SortStrategy, CountsErrorPixels) {
    PassRun run(sortPass());
    run.extent({4, 1}).param("strategy", GetParam());
    run.plane<vec2>("error", {{1, 1}, {0, 0.5f}, {1, 0}, {0, kNan}}).execute();
    EXPECT_EQ(run.counter("error_pixels"), 3);
    EXPECT_EQ(run.counter("error_share_ppm"), 750'000);
}

TEST(SortRadix, OrdersAMillionMixedErrors) {
    const std::vector<vec2> errors = mixedErrors(1u << 20, 1);
    EXPECT_EQ(sorted(errors, {1024, 1024}, "radix"), expectedOrder(errors));
}

TEST(SortSelect, MakesTheSameBatchesAsSortingForEveryBatchSizeAndThreadCount) {
    const uvec2 extent{641, 479};
    const uint pixels = extent.x * extent.y;
    for (uint seed : {1u, 2u}) {
        const std::vector<vec2> errors = mixedErrors(pixels, seed);
        const std::vector<uint> order = expectedOrder(errors);
        for (uint batch : {1u, 7u, 100u, 8192u, pixels - 1, pixels}) {
            const std::vector<uint> expected = expectedBatches(order, batch, extent);
            for (std::size_t threads : {1, 2, 8}) {
                tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
                EXPECT_EQ(sorted(errors, extent, "select", batch), expected)
                    << "batch " << batch << ", threads " << threads;
            }
        }
    }
}

TEST(SortSelect, CutsThroughManyEqualErrors) {
    const uvec2 extent{200, 100};
    std::vector<vec2> errors(20'000);
    for (uint pixel = 0; pixel < errors.size(); ++pixel)
        errors[pixel] = vec2(pixel % 5 == 0 ? 1.0f : 0.25f);
    EXPECT_EQ(sorted(errors, extent, "select", 900),
              expectedBatches(expectedOrder(errors), 900, extent));
}

TEST(SortSelect, ExecutesAgainWithOtherErrors) {
    PassRun run(sortPass());
    const uvec2 extent{64, 64};
    run.extent(extent).param("batch", 100u);
    for (uint seed : {1u, 2u, 3u}) {
        const std::vector<vec2> errors = mixedErrors(64 * 64, seed);
        EXPECT_EQ(run.plane("error", errors).execute().output<uint>("order"),
                  expectedBatches(expectedOrder(errors), 100, extent));
    }
}

} // namespace
} // namespace hone

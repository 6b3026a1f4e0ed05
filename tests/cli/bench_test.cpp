// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/allocation_count.h"
#include "hone/cli/bench_clock.h"
#include "hone/cli/bench_table.h"
#include "hone/cli/commands.h"
#include "hone/tests/cli/command_run.h"

#include <gtest/gtest.h>

#include <vector>

#include <memory>
#include <sstream>

namespace hone::cli {
namespace {

TEST(BenchClock, TakesTheMiddleOrTheMeanOfTheTwo) {
    EXPECT_EQ(median({}), 0.0);
    EXPECT_EQ(median({7}), 7.0);
    EXPECT_EQ(median({9, 1, 5}), 5.0);
    EXPECT_EQ(median({9, 1, 5, 3}), 4.0);
}

// Rounds of ratios 2, 2 and 3, although the machine became ten times slower.
TEST(BenchClock, ComparesWhatRanSideBySide) {
    const double a[] = {2, 20, 30}, b[] = {1, 10, 10};
    EXPECT_EQ(medianRatio(a, b), 2.0);
}

TEST(BenchClock, RunsContendersInTurnAndDropsTheFirstRound) {
    std::string order;
    const std::function<void()> contenders[] = {[&] { order += 'a'; }, [&] { order += 'b'; }};
    const std::vector<std::vector<double>> ms = interleave(2, contenders);
    EXPECT_EQ(order, "ababab");
    ASSERT_EQ(ms.size(), 2u);
    EXPECT_EQ(ms[0].size(), 2u);
    EXPECT_EQ(ms[1].size(), 2u);
}

TEST(BenchTable, PutsRatiosUnderTheirSizes) {
    BenchTable table;
    table.parts.push_back(
        {"a", {4, 2}, 1.5, 3, "Mray/s", BenchRatio{"trace_vs_embree/primary", 0.9, 0.8, true}});
    table.parts.push_back({"b", {4, 2}, 1.5, 0, "", BenchRatio{"prt_vs_rays", 2.5, 2.0}});
    const nlohmann::json json = table.json();
    EXPECT_EQ(json["parts"].size(), 2u);
    EXPECT_EQ(json["parts"][0]["size"], "4x2");
    EXPECT_EQ(json["ratios"]["4x2"]["trace_vs_embree"]["primary"]["target"], 0.8);
    EXPECT_EQ(json["ratios"]["4x2"]["trace_vs_embree"]["primary"]["ok"], true);
    EXPECT_EQ(json["ratios"]["4x2"]["prt_vs_rays"]["ok"], false);
    EXPECT_FALSE(table.allMet());
    std::ostringstream text;
    table.print(text);
    EXPECT_NE(text.str().find("missed"), std::string::npos);
}

TEST(AllocationCount, CountsOperatorNew) {
    const std::uint64_t before = allocationCount();
    const auto one = std::make_unique<int>(1);
    const std::vector<int> many(100); // arrays by new[] go past it under a sanitizer
    EXPECT_EQ(allocationCount() - before, 2u);
}

TEST(BenchParts, MeasuresEveryPart) {
    if (!whyNoRaster().empty())
        GTEST_SKIP() << whyNoRaster();
    const CommandRun run = runHone({"bench", "parts", "--scene", "builtin:cornell", "--sizes",
                                    "64x48", "--repeats", "1", "--json"});
    // Targets are for full sizes; here it only has to run.
    EXPECT_TRUE(run.code == kOk || run.code == kTargetNotMet) << run.err;
    const nlohmann::json report = run.json();
    const nlohmann::json& ratios = report["ratios"]["64x48"];
    for (const char* name :
         {"trace_vs_embree", "select_vs_std_sort", "radix_vs_std_sort", "prt_vs_rays",
          "batch_vs_rays", "visibility_vs_depth_only", "streaming", "steady_allocations"})
        EXPECT_TRUE(ratios.contains(name)) << name;
    EXPECT_TRUE(ratios["trace_vs_embree"].contains("primary"));
    EXPECT_TRUE(ratios["trace_vs_embree"].contains("shadow"));
    for (const nlohmann::json& part : report["parts"])
        EXPECT_GE(part["ms"].get<double>(), 0.0) << part["name"];
    EXPECT_EQ(ratios["steady_allocations"]["value"], 0.0);
}

TEST(BenchTracers, MeasuresEveryKindOfRayWithEveryBackend) {
    const CommandRun run =
        runHone({"bench", "tracers", "--scene", "builtin:cornell", "--size", "32x24", "--repeats",
                 "1", "--backends", "brute,embree", "--json"});
    ASSERT_EQ(run.code, kOk) << run.err;
    const nlohmann::json report = run.json();
    ASSERT_EQ(report["backends"].size(), 2u);
    for (const nlohmann::json& row : report["backends"]) {
        double share = report["rest_ms"].get<double>() / row["frame_ms"].get<double>();
        for (const nlohmann::json& kind : row["kinds"]) {
            EXPECT_GT(kind["mrays_per_s"].get<double>(), 0.0);
            EXPECT_EQ(kind["sampled"], kind["rays"]);
            share += kind["frame_share"].get<double>();
        }
        EXPECT_EQ(row["kinds"][0]["kind"], "primary");
        EXPECT_EQ(row["kinds"][0]["rays"], 32 * 24);
        EXPECT_NEAR(share, 1.0, 1e-9);
    }
    // Both settle ties alike, and no ray of this view grazes an edge.
    EXPECT_EQ(report["backends"][1]["kinds"][0]["differing"], 0);
}

TEST(BenchTracers, NamesAnUnknownBackend) {
    const CommandRun run =
        runHone({"bench", "tracers", "--scene", "builtin:cornell", "--backends", "embre"});
    EXPECT_EQ(run.code, kBadInput);
    EXPECT_NE(run.err.find("embre"), std::string::npos);
}

} // namespace
} // namespace hone::cli

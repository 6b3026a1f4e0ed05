// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/commands.h"
#include "hone/tests/cli/command_run.h"

#include <gtest/gtest.h>

namespace hone::cli {
namespace {

// How small the overhead is depends on the machine and its load; that nothing is allocated and that
// it is a part of the frame does not.
TEST(BenchExecutor, SplitsAFrameIntoPassesAndTheRest) {
    const CommandRun run = runHone(
        {"bench", "executor", "--size", "64x48", "--passes", "20", "--repeats", "3", "--json"});
    EXPECT_TRUE(run.code == kOk || run.code == kTargetNotMet) << run.err;
    const nlohmann::json report = run.json();
    EXPECT_EQ(report["passes"], 20);
    EXPECT_EQ(report["allocations"], 0);
    EXPECT_GT(report["overhead_ms"].get<double>(), 0.0);
    EXPECT_LT(report["overhead_ms"].get<double>(), report["frame_ms"].get<double>());
}

} // namespace
} // namespace hone::cli

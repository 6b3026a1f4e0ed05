// SPDX-License-Identifier: Apache-2.0
//
// What a run writes is the same bits however many threads worked, and whether it was refined or
// traced at once.
#include "hone/cli/commands.h"
#include "hone/tests/cli/command_run.h"

#include <gtest/gtest.h>

namespace hone::cli {
namespace {

std::string render(const TemporaryFolder& folder, const std::string& name,
                   std::vector<std::string> arguments) {
    const std::string out = folder.path(name);
    arguments.insert(arguments.end(),
                     {"--scene", "builtin:cornell", "--size", "64x48", "-q", "-o", out});
    const CommandRun run = runHone(arguments);
    EXPECT_EQ(run.code, kOk) << run.err;
    return out;
}

void expectSameColor(const std::string& a, const std::string& b) {
    const CommandRun run =
        runHone({"compare", a, b, "--layer", "color", "--max-differing-bits", "0"});
    EXPECT_EQ(run.code, kOk) << run.out << run.err;
}

TEST(Determinism, TracingDoesNotDependOnThreads) {
    const TemporaryFolder folder;
    const std::string one =
        render(folder, "one", {"render", "prt", "--threads", "1", "--set", "samples=2"});
    const std::string two =
        render(folder, "two", {"render", "prt", "--threads", "2", "--set", "samples=2"});
    expectSameColor(one + "/prt.exr", two + "/prt.exr");
}

TEST(Determinism, RefiningDoesNotDependOnThreadsAndEndsAtTheTracedImage) {
    if (!whyNoRaster().empty())
        GTEST_SKIP() << whyNoRaster();
    const TemporaryFolder folder;
    const std::string one =
        render(folder, "one", {"render", "sir", "--threads", "1", "--set", "batch=512"});
    const std::string two =
        render(folder, "two", {"render", "sir", "--threads", "2", "--set", "batch=512"});
    const std::string traced = render(folder, "traced", {"render", "prt"});
    expectSameColor(one + "/sir.exr", two + "/sir.exr");
    expectSameColor(one + "/sir.exr", traced + "/prt.exr");
    // Stopped after one batch, order and all, too.
    const std::string early_one =
        render(folder, "early1",
               {"render", "sir", "--threads", "1", "--set", "batch=512", "--iterations", "1"});
    const std::string early_two =
        render(folder, "early2",
               {"render", "sir", "--threads", "2", "--set", "batch=512", "--iterations", "1"});
    expectSameColor(early_one + "/sir.exr", early_two + "/sir.exr");
}

} // namespace
} // namespace hone::cli

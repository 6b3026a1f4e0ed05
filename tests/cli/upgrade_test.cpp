// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/cli/command_run.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace hone::cli {
namespace {

const std::string kOld =
    "{ \"hone\": 1, // old\n  \"passes\": { \"d\": { \"type\": \"difference\" } } }\n";
const std::string kNew =
    "{ \"hone\": 2, // old\n  \"passes\": { \"d\": { \"type\": \"measure.error\" } } }\n";

std::string read(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

TEST(UpgradeCommand, RewritesTheFileAndSaysWhat) {
    const TemporaryFolder folder;
    const std::string path = folder.write("g.json", kOld);
    const CommandRun run = runHone({"upgrade", path});
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(read(folder.path("g.json")), kNew);
    EXPECT_NE(run.out.find("g.json:2:30: pass type \"difference\" is \"measure.error\""),
              std::string::npos)
        << run.out;
}

TEST(UpgradeCommand, PrintsWithoutWriting) {
    const TemporaryFolder folder;
    const CommandRun run = runHone({"upgrade", "--print", folder.write("g.json", kOld)});
    EXPECT_EQ(run.out, kNew);
    EXPECT_EQ(read(folder.path("g.json")), kOld);
}

TEST(UpgradeCommand, LeavesWhatItCannotReadAlone) {
    const TemporaryFolder folder;
    const std::string broken = "{ \"hone\": 1, ";
    const CommandRun run = runHone({"upgrade", folder.write("g.json", broken), "no_such.json"});
    EXPECT_EQ(run.code, 3);
    EXPECT_EQ(read(folder.path("g.json")), broken);
    EXPECT_NE(run.err.find("E0101"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("E0106"), std::string::npos) << run.err;
    const CommandRun empty = runHone({"upgrade", folder.write("empty.json", "")});
    EXPECT_NE(empty.err.find("E0101"), std::string::npos) << empty.err;
    EXPECT_NE(runHone({"upgrade", "/dev/zero"}).err.find("E0104"), std::string::npos);
}

} // namespace
} // namespace hone::cli

// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/cli/command_run.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace hone::cli {
namespace {

/// Renders the small Cornell box without rasterising, and records its rays.
CommandRun record(const TemporaryFolder& folder, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"render",  "prt",         "--scene",  "builtin:cornell",
                                       "--size",  "24x16",       "--device", "none",
                                       "-o",      folder.path(), "--record", folder.path("rays"),
                                       "--quiet", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runHone(arguments);
}

TEST(Replay, AsksTheRecordedBackendAgainAndFindsNoDifference) {
    const TemporaryFolder folder;
    const CommandRun rendered = record(folder);
    ASSERT_EQ(rendered.code, 0) << rendered.err;
    EXPECT_EQ(rendered.json()["record"]["path"], folder.path("rays"));
    EXPECT_EQ(rendered.json()["record"]["is_cut"], false);
    const CommandRun run = runHone({"replay", folder.path("rays"), "--device", "none", "--json"});
    ASSERT_EQ(run.code, 0) << run.err;
    const nlohmann::json result = run.json();
    EXPECT_EQ(result["scene"], "builtin:cornell");
    ASSERT_EQ(result["backends"].size(), 1u);
    const nlohmann::json& backend = result["backends"][0];
    EXPECT_EQ(backend["name"], result["recorded_by"]);
    EXPECT_GE(backend["closest"]["rays"], 24 * 16);
    EXPECT_GT(backend["closest"]["mrays_per_s"], 0.0);
    EXPECT_GT(backend["occluded"]["rays"], 0);
    EXPECT_EQ(backend["closest"]["differing"], 0);
}

TEST(Replay, FindsAllBackendsEqualUpToRounding) {
    const TemporaryFolder folder;
    ASSERT_EQ(record(folder).code, 0);
    const CommandRun run =
        runHone({"replay", folder.path("rays"), "--backend", "all", "--device", "none", "--json"});
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_GE(run.json()["backends"].size(), 2u);
}

TEST(Replay, SaysWhichRayABackendAnswersWrong) {
    const TemporaryFolder folder;
    ASSERT_EQ(record(folder).code, 0);
    const CommandRun run =
        runHone({"replay", folder.path("rays"), "--backend", "null", "--device", "none"});
    EXPECT_EQ(run.code, 1);
    EXPECT_NE(run.err.find("null: nothing  <- wrong"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("the ray surely meets instance"), std::string::npos);
}

TEST(Replay, RefusesOtherFilesScenesAndBackends) {
    const TemporaryFolder folder;
    ASSERT_EQ(record(folder).code, 0);
    EXPECT_EQ(runHone({"replay", folder.write("text", "no recording")}).code, 3);
    EXPECT_EQ(runHone({"replay", folder.path("absent")}).code, 3);
    const CommandRun other =
        runHone({"replay", folder.path("rays"), "--scene", "builtin:mirror_room"});
    EXPECT_EQ(other.code, 3);
    EXPECT_EQ(runHone({"replay", folder.path("rays"), "--backend", "embre"}).code, 3);
}

TEST(Replay, StopsARecordingAtItsLimitButNotTheRun) {
    const TemporaryFolder folder;
    const CommandRun rendered = record(folder, {"--record-limit", "20000"});
    ASSERT_EQ(rendered.code, 0) << rendered.err;
    EXPECT_EQ(rendered.json()["record"]["is_cut"], true);
    EXPECT_LE(std::filesystem::file_size(folder.path("rays")), 20000u);
    EXPECT_TRUE(std::filesystem::exists(folder.path("color.png")));
    const CommandRun run = runHone({"replay", folder.path("rays"), "--device", "none"});
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_NE(run.err.find("ends early"), std::string::npos);
}

TEST(Check, ReportsWhatItCounted) {
    const TemporaryFolder folder;
    const CommandRun run = record(folder, {"--set", "backend=check(embree,brute)"});
    ASSERT_EQ(run.code, 0) << run.err;
    const nlohmann::json check = run.json()["check"];
    EXPECT_GE(check["closest"]["rays"], 24 * 16);
    EXPECT_GT(check["closest"]["judged"], 0);
    EXPECT_EQ(check["closest"]["unexplained"], 0);
}

TEST(Check, EndsTheRunWhereABackendIsWrong) {
    const TemporaryFolder folder;
    const CommandRun run = record(folder, {"--set", "backend=check(embree,null)"});
    EXPECT_EQ(run.code, 1);
    EXPECT_NE(run.err.find("check(embree,null): closest hit"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("null: nothing  <- wrong"), std::string::npos);
}

TEST(Check, SuggestsTheInnerName) {
    const CommandRun run = runHone({"check", "prt", "--set", "backend=check(embre)"});
    EXPECT_EQ(run.code, 3);
    EXPECT_NE(run.err.find("did you mean \"check(embree)\"?"), std::string::npos) << run.err;
}

} // namespace
} // namespace hone::cli

// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/copies.h"

#include "hone/cli/commands.h"
#include "hone/tests/cli/command_run.h"

#include <gtest/gtest.h>

#include <sstream>

namespace hone::cli {
namespace {

const std::vector<MemoryCopy> kTwo{
    {.what = "scene_positions", .bytes = 48, .why = "a cannot", .cure = "take b"},
    {.what = "rays", .bytes = 7, .why = "c cannot", .cure = "take d"}};

TEST(Copies, AreAllowedUpToTheLimit) {
    std::ostringstream err;
    EXPECT_TRUE(areCopiesAllowed(kTwo, -1, err));
    EXPECT_TRUE(areCopiesAllowed(kTwo, 2, err));
    EXPECT_TRUE(areCopiesAllowed({}, 0, err));
    EXPECT_EQ(err.str(), "");
}

TEST(Copies, PastTheLimitAreListedWithTheirReasonAndTheirCure) {
    std::ostringstream err;
    EXPECT_FALSE(areCopiesAllowed(kTwo, 1, err));
    EXPECT_EQ(err.str(), "2 copies between memories; --max-copies allows 1:\n"
                         "  scene_positions, 48 bytes: a cannot\n"
                         "    what would avoid it: take b\n"
                         "  rays, 7 bytes: c cannot\n"
                         "    what would avoid it: take d\n");
}

TEST(Copies, BecomeJson) {
    const nlohmann::ordered_json json = copiesAsJson(kTwo);
    ASSERT_EQ(json.size(), 2u);
    EXPECT_EQ(json[1].dump(), R"({"what":"rays","bytes":7,"why":"c cannot","cure":"take d"})");
    EXPECT_EQ(copiesAsJson({}).dump(), "[]");
}

TEST(RenderCopies, AreNoneWhereTheDeviceImportsHostMemory) {
    if (const std::string reason = whyNoRaster(); !reason.empty())
        GTEST_SKIP() << reason;
    const CommandRun doctor = runHone({"doctor"});
    if (doctor.out.find("imports host memory yes") == std::string::npos)
        GTEST_SKIP() << "no device here imports host memory";
    const TemporaryFolder folder;
    const CommandRun run =
        runHone({"render", "sir", "--scene", "builtin:cornell", "--size", "32x24", "--set",
                 "backend=embree", "-o", folder.path(), "--max-copies", "0", "--json"});
    EXPECT_EQ(run.code, kOk) << run.err;
    EXPECT_EQ(run.json()["copies"].dump(), "[]");
    EXPECT_NE(run.err.find("copies between memories: 0\n"), std::string::npos) << run.err;
}

TEST(RenderCopies, LimitIsANumberFromZero) {
    EXPECT_EQ(runHone({"render", "prt", "--max-copies", "-1"}).code, kUsage);
}

} // namespace
} // namespace hone::cli

// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/commands.h"
#include "hone/tests/cli/command_run.h"

#include <gtest/gtest.h>

namespace hone::cli {
namespace {

using testing::Test;

TEST(CommandLine, EndsWithUsageWhereWordsMakeNoSense) {
    const std::vector<std::vector<std::string>> lines = {
        {},
        {"rendr"},
        {"render"},
        {"render", "prt", "--sise", "8x8"},
        {"render", "prt", "--size", "800"},
        {"render", "prt", "--size", "0x600"},
        {"render", "prt", "--size", "8x8x8"},
        {"render", "prt", "--size", "-8x8"},
        {"render", "prt", "--size", "99999x8"},
        {"render", "prt", "--set", "batch"},
        {"render", "prt", "--set", "=4"},
        {"render", "prt", "--threads", "-1"},
        {"render", "prt", "--max-ms", "-1"},
        {"check"},
        {"compare", "one.png"},
        {"compare", "one.png", "two.png", "--ppd", "0"},
        {"bench"},
        {"bench", "parts", "--sizes", "wide"},
        {"bench", "parts", "--repeats", "0"},
    };
    for (const std::vector<std::string>& line : lines) {
        std::string text = "hone";
        for (const std::string& word : line)
            text += " " + word;
        SCOPED_TRACE(text);
        const CommandRun run = runHone(line);
        EXPECT_EQ(run.code, kUsage);
        EXPECT_EQ(run.out, "");
        EXPECT_NE(run.err, "");
    }
}

TEST(CommandLine, SaysItsVersionAndItsHelp) {
    const CommandRun version = runHone({"--version"});
    EXPECT_EQ(version.code, kOk);
    EXPECT_EQ(version.out.find("hone "), 0u);
    EXPECT_EQ(version.err, "");
    const CommandRun help = runHone({"--help"});
    EXPECT_EQ(help.code, kOk);
    for (const char* command : {"demo", "render", "check", "passes", "compare", "doctor", "bench"})
        EXPECT_NE(help.out.find(command), std::string::npos) << command;
}

TEST(CommandLine, EndsWith3ForAGraphThatIsWrongOrMissing) {
    const TemporaryFolder folder;
    const std::string graph = folder.write("bad.json", R"({
  "hone": 1,
  "name": "bad",
  "inputs": { "scene": "scene" },
  "passes": { "sort": { "type": "sorrt" } },
  "outputs": { "order": "sort.order" }
}
)");
    const CommandRun wrong = runHone({"render", graph, "-o", folder.path("out")});
    EXPECT_EQ(wrong.code, kBadInput);
    EXPECT_NE(wrong.err.find("bad.json:5:"), std::string::npos) << wrong.err;
    EXPECT_NE(wrong.err.find("sorrt"), std::string::npos) << wrong.err;
    EXPECT_EQ(runHone({"check", graph}).code, kBadInput);

    const std::string absent = folder.path("absent.json");
    const CommandRun missing = runHone({"render", absent, "-o", folder.path("out")});
    EXPECT_EQ(missing.code, kBadInput);
    EXPECT_NE(missing.err.find("absent.json"), std::string::npos) << missing.err;
    EXPECT_EQ(runHone({"check", absent}).code, kBadInput);
}

TEST(CommandLine, WritesIntoTheOutputFolderWhateverTheGraphIsCalled) {
    const std::string body = R"("inputs": { "scene": "scene", "camera": "camera" },
      "passes": { "raster": { "type": "raster", "in": { "scene": "$scene", "camera": "$camera" } } },
      "outputs": { "depth": "raster.depth" } })";
    if (const std::string why = whyNoRaster(); !why.empty())
        GTEST_SKIP() << why;
    const TemporaryFolder folder;
    const std::string hostile = folder.write("a.json", R"({ "hone": 1, "name": "../b", )" + body);
    const std::string nameless = folder.write("c.json", R"({ "hone": 1, )" + body);
    for (const std::string& graph : {hostile, nameless})
        EXPECT_EQ(runHone({"render", graph, "--scene", "builtin:one_triangle", "--size", "8x8",
                           "-o", folder.path("out")})
                      .code,
                  kOk);
    EXPECT_TRUE(std::filesystem::exists(folder.path("out/___b.exr")));
    EXPECT_TRUE(std::filesystem::exists(folder.path("out/c.exr")));
}

TEST(CommandLine, EndsWith3ForAnOverrideThatNothingReads) {
    const TemporaryFolder folder;
    const CommandRun run = runHone({"render", "prt", "--scene", "builtin:cornell", "--set",
                                    "bacth=1", "-o", folder.path("out")});
    EXPECT_EQ(run.code, kBadInput);
    EXPECT_NE(run.err.find("bacth"), std::string::npos) << run.err;
}

TEST(CommandLine, EndsWith3ForASceneOrCameraThatIsMissing) {
    const TemporaryFolder folder;
    for (const std::string& scene : {folder.path("absent.scene.json"), folder.path("absent.gltf"),
                                     std::string("builtin:absent")}) {
        const CommandRun run =
            runHone({"render", "prt", "--scene", scene, "-o", folder.path("out")});
        EXPECT_EQ(run.code, kBadInput) << scene;
        EXPECT_NE(run.err.find("absent"), std::string::npos) << run.err;
    }
    const CommandRun run = runHone({"render", "prt", "--scene", "builtin:cornell", "--camera",
                                    "absent", "-o", folder.path("out")});
    EXPECT_EQ(run.code, kBadInput);
    EXPECT_NE(run.err.find("absent"), std::string::npos) << run.err;
}

// The scene is missing, too: the folder is looked at first, so that no work is lost.
TEST(CommandLine, EndsWith7BeforeAnyWorkWhereTheFolderCannotBe) {
    const TemporaryFolder folder;
    const std::string file = folder.write("file", "not a folder");
    const CommandRun run =
        runHone({"render", "prt", "--scene", "builtin:absent", "-o", file + "/out"});
    EXPECT_EQ(run.code, kNotWritten);
    EXPECT_NE(run.err.find(file), std::string::npos) << run.err;
    EXPECT_EQ(runHone({"demo", "-o", file + "/out"}).code, kNotWritten);
}

TEST(CommandLine, EndsWith5ForADeviceThatIsNotThere) {
    const TemporaryFolder folder;
    const CommandRun run = runHone({"render", "prt", "--scene", "builtin:cornell", "--device",
                                    "no such device", "-o", folder.path("out")});
    EXPECT_EQ(run.code, kNoDevice);
    EXPECT_NE(run.err.find("no such device"), std::string::npos) << run.err;
}

TEST(CommandLine, SuggestsAPassForAMisspeltOne) {
    const CommandRun run = runHone({"passes", "combin"});
    EXPECT_EQ(run.code, kUsage);
    EXPECT_NE(run.err.find("did you mean \"combine\"?"), std::string::npos) << run.err;
    EXPECT_EQ(runHone({"passes", "combine"}).code, kOk);
}

} // namespace
} // namespace hone::cli

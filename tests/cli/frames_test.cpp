// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/commands.h"
#include "hone/tests/cli/command_run.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>

namespace hone::cli {
namespace {

TEST(RenderFrames, WritesNumberedFilesAlongThePath) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("two.scene.json", R"({
        "model": "builtin:cornell",
        "paths": [{ "name": "dolly", "keys": [
            { "time": 0, "position": [0, 1, 3.4], "target": [0, 1, 0] },
            { "time": 2, "position": [0, 1, 2.4], "target": [0, 1, 0] } ] }] })");
    const CommandRun run =
        runHone({"render", "prt", "--scene", scene, "--size", "16x12", "--frames", "3", "--path",
                 "dolly", "-o", folder.path("out"), "--json"});
    ASSERT_EQ(run.code, kOk) << run.err;
    const nlohmann::json report = run.json();
    EXPECT_EQ(report["path"], "dolly");
    ASSERT_EQ(report["frames"].size(), 3u);
    EXPECT_EQ(report["outputs"].size(), 9u); // color, curve, prt.exr
    for (std::size_t frame = 0; frame < 3; ++frame) {
        EXPECT_EQ(report["frames"][frame]["frame"], frame);
        EXPECT_EQ(report["frames"][frame]["time"], static_cast<double>(frame));
        for (const char* file : {"color.000%.png", "prt.000%.exr", "curve.000%.csv"}) {
            std::string name = file;
            name.replace(name.find('%'), 1, std::to_string(frame));
            EXPECT_TRUE(std::filesystem::exists(folder.path("out/" + name))) << name;
        }
    }
}

TEST(RenderFrames, DoNothingAgainThatDoesNotSeeTheCamera) {
    if (const std::string reason = whyNoRaster(); !reason.empty())
        GTEST_SKIP() << reason;
    const TemporaryFolder folder;
    const CommandRun run =
        runHone({"render", "paper_corrected", "--scene", "builtin:mirror_sphere", "--size", "32x24",
                 "--frames", "3", "-o", folder.path(), "--json"});
    ASSERT_EQ(run.code, kOk) << run.err;
    const nlohmann::json report = run.json();
    EXPECT_EQ(report["path"], "orbit");
    for (std::size_t frame = 0; frame < 3; ++frame) {
        std::map<std::string, int> runs;
        for (const nlohmann::json& pass : report["frames"][frame]["passes"])
            runs[pass["name"]] = pass["runs"];
        for (const char* kept : {"shadow_map", "probe", "occlusion"})
            EXPECT_EQ(runs[kept], frame == 0 ? 1 : 0) << kept << " of frame " << frame;
        for (const char* anew : {"raster", "reflection", "combine", "sort", "refine.loop"})
            EXPECT_EQ(runs[anew], 1) << anew << " of frame " << frame;
    }
}

TEST(RenderFrames, AreThePicturesOfCamerasAtTheirPlaces) {
    const TemporaryFolder folder;
    const auto scene = [&](const std::string& name, const std::string& position) {
        return folder.write(name, R"({ "model": "builtin:cornell",
            "cameras": [{ "name": "here", "position": )" +
                                      position + R"(, "target": [0, 1, 0] }],
            "paths": [{ "name": "dolly", "keys": [
                { "time": 0, "position": [0, 1, 3.5], "target": [0, 1, 0], "fov_y": 60 },
                { "time": 1, "position": [0, 1, 2.5], "target": [0, 1, 0], "fov_y": 60 } ] }] })");
    };
    const std::string end = scene("a.scene.json", "[0, 1, 2.5]");
    ASSERT_EQ(runHone({"render", "prt", "--scene", end, "--size", "16x12", "--frames", "2", "-o",
                       folder.path("path")})
                  .code,
              kOk);
    ASSERT_EQ(
        runHone({"render", "prt", "--scene", end, "--size", "16x12", "-o", folder.path("still")})
            .code,
        kOk);
    EXPECT_EQ(runHone({"compare", folder.path("path/prt.0001.exr"), folder.path("still/prt.exr"),
                       "--max-differing-bits", "0"})
                  .code,
              kOk);
    EXPECT_EQ(runHone({"compare", folder.path("path/prt.0000.exr"), folder.path("still/prt.exr"),
                       "--max-differing-bits", "0"})
                  .code,
              kTargetNotMet);
}

TEST(RenderFrames, SaysWhichPathsThereAre) {
    const TemporaryFolder folder;
    const CommandRun run = runHone({"render", "prt", "--scene", "builtin:atrium", "--frames", "2",
                                    "--path", "swim", "-o", folder.path()});
    EXPECT_EQ(run.code, kBadInput);
    EXPECT_NE(run.err.find("it has walk"), std::string::npos) << run.err;
}

TEST(RenderFrames, GoWithNoCameraAndNoReference) {
    for (const std::vector<std::string>& wrong :
         {std::vector<std::string>{"render", "prt", "--frames", "0"},
          {"render", "prt", "--path", "walk"},
          {"render", "prt", "--frames", "2", "--camera", "court"},
          {"render", "prt", "--frames", "2", "--reference", "a.exr"}})
        EXPECT_EQ(runHone(wrong).code, kUsage) << wrong.back();
}

} // namespace
} // namespace hone::cli

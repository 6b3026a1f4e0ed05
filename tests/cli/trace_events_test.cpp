// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/commands.h"
#include "hone/tests/cli/command_run.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace hone::cli {
namespace {

nlohmann::json traceOf(const std::string& path) {
    std::ifstream file(path);
    return nlohmann::json::parse(file);
}

// Four iterations of four pixels and a fifth that finds nothing.
class Trace : public testing::Test {
protected:
    CommandRun render(const std::string& graph, const std::string& path) {
        return runHone({"render", graph, "--scene", "builtin:cornell", "--size", "4x4", "--set",
                        "batch=4", "-o", folder.path("out"), "--device", "none", "-q", "--trace",
                        path});
    }
    TemporaryFolder folder;
};

TEST_F(Trace, NestsPassesInIterationsInLoopsInFrames) {
    const std::string path = folder.path("trace.json");
    const CommandRun run = render("prt", path);
    ASSERT_EQ(run.code, kOk) << run.err;
    const nlohmann::json file = traceOf(path);
    std::map<std::string, int> count;
    std::vector<nlohmann::json> open; // what the next event lies in
    for (const nlohmann::json& event : file["traceEvents"]) {
        if (event["ph"] != "X")
            continue;
        ++count[event["name"].get<std::string>()];
        const double begin = event["ts"].get<double>();
        const double end = begin + event["dur"].get<double>();
        const auto endOf = [](const nlohmann::json& e) {
            return e["ts"].get<double>() + e["dur"].get<double>();
        };
        while (!open.empty() && endOf(open.back()) <= begin)
            open.pop_back();
        if (event["cat"] == "frame") {
            EXPECT_TRUE(open.empty());
        } else {
            ASSERT_FALSE(open.empty()) << event;
            EXPECT_LE(end, endOf(open.back()) + 1e-3) << event;
            const std::string parent = open.back()["cat"];
            EXPECT_EQ(parent, event["cat"] == "iteration"           ? "loop"
                              : event["args"].contains("iteration") ? "iteration"
                                                                    : "frame")
                << event;
        }
        open.push_back(event);
    }
    EXPECT_EQ(count["frame"], 1);
    EXPECT_EQ(count["refine"], 1);
    EXPECT_EQ(count["refine.trace"], 5);
    for (int i = 1; i <= 5; ++i)
        EXPECT_EQ(count["iteration " + std::to_string(i)], 1);
}

TEST_F(Trace, CountsPixels) {
    const std::string path = folder.path("trace.json");
    ASSERT_EQ(render("prt", path).code, kOk);
    std::vector<int> pixels;
    const nlohmann::json file = traceOf(path);
    for (const nlohmann::json& event : file["traceEvents"])
        if (event["ph"] == "C" && event["name"] == "pixels" &&
            (pixels.empty() || pixels.back() != event["args"]["pixels"]))
            pixels.push_back(event["args"]["pixels"]);
    EXPECT_EQ(pixels, (std::vector<int>{4, 8, 12, 16}));
}

TEST_F(Trace, EscapesNames) {
    std::ifstream file(HONE_SOURCE_DIR "/graphs/prt.json");
    nlohmann::ordered_json graph = nlohmann::ordered_json::parse(file);
    graph["name"] = "a \"name\" with \\ and \n";
    std::ofstream(folder.path("named.json")) << graph;
    const std::string path = folder.path("trace.json");
    const CommandRun run = render(folder.path("named.json"), path);
    ASSERT_EQ(run.code, kOk) << run.err;
    EXPECT_EQ(traceOf(path)["traceEvents"][0]["args"]["name"], "hone a \"name\" with \\ and \n");
}

TEST_F(Trace, RefusesAFileThatCannotBeWrittenBeforeRendering) {
    EXPECT_EQ(render("prt", "/proc/trace.json").code, kNotWritten);
    EXPECT_FALSE(std::filesystem::exists(folder.path("out/prt.exr")));
}

} // namespace
} // namespace hone::cli

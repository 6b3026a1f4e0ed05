// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/cli/command_run.h"

#include "hone/cli/commands.h"
#include "hone/core/image/image.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

namespace hone::cli {
namespace {

const nlohmann::json& fitOf(const nlohmann::json& report, const std::string& method) {
    for (const nlohmann::json& fit : report["fits"])
        if (fit["method"] == method)
            return fit;
    throw std::logic_error("no fit " + method);
}

nlohmann::json shippedGraph(const std::string& name) {
    return nlohmann::json::parse(std::ifstream(HONE_SOURCE_DIR "/graphs/" + name));
}

class Fit : public testing::Test {
protected:
    void SetUp() override {
        if (!whyNoRaster().empty())
            GTEST_SKIP() << whyNoRaster();
    }

    static CommandRun run(std::vector<std::string> more) {
        std::vector<std::string> arguments{"fit", "sir",    "--scene", "builtin:cornell", "--views",
                                           "4",   "--size", "64x48",   "--json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return runHone(arguments);
    }
};

TEST_F(Fit, FindsWeightsNoWorseThanTheRandomSearchDoes) {
    const CommandRun fitted = run({});
    ASSERT_EQ(fitted.code, kOk) << fitted.err;
    const nlohmann::json report = fitted.json();
    EXPECT_EQ(report["pass"], "combine");
    EXPECT_EQ(report["metrics"], (std::vector<std::string>{"shadow.error", "reflection.error"}));
    EXPECT_EQ(report["views"]["train"].size(), 3u);
    EXPECT_EQ(report["views"]["held_out"].size(), 1u);
    const nlohmann::json& best = fitOf(report, "nnls");
    for (const char* other : {"graph", "mean", "random"})
        EXPECT_LE(best["j_train"], fitOf(report, other)["j_train"]) << other;
    EXPECT_LE(best["optimality_residual"], 1e-9);
    EXPECT_EQ(fitOf(report, "graph")["weights"].size(), 2u);
}

TEST_F(Fit, WritesAGraphThatRendersWithItsWeights) {
    const TemporaryFolder folder;
    const std::string path = folder.path("fitted.json");
    const CommandRun fitted = run({"-o", path});
    ASSERT_EQ(fitted.code, kOk) << fitted.err;
    const nlohmann::json report = fitted.json();

    const nlohmann::json graph = nlohmann::json::parse(std::ifstream(path));
    EXPECT_EQ(graph["passes"]["combine"]["params"]["mode"], "linear");
    for (const int k : {0, 1})
        EXPECT_FLOAT_EQ(graph["passes"]["combine"]["in"]["errors"][k]["weight"].get<float>(),
                        fitOf(report, "nnls")["weights"][k].get<float>());
    const CommandRun rendered = runHone({"render", path, "--scene", "builtin:cornell", "--size",
                                         "32x24", "-q", "-o", folder.path()});
    EXPECT_EQ(rendered.code, kOk) << rendered.err;

    // The file's weights are now those of the fit.
    const CommandRun again = runHone(
        {"fit", path, "--scene", "builtin:cornell", "--views", "4", "--size", "64x48", "--json"});
    ASSERT_EQ(again.code, kOk) << again.err;
    EXPECT_NEAR(fitOf(again.json(), "graph")["j_train"].get<double>(),
                fitOf(report, "nnls")["j_train"].get<double>(), 1e-5);
}

// Of combiners, one of which takes in the other, the last is fitted; of two others, neither.
TEST_F(Fit, FitsTheLastCombiner) {
    nlohmann::json graph = shippedGraph("sir.json");
    nlohmann::json& passes = graph["passes"];
    const nlohmann::json& edges = passes["combine"]["in"]["errors"];
    passes["mirrors"] = {{"type", "combine"}, {"in", {{"errors", {edges[1]}}}}};
    const TemporaryFolder folder;
    const auto fitted = [&] {
        return runHone({"fit", folder.write("two.json", graph.dump()), "--scene", "builtin:cornell",
                        "--size", "16x16", "--json"});
    };
    const CommandRun undecided = fitted();
    EXPECT_EQ(undecided.code, kBadInput);
    EXPECT_NE(undecided.err.find("which pass of type combine"), std::string::npos) << undecided.err;

    passes["combine"]["in"]["errors"][1] = "mirrors.error";
    const CommandRun last = fitted();
    ASSERT_EQ(last.code, kOk) << last.err;
    EXPECT_EQ(last.json()["pass"], "combine");
    EXPECT_EQ(last.json()["metrics"], (std::vector<std::string>{"shadow.error", "mirrors.error"}));
}

// A part of a graph lies beside it; elsewhere the fitted graph would not find it.
TEST_F(Fit, WritesAGraphWithPartsOnlyBesideThem) {
    const TemporaryFolder folder;
    (void)folder.write("shade.json", R"({ "hone": 2, "inputs": { "color": "Radiance" },
        "passes": { "tone": { "type": "tonemap", "in": { "color": "$color" } } },
        "outputs": { "display": "tone.display" } })");
    nlohmann::json graph = shippedGraph("sir.json");
    graph["passes"]["shade"] = {{"graph", "shade.json"}, {"in", {{"color", "raster.color"}}}};
    graph["outputs"]["shaded"] = "shade.display";
    const std::string path = folder.write("whole.json", graph.dump());
    const auto fitted = [&](const std::string& output) {
        return runHone({"fit", path, "--scene", "builtin:cornell", "--views", "4", "--size",
                        "16x16", "-o", output});
    };
    const CommandRun elsewhere = fitted(folder.path("other/fitted.json"));
    EXPECT_EQ(elsewhere.code, kBadInput);
    EXPECT_NE(elsewhere.err.find("would not find \"shade.json\""), std::string::npos)
        << elsewhere.err;
    EXPECT_NE(elsewhere.err.find("-o " + folder.path("fitted.json")), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(folder.path("other")));

    const std::string beside = folder.path("other/../fitted.json");
    std::filesystem::create_directory(folder.path("other"));
    EXPECT_EQ(fitted(beside).code, kOk);
    const CommandRun checked = runHone({"check", beside});
    EXPECT_EQ(checked.code, kOk) << checked.err;
}

// The parameter was read for the mode alone; unread it would be an error.
TEST_F(Fit, DropsTheParameterThatChoseTheMode) {
    nlohmann::json graph = shippedGraph("sir.json");
    graph["params"]["mode"] = {
        {"type", "enum"}, {"choices", {"linear", "max"}}, {"default", "max"}};
    graph["passes"]["combine"]["params"]["mode"] = "$mode";
    const TemporaryFolder folder;
    const std::string fitted = folder.path("fitted.json");
    const CommandRun run =
        runHone({"fit", folder.write("chosen.json", graph.dump()), "--scene", "builtin:cornell",
                 "--views", "4", "--size", "16x16", "-o", fitted});
    ASSERT_EQ(run.code, kOk) << run.err;
    const CommandRun checked = runHone({"check", fitted});
    EXPECT_EQ(checked.code, kOk) << checked.err;
    const nlohmann::json written = nlohmann::json::parse(std::ifstream(fitted));
    EXPECT_FALSE(written["params"].contains("mode"));
    EXPECT_TRUE(written["params"].contains("metric"));
}

// What a part gives is judged; its own combiner's weights are not this file's.
TEST_F(Fit, TakesMetricsThatAPartMakes) {
    const TemporaryFolder folder;
    (void)folder.write("both.json", R"({ "hone": 2, "inputs": { "a": "Error", "b": "Error" },
        "passes": { "join": { "type": "combine", "in": { "errors": ["$a", "$b"] } } },
        "outputs": { "error": "join.error", "handed": "$a" } })");
    nlohmann::json graph = shippedGraph("sir.json");
    nlohmann::json& passes = graph["passes"];
    passes["both"] = {{"graph", "both.json"},
                      {"in", {{"a", "shadow.error"}, {"b", "reflection.error"}}}};
    passes["combine"]["in"]["errors"] = {"both.error", "both.handed"};
    const auto fitted = [&] {
        return runHone({"fit", folder.write("whole.json", graph.dump()), "--scene",
                        "builtin:cornell", "--views", "4", "--size", "16x16", "--json"});
    };
    const CommandRun run = fitted();
    ASSERT_EQ(run.code, kOk) << run.err;
    EXPECT_EQ(run.json()["metrics"], (std::vector<std::string>{"both.join.error", "shadow.error"}));

    // The last frame's error has no truth to be judged by.
    passes["combine"]["in"]["errors"] = {
        "both.error", {{"from", "shadow.error@-1"}, {"initial", "shadow.error"}}};
    const CommandRun of_last_frame = fitted();
    EXPECT_EQ(of_last_frame.code, kBadInput);
    EXPECT_NE(of_last_frame.err.find("\"shadow.error@-1\", whose weight cannot be fitted"),
              std::string::npos)
        << of_last_frame.err;

    passes["combine"] = {{"graph", "both.json"}, {"in", passes["both"]["in"]}};
    passes.erase("both");
    const CommandRun no_combiner = fitted();
    EXPECT_EQ(no_combiner.code, kBadInput);
    EXPECT_NE(no_combiner.err.find("no pass of type combine"), std::string::npos)
        << no_combiner.err;
    const CommandRun measured = runHone({"measure", folder.path("whole.json"), "--scene",
                                         "builtin:cornell", "--views", "1", "--size", "16x16"});
    EXPECT_EQ(measured.code, kOk) << measured.err;
    EXPECT_NE(measured.out.find("combine.join.error"), std::string::npos) << measured.out;
}

TEST_F(Fit, SaysWhyItCannotFit) {
    const CommandRun too_few = run({"--views", "3"});
    EXPECT_NE(too_few.code, kOk);
    const CommandRun no_combiner =
        runHone({"fit", "oracle", "--scene", "builtin:cornell", "--size", "16x16"});
    EXPECT_EQ(no_combiner.code, kBadInput);
    EXPECT_NE(no_combiner.err.find("no pass of type combine"), std::string::npos)
        << no_combiner.err;
}

TEST_F(Fit, Figure10ShowsEveryModeOfTheCombiner) {
    const TemporaryFolder folder;
    const CommandRun run = runHone({"bench", "figure10", "--scene", "builtin:cornell", "--size",
                                    "48x32", "-o", folder.path(), "--json"});
    ASSERT_EQ(run.code, kOk) << run.err;
    const nlohmann::json report = run.json();
    std::set<std::string> modes;
    for (const nlohmann::json& row : report["rows"]) {
        modes.insert(row["mode"]);
        EXPECT_GE(row["rmse"], row["mae"]); // by Jensen's inequality
    }
    EXPECT_TRUE(modes.contains("mean") && modes.contains("linear") && modes.contains("max"));
    const auto rows = static_cast<uint>(modes.size());
    EXPECT_EQ(readRgb(folder.path("figure10.png")).extent,
              uvec2(3 * 48 + 8, rows * 32 + (rows - 1) * 4));
    EXPECT_TRUE(std::filesystem::exists(folder.path("figure10.html")));
}

} // namespace
} // namespace hone::cli

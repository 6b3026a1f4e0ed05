// SPDX-License-Identifier: Apache-2.0
//
// Graphs that are used as passes of others.
#include "hone/core/error.h"
#include "hone/tests/support/graph_fixture.h"
#include "hone/tests/support/temporary_folder.h"

#include <algorithm>
#include <map>

namespace hone {
namespace {

/// Graphs that name files of a folder in memory.
class SubgraphTest : public GraphTest {
protected:
    CompiledGraph planWith(const std::string& text, const Overrides& overrides = {}) {
        std::vector<Diagnostic> diagnostics;
        const GraphDesc desc = parseGraph("test.json", text, diagnostics, read);
        CompiledGraph graph = compile(desc, catalog.catalog(), overrides, diagnostics);
        EXPECT_TRUE(diagnostics.empty()) << format(diagnostics);
        return graph;
    }
    float redOf(CompiledGraph graph) {
        auto executor = start(std::move(graph));
        executor->run();
        return executor->output("color").as<vec3>()[0].x;
    }

    const ReadFile read = [this](const std::string& path) -> std::optional<std::string> {
        const auto found = files.find(path);
        return found != files.end() ? std::optional(found->second) : std::nullopt;
    };
    std::map<std::string, std::string> files{{"add.json", R"({
            "hone": 2,
            "params": { "amount": { "type": "float", "default": 1 } },
            "inputs": { "color": "Radiance" },
            "passes": {
              "add": { "type": "add", "in": { "color": "$color" }, "params": { "amount": "$amount" } }
            },
            "outputs": { "color": "add.result" } })"},
                                             {"deep/twice.json", R"({
            "hone": 2,
            "params": { "each": { "type": "float", "default": 2 } },
            "inputs": { "in": "Radiance" },
            "passes": {
              "first": { "graph": "../add.json", "in": { "color": "$in" }, "params": { "amount": "$each" } },
              "second": { "graph": "../add.json", "in": { "color": "first.color" }, "params": { "amount": 100 } }
            },
            "outputs": { "out": "second.color", "same": "$in" } })"}};

    const std::string outer = R"({
        "hone": 2,
        "params": { "step": { "type": "float", "default": 3 } },
        "inputs": { "scene": "scene", "camera": "camera" },
        "passes": {
          "raster": { "type": "raster", "in": { "scene": "$scene", "camera": "$camera" } },
          "part": { "graph": "deep/twice.json", "in": { "in": "raster.color" }, "params": { "each": "$step" } }
        },
        "outputs": { "color": "part.out", "same": "part.same" } })";
};

TEST_F(SubgraphTest, IsWiredThroughItsBorderAtEveryDepth) {
    EXPECT_EQ(redOf(planWith(outer)), 10 + 3 + 100); // the camera's x, $step, the literal
}

TEST_F(SubgraphTest, HasNodesNamedByTheirPath) {
    const CompiledGraph graph = planWith(outer);
    EXPECT_NE(graph.findNode("part.first.add"), nullptr);
    EXPECT_NE(graph.findValue("part.second.add.result"), kNoId);
}

TEST_F(SubgraphTest, HandsAnInputStraightOn) {
    auto executor = start(planWith(outer));
    executor->run();
    EXPECT_EQ(executor->output("same").as<vec3>()[0].x, 10);
}

TEST_F(SubgraphTest, TakesParametersFromOutsideAndFromTheCommandLine) {
    EXPECT_EQ(redOf(planWith(outer, {{"step", "7"}})), 10 + 7 + 100);
    EXPECT_EQ(redOf(planWith(outer, {{"part.each", "8"}})), 10 + 8 + 100);
    EXPECT_EQ(redOf(planWith(outer, {{"step", "7"}, {"part.each", "8"}})), 10 + 8 + 100);
    EXPECT_EQ(redOf(planWith(outer, {{"part.second.amount", "0"}})), 10 + 3 + 0);
    EXPECT_EQ(redOf(planWith(outer, {{"part.first.add.amount", "1"}, {"step", "9"}})),
              10 + 1 + 100);
}

TEST_F(SubgraphTest, FollowsParametersThatAreSetLater) {
    auto executor = start(planWith(outer));
    executor->setParameter("step", "5");
    executor->run();
    EXPECT_EQ(executor->output("color").as<vec3>()[0].x, 10 + 5 + 100);
    executor->setParameter("part.each", "6");
    executor->setParameter("step", "1"); // has no say any more
    executor->run();
    EXPECT_EQ(executor->output("color").as<vec3>()[0].x, 10 + 6 + 100);
}

TEST_F(SubgraphTest, RunsInsideLoops) {
    EXPECT_EQ(redOf(planWith(R"({
        "hone": 2,
        "inputs": { "scene": "scene", "camera": "camera" },
        "passes": {
          "raster": { "type": "raster", "in": { "scene": "$scene", "camera": "$camera" } },
          "repeat": { "loop": {
            "carry": { "image": "raster.color" },
            "passes": { "part": { "graph": "add.json", "in": { "color": "~image" } } },
            "next": { "image": "part.color" },
            "stop": [ { "iterations": 4 } ] } }
        },
        "outputs": { "color": "repeat.image" } })")),
              10 + 4);
}

TEST_F(SubgraphTest, MayHoldLoopsWithNamesOfItsOwn) {
    files["loop.json"] = R"({
        "hone": 2,
        "params": { "times": { "type": "uint", "default": 2, "min": 1 } },
        "inputs": { "start": "Radiance" },
        "passes": {
          "repeat": { "loop": {
            "carry": { "image": "$start" },
            "passes": { "raster": { "type": "add", "in": { "color": "~image" } } },
            "next": { "image": "raster.result" },
            "stop": [ { "iterations": "$times" } ] } }
        },
        "outputs": { "image": "repeat.image", "curve": { "from": "repeat.stats", "type": "Curve" } } })";
    EXPECT_EQ(redOf(planWith(R"({
        "hone": 2,
        "inputs": { "scene": "scene", "camera": "camera" },
        "passes": {
          "raster": { "type": "raster", "in": { "scene": "$scene", "camera": "$camera" } },
          "a": { "graph": "loop.json", "in": { "start": "raster.color" } },
          "b": { "graph": "loop.json", "in": { "start": "a.image" }, "params": { "times": 5 } }
        },
        "outputs": { "color": "b.image", "curve": "b.curve" } })")),
              10 + 2 + 5);
}

TEST_F(SubgraphTest, IsCulledWithWhatNobodyNeeds) {
    const CompiledGraph graph = planWith(R"({
        "hone": 2,
        "inputs": { "scene": "scene", "camera": "camera" },
        "passes": {
          "raster": { "type": "raster", "in": { "scene": "$scene", "camera": "$camera" } },
          "part": { "graph": "add.json", "in": { "color": "raster.color" } }
        },
        "outputs": { "color": "raster.color" } })");
    EXPECT_FALSE(graph.findNode("part.add")->culled.empty());
}

TEST_F(SubgraphTest, CanBeCheckedAloneButNotRun) {
    std::vector<Diagnostic> diagnostics;
    const GraphDesc desc = parseGraph("add.json", files["add.json"], diagnostics);
    CompiledGraph graph = compile(desc, catalog.catalog(), {}, diagnostics);
    EXPECT_TRUE(diagnostics.empty()) << format(diagnostics);
    try {
        (void)start(std::move(graph));
        FAIL() << "an input of type Radiance comes from nowhere";
    } catch (const GraphError& error) {
        EXPECT_NE(std::string(error.what()).find("\"color\" of type Radiance"), std::string::npos)
            << error.what();
    }
}

TEST_F(SubgraphTest, DoesNotGrowWithoutBound) {
    // Thirteen files, each of which uses the next twice: 2^13 passes.
    for (int i = 0; i < 13; ++i) {
        const std::string next = "\"f" + std::to_string(i + 1) + ".json\"";
        files["f" + std::to_string(i) + ".json"] =
            R"({ "hone": 2, "inputs": { "color": "Radiance" }, "passes": { "a": { "graph": )" +
            next + R"(, "in": { "color": "$color" } }, "b": { "graph": )" + next +
            R"(, "in": { "color": "a.color" } } }, "outputs": { "color": "b.color" } })";
    }
    files["f13.json"] = files["add.json"];
    std::vector<Diagnostic> diagnostics;
    const GraphDesc desc =
        parseGraph("f0.json", files["f0.json"], diagnostics,
                   [this](const std::string& path) { return std::optional(files.at(path)); });
    (void)compile(desc, catalog.catalog(), {}, diagnostics);
    ASSERT_FALSE(diagnostics.empty());
    EXPECT_TRUE(
        std::ranges::any_of(diagnostics, [](const Diagnostic& d) { return d.code == "E0104"; }));
}

TEST_F(SubgraphTest, NamesItsOutputsAsItsUserDoes) {
    const CompiledGraph graph = planWith(outer);
    EXPECT_EQ(graph.findValue("part.out"), graph.findValue("part.second.add.result"));
    EXPECT_EQ(graph.findValue("part.second.color"), graph.findValue("part.second.add.result"));
    EXPECT_EQ(graph.findValue("part.same"), graph.findValue("raster.color"));
    EXPECT_EQ(graph.findValue("part.add"), kNoId);
    EXPECT_EQ(graph.findNode("raster")->graph, kNoId);
    const PlannedGraph& second = graph.graphs.at(graph.findNode("part.second.add")->graph);
    EXPECT_EQ(second.name, "part.second");
    EXPECT_EQ(second.file, "../add.json");
    EXPECT_EQ(graph.graphs.at(second.graph).name, "part");
}

/// Two folders with files of the same names, which add 1 or 100.
class ShippedFilesTest : public SubgraphTest {
protected:
    ShippedFilesTest() {
        for (const auto& [own, amount] : {std::pair(true, 1), std::pair(false, 100)}) {
            const std::string text = R"({ "hone": 2, "inputs": { "color": "Radiance" }, "passes": {
                "add": { "type": "add", "in": { "color": "$color" }, "params": { "amount": )" +
                                     std::to_string(amount) +
                                     R"( } } }, "outputs": { "color": "add.result" } })";
            if (own)
                files["add.json"] = text;
            else
                static_cast<void>(shipped.write("add.json", text));
        }
        static_cast<void>(shipped.write("user.json", R"({
            "hone": 2, "inputs": { "color": "Radiance" },
            "passes": { "part": { "graph": "add.json", "in": { "color": "$color" } } },
            "outputs": { "color": "part.color" } })"));
    }

    float redWith(const std::string& part) {
        std::vector<Diagnostic> diagnostics;
        const GraphDesc desc = parseGraph("test.json", R"({
            "hone": 2, "inputs": { "scene": "scene", "camera": "camera" },
            "passes": {
              "raster": { "type": "raster", "in": { "scene": "$scene", "camera": "$camera" } },
              "part": { "graph": ")" + part + R"(", "in": { "color": "raster.color" } }
            },
            "outputs": { "color": "part.color" } })",
                                          diagnostics, read, shipped.path(""));
        CompiledGraph graph = compile(desc, catalog.catalog(), {}, diagnostics);
        EXPECT_TRUE(diagnostics.empty()) << format(diagnostics);
        return redOf(std::move(graph));
    }

    test::TemporaryFolder shipped;
};

TEST_F(ShippedFilesTest, AreTakenWhereAFileIsNotBesideTheGraph) {
    const float added = redWith("add.json");
    files.erase("add.json");
    EXPECT_EQ(redWith("add.json"), added + 99);
}

TEST_F(ShippedFilesTest, NeverSeeThoseBesideTheGraph) {
    EXPECT_EQ(redWith("user.json"), redWith("add.json") + 99);
}

TEST_F(SubgraphTest, ReadsNoFileOfAnotherFolderThroughALink) {
    const ReadFile read = filesBeside(std::string(HONE_SOURCE_DIR) + "/graphs/sir.json");
    EXPECT_TRUE(read("prt.json").has_value());
    EXPECT_FALSE(read("../README.md").has_value());
    EXPECT_FALSE(read("no_such.json").has_value());
    EXPECT_FALSE(read(".").has_value());
}

} // namespace
} // namespace hone

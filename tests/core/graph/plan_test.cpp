// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/support/graph_fixture.h"

#include <chrono>

namespace hone {
namespace {

class Plan : public GraphTest, public testing::WithParamInterface<const char*> {};

TEST_P(Plan, IsAsWrittenDown) {
    const std::string name = GetParam();
    EXPECT_EQ(dump(plan(planFile(name + ".json"))), planFile(name + ".plan"));
}

INSTANTIATE_TEST_SUITE_P(All, Plan,
                         testing::Values("refinement", "shared_memory", "nested_loops",
                                         "last_frame"),
                         [](const auto& test) { return std::string(test.param); });

class PlanTest : public GraphTest {};

TEST_F(PlanTest, KeepsTheFilesOrderWhereNothingElseDecides) {
    const CompiledGraph graph =
        plan(R"({ "hone": 1, "inputs": { "camera": "camera", "scene": "scene" },
        "passes": {
            "z": { "type": "add", "in": { "color": "r.color" } },
            "r": { "type": "raster", "in": { "scene": "$scene", "camera": "$camera" } },
            "a": { "type": "add", "in": { "color": "r.color" } },
            "m": { "type": "mix", "in": { "a": "a.result", "b": "z.result" } } },
        "outputs": { "color": "m.color" } })");
    std::vector<std::string> order;
    for (const NodeId id : graph.order)
        order.push_back(graph.nodes[id].name);
    EXPECT_EQ(order, (std::vector<std::string>{"r", "z", "a", "m"}));
}

TEST_F(PlanTest, GivesParametersFromFileGraphAndOverridesInThisOrder) {
    const std::string text = planFile("refinement.json");
    EXPECT_EQ(plan(text).findNode("refine.request")->params.get<uint>("batch"), 4u);
    EXPECT_EQ(plan(text, {{"batch", "7"}}).findNode("refine.request")->params.get<uint>("batch"),
              7u);
    EXPECT_EQ(plan(text, {{"refine.request.batch", "9"}, {"batch", "7"}})
                  .findNode("refine.request")
                  ->params.get<uint>("batch"),
              9u);
}

TEST_F(PlanTest, GivesEdgesTheirOwnParametersAndDefaults) {
    const CompiledGraph graph = plan(planFile("refinement.json"));
    const PlannedNode& combine = *graph.findNode("combine");
    ASSERT_EQ(combine.inputs.size(), 2u);
    EXPECT_EQ(std::get<float>(combine.inputs[0].params[0]), 0.5f);
    EXPECT_EQ(std::get<float>(combine.inputs[1].params[0]), 1.0f);
}

TEST_F(PlanTest, CopiesBeforeUpdatingWhatAnotherInputOfTheSamePassReads) {
    const CompiledGraph graph =
        plan(R"({ "hone": 1, "inputs": { "camera": "camera", "scene": "scene" },
        "passes": {
            "r": { "type": "raster", "in": { "scene": "$scene", "camera": "$camera" } },
            "l": { "loop": { "carry": { "x": "r.color" },
                "passes": { "b": { "type": "bump", "in": { "color": "~x" } },
                            "m": { "type": "mix", "in": { "a": "b.result", "b": "~x" } } },
                "next": { "x": "m.color" }, "stop": [ { "iterations": 2 } ] } } },
        "outputs": { "color": "l.x" } })");
    EXPECT_EQ(graph.findNode("l.b")->outputs[0].in_place, InPlace::kCopies);
}

TEST_F(PlanTest, UpdatesTheCarriedValueInPlaceWhenNothingReadsItLater) {
    const CompiledGraph graph = plan(planFile("refinement.json"));
    EXPECT_EQ(graph.findNode("refine.blend")->outputs[0].in_place, InPlace::kTakesOver);
    EXPECT_EQ(graph.loops[0].carries[0].next_by, NextBy::kInPlace);
}

TEST_F(PlanTest, TakesFarLessThanFiftyMillisecondsForTwoHundredPasses) {
    std::string text =
        R"({ "hone": 1, "inputs": { "camera": "camera", "scene": "scene" }, "passes": {
        "p0": { "type": "raster", "in": { "scene": "$scene", "camera": "$camera" } },
        "p1": { "type": "add", "in": { "color": "p0.color" } })";
    for (int i = 2; i < 200; ++i)
        text += ",\n\"p" + std::to_string(i) + R"(": { "type": "mix", "in": { "a": "p)" +
                std::to_string(i - 1) + (i == 2 ? ".result" : ".color") +
                R"(", "b": "p0.color" } })";
    text += R"( }, "outputs": { "color": "p199.color" } })";
    double best = 1e9;
    for (int i = 0; i < 3; ++i) {
        const auto begin = std::chrono::steady_clock::now();
        const CompiledGraph graph = plan(text);
        EXPECT_EQ(graph.order.size(), 200u);
        best = std::min(best, std::chrono::duration<double, std::milli>(
                                  std::chrono::steady_clock::now() - begin)
                                  .count());
    }
    RecordProperty("milliseconds", std::to_string(best));
    EXPECT_LT(best, 50.0);
}

} // namespace
} // namespace hone

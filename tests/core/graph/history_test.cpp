// SPDX-License-Identifier: Apache-2.0
//
// Values of the last frame ("pass.port@-1").
#include "hone/tests/support/graph_fixture.h"

namespace hone {
namespace {

class HistoryTest : public GraphTest {
protected:
    /// Sums the camera's x (10) over the frames, from `initial` on.
    static std::string sum(const std::string& initial) {
        return R"({ "hone": 2,
            "inputs": { "scene": "scene", "camera": "camera" },
            "passes": {
              "raster": { "type": "raster", "in": { "scene": "$scene", "camera": "$camera" } },
              "start": { "type": "add", "in": { "color": "raster.color" }, "params": { "amount": 100 } },
              "sum": { "type": "mix", "in": { "a": "raster.color",
                       "b": { "from": "sum.color@-1", "initial": )" +
               initial + R"( } } }
            },
            "outputs": { "color": "sum.color" } })";
    }
    static float frame(Executor& executor) {
        executor.run();
        return executor.output("color").as<vec3>()[3].x;
    }
};

TEST_F(HistoryTest, BeginsWithZeroesAndFollowsItsSource) {
    auto executor = start(sum(R"({ "zero": "Radiance" })"));
    EXPECT_EQ(frame(*executor), 10);
    EXPECT_EQ(frame(*executor), 20);
    EXPECT_EQ(frame(*executor), 30);
}

TEST_F(HistoryTest, BeginsWithAnotherValue) {
    auto executor = start(sum("\"start.result\""));
    EXPECT_EQ(frame(*executor), 10 + 110);
    EXPECT_EQ(frame(*executor), 10 + 120);
}

TEST_F(HistoryTest, SeesTheFrameBeforeNotThisOne) {
    auto executor = start(sum(R"({ "zero": "Radiance" })"));
    EXPECT_EQ(frame(*executor), 10);
    camera.position = {1, 0, 0};
    executor->setCamera(camera);
    EXPECT_EQ(frame(*executor), 11);
}

TEST_F(HistoryTest, BeginsAnewWithAnotherExtentAndWhenTold) {
    auto executor = start(sum(R"({ "zero": "Radiance" })"));
    EXPECT_EQ(frame(*executor), 10);
    EXPECT_EQ(frame(*executor), 20);
    executor->setExtent({3, 3});
    EXPECT_EQ(frame(*executor), 10);
    EXPECT_EQ(frame(*executor), 20);
    executor->resetHistory();
    EXPECT_EQ(frame(*executor), 10);
}

TEST_F(HistoryTest, MayFeedALoopThatItFollows) {
    // Each frame goes on where the last one ended: 4 iterations of + 1 on top of the camera's x.
    auto executor = start(R"({ "hone": 2,
        "inputs": { "scene": "scene", "camera": "camera" },
        "passes": {
          "raster": { "type": "raster", "in": { "scene": "$scene", "camera": "$camera" } },
          "repeat": { "loop": {
            "carry": { "image": { "from": "repeat.image@-1", "initial": "raster.color" } },
            "passes": { "add": { "type": "add", "in": { "color": "~image" } } },
            "next": { "image": "add.result" },
            "stop": [ { "iterations": 4 } ] } }
        },
        "outputs": { "color": "repeat.image" } })");
    EXPECT_EQ(frame(*executor), 14);
    EXPECT_EQ(frame(*executor), 18);
    EXPECT_EQ(frame(*executor), 22);
}

TEST_F(HistoryTest, IsReadInsideALoopFromOutside) {
    // Frame 1: 10 + 3 * 0; frame 2: 10 + 3 * 10.
    auto executor = start(R"({ "hone": 2,
        "inputs": { "scene": "scene", "camera": "camera" },
        "passes": {
          "raster": { "type": "raster", "in": { "scene": "$scene", "camera": "$camera" } },
          "repeat": { "loop": {
            "carry": { "image": "raster.color" },
            "passes": { "mix": { "type": "mix", "in": { "a": "~image",
                        "b": { "from": "raster.color@-1", "initial": { "zero": "Radiance" } } } } },
            "next": { "image": "mix.color" },
            "stop": [ { "iterations": 3 } ] } }
        },
        "outputs": { "color": "repeat.image" } })");
    EXPECT_EQ(frame(*executor), 10);
    EXPECT_EQ(frame(*executor), 40);
}

TEST_F(HistoryTest, KeepsWhatItFollowsFromBeingCulledOrShared) {
    const CompiledGraph graph = plan(sum(R"({ "zero": "Radiance" })"));
    const PlannedHistory& history = graph.histories.at(0);
    EXPECT_EQ(graph.values[history.value].name, "sum.color@-1");
    EXPECT_EQ(graph.nodes[history.begins_at].name, "sum");
    const std::uint32_t memory = graph.values[history.value].memory;
    EXPECT_EQ(graph.memories.at(memory).values.size(), 1u);
    EXPECT_NE(dump(graph).find("sum.color -> sum.color@-1 at the end of each frame"),
              std::string::npos)
        << dump(graph);
}

TEST_F(HistoryTest, CostsNothingWhereNobodyReadsIt) {
    std::string text = sum(R"({ "zero": "Radiance" })");
    text.replace(text.find("\"color\": \"sum.color\""), 20, "\"color\": \"raster.color\"");
    const CompiledGraph graph = plan(text);
    EXPECT_FALSE(graph.findNode("sum")->culled.empty());
    EXPECT_EQ(graph.histories.at(0).begins_at, kNoId);
}

} // namespace
} // namespace hone

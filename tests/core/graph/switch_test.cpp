// SPDX-License-Identifier: Apache-2.0
//
// when and bypass: passes that a parameter switches off.
#include "hone/core/error.h"
#include "hone/tests/support/graph_fixture.h"

namespace hone {
namespace {

class SwitchTest : public GraphTest {
protected:
    float redOf(const std::string& text, const Overrides& overrides = {}) {
        auto executor = start(text, overrides);
        executor->run();
        return executor->output("color").as<vec3>()[0].x;
    }
    static std::string graph(const std::string& passes, const std::string& output) {
        return R"({ "hone": 2,
            "params": {
              "fancy": { "type": "bool", "default": true },
              "mode": { "type": "enum", "choices": ["slow", "fast", "off"], "default": "slow" }
            },
            "inputs": { "scene": "scene", "camera": "camera" },
            "passes": {
              "raster": { "type": "raster", "in": { "scene": "$scene", "camera": "$camera" } },
              "mode": { "type": "add", "when": { "$mode": ["slow", "fast"] }, "in": { "color": "raster.color" },
                        "params": { "amount": 0 }, "bypass": { "result": "raster.color" } },
              )" +
               passes + R"( }, "outputs": { "color": ")" + output +
               R"(", "mode": "mode.result", "off": "only_off.result" } })";
    }
    const std::string only_off =
        R"("only_off": { "type": "add", "when": "!$fancy", "in": { "color": "mode.result" },
                         "bypass": { "result": "mode.result" } })";
    const std::string chain = graph(
        R"("a": { "type": "add", "when": "$fancy", "in": { "color": "raster.color" },
                  "params": { "amount": 1 }, "bypass": { "result": "raster.color" } },
           "b": { "type": "add", "when": "$fancy", "in": { "color": "a.result" },
                  "params": { "amount": 10 }, "bypass": { "result": "a.result" } },)" +
            only_off,
        "b.result");
};

TEST_F(SwitchTest, PutsTheBypassInItsPlace) {
    EXPECT_EQ(redOf(chain), 10 + 1 + 10);
    EXPECT_EQ(redOf(chain, {{"fancy", "false"}}), 10) << "both stand aside";
}

TEST_F(SwitchTest, SaysWhyAPassIsOff) {
    const CompiledGraph off = plan(chain, {{"fancy", "false"}, {"mode", "off"}});
    EXPECT_EQ(off.findNode("a")->culled, "switched off: fancy is false");
    EXPECT_EQ(off.findNode("mode")->culled, "switched off: mode is off");
    EXPECT_EQ(off.findNode("only_off")->culled, "");
    EXPECT_EQ(plan(chain).findNode("only_off")->culled, "switched off: fancy is true");
}

TEST_F(SwitchTest, IsOnForEachOfItsChoices) {
    for (const char* on : {"slow", "fast"})
        EXPECT_EQ(plan(chain, {{"mode", on}}).findNode("mode")->culled, "") << on;
}

TEST_F(SwitchTest, TakesAnEdgeOutOfAList) {
    const std::string text = R"({ "hone": 2,
        "params": { "first": { "type": "bool", "default": true }, "second": { "type": "bool", "default": true } },
        "inputs": { "scene": "scene", "camera": "camera" },
        "passes": {
          "raster": { "type": "raster", "in": { "scene": "$scene", "camera": "$camera" } },
          "a": { "type": "error.a", "when": "$first", "in": { "depth": "raster.depth" }, "params": { "scale": 1 } },
          "b": { "type": "error.a", "when": "$second", "in": { "depth": "raster.depth" }, "params": { "scale": 3 } },
          "combine": { "type": "combine", "in": { "errors": [ { "from": "a.error", "weight": 1 },
                                                              { "from": "b.error", "weight": 2 } ] } }
        },
        "outputs": { "error": "combine.error" } })";
    const auto first = [&](const Overrides& overrides) {
        auto executor = start(text, overrides);
        executor->run();
        return executor->output("error").as<vec2>()[0].x;
    };
    EXPECT_EQ(first({}), 1 * 1 + 2 * 3);
    EXPECT_EQ(first({{"first", "false"}}), 2 * 3) << "the weight stays with its edge";
    EXPECT_EQ(first({{"second", "false"}}), 1 * 1);
}

TEST_F(SwitchTest, NeedsNoBypassWhereTheReaderGoesWithIt) {
    const std::string text = graph(
        R"("a": { "type": "add", "when": "$fancy", "in": { "color": "raster.color" } },
           "b": { "type": "add", "when": "$fancy", "in": { "color": "a.result" },
                  "bypass": { "result": "raster.color" } },)" +
            only_off,
        "b.result");
    EXPECT_EQ(redOf(text), 10 + 1 + 1);
    EXPECT_EQ(redOf(text, {{"fancy", "false"}}), 10);
}

TEST_F(SwitchTest, SwitchesLoopsWithAllThatIsInThem) {
    const std::string text = graph(
        R"("repeat": { "when": "$fancy", "bypass": { "image": "raster.color" }, "loop": {
             "carry": { "image": "raster.color" },
             "passes": { "a": { "type": "add", "in": { "color": "~image" } } },
             "next": { "image": "a.result" },
             "stop": [ { "iterations": 3 } ] } },)" +
            only_off,
        "repeat.image");
    EXPECT_EQ(redOf(text), 10 + 3);
    EXPECT_EQ(redOf(text, {{"fancy", "false"}}), 10);
    EXPECT_EQ(plan(text, {{"fancy", "false"}}).findNode("repeat.a")->culled,
              "switched off: fancy is false");
}

TEST_F(SwitchTest, SwitchesPassesInsideALoop) {
    const std::string text = graph(
        R"("repeat": { "loop": {
             "carry": { "image": "raster.color" },
             "passes": {
               "a": { "type": "add", "when": "$fancy", "in": { "color": "~image" }, "bypass": { "result": "~image" } },
               "b": { "type": "add", "in": { "color": "a.result" }, "params": { "amount": 100 } } },
             "next": { "image": "b.result" },
             "stop": [ { "iterations": 3 } ] } },)" +
            only_off,
        "repeat.image");
    EXPECT_EQ(redOf(text), 10 + 303);
    EXPECT_EQ(redOf(text, {{"fancy", "false"}}), 10 + 300);
}

TEST_F(SwitchTest, RefusesToSwitchAGraphThatIsCompiled) {
    auto executor = start(chain);
    try {
        executor->setParameter("fancy", "false");
        FAIL() << "the passes are wired already";
    } catch (const GraphError& error) {
        EXPECT_NE(std::string(error.what()).find("E0511"), std::string::npos) << error.what();
    }
    executor->setParameter("fancy", "true"); // as it is: nothing to do
}

} // namespace
} // namespace hone

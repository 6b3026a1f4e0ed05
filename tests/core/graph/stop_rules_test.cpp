// SPDX-License-Identifier: Apache-2.0
//
// What ends a loop, and loops in loops.
#include "hone/tests/support/graph_fixture.h"

namespace hone {
namespace {

class StopRulesTest : public GraphTest {
protected:
    /// Adds -1 to the camera's x (10) in each iteration.
    static std::string countdown(const std::string& stop, const std::string& more = "") {
        return R"({ "hone": 2,
            "params": { "limit": { "type": "float", "default": 4, "min": 0 } },
            "inputs": { "scene": "scene", "camera": "camera" },
            "passes": {
              "raster": { "type": "raster", "in": { "scene": "$scene", "camera": "$camera" } },
              "repeat": { "loop": {
                "carry": { "image": "raster.color" },
                "passes": {
                  "add": { "type": "add", "in": { "color": "~image" }, "params": { "amount": -1 } },
                  "brightest": { "type": "brightest", "in": { "color": "add.result" } } },
                "next": { "image": "add.result" },
                "stop": [ )" +
               stop + R"(, { "iterations": 50 } ])" + more + R"( } }
            },
            "outputs": { "color": "repeat.image", "curve": "repeat.stats" } })";
    }
};

TEST_F(StopRulesTest, EndsOnceAScalarIsBelowItsLimit) {
    auto executor = start(countdown(R"({ "below": "$limit", "of": "brightest.value" })"));
    executor->run();
    EXPECT_EQ(executor->output("color").as<vec3>()[0].x, 3) << "the first that is below 4";
    const Curve& curve = *executor->output("curve").curve;
    EXPECT_EQ(curve.stop, "below");
    EXPECT_EQ(curve.records.size(), 7u);
    executor->setParameter("limit", "9.5");
    executor->run();
    EXPECT_EQ(executor->output("color").as<vec3>()[0].x, 9);
}

TEST_F(StopRulesTest, IgnoresALimitOfZero) {
    auto executor =
        start(countdown(R"({ "below": "$limit", "of": "brightest.value" })"), {{"limit", "0"}});
    executor->run();
    EXPECT_EQ(executor->output("curve").curve->stop, "iterations");
}

TEST_F(StopRulesTest, LooksAtBelowEverySoManyIterations) {
    auto executor = start(
        countdown(R"({ "below": "$limit", "of": "brightest.value" })", R"(, "check_every": 5)"));
    executor->run();
    EXPECT_EQ(executor->output("color").as<vec3>()[0].x, 0) << "iteration 10, not 7";
}

TEST_F(StopRulesTest, NestsLoops) {
    auto executor = start(R"({ "hone": 2,
        "inputs": { "scene": "scene", "camera": "camera" },
        "passes": {
          "raster": { "type": "raster", "in": { "scene": "$scene", "camera": "$camera" } },
          "outer": { "loop": {
            "carry": { "image": "raster.color" },
            "passes": {
              "inner": { "loop": {
                "carry": { "part": "~image" },
                "passes": { "add": { "type": "add", "in": { "color": "~part" } },
                            "twice": { "type": "mix", "in": { "a": "add.result", "b": "~image" } } },
                "next": { "part": "add.result" },
                "stop": [ { "iterations": 3 } ] } },
              "bump": { "type": "add", "in": { "color": "inner.part" }, "params": { "amount": 10 } } },
            "next": { "image": "bump.result" },
            "stop": [ { "iterations": 2 } ] } }
        },
        "outputs": { "color": "outer.image" } })");
    executor->run();
    EXPECT_EQ(executor->output("color").as<vec3>()[0].x, 10 + 2 * (3 + 10));
}

} // namespace
} // namespace hone

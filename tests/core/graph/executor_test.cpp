// SPDX-License-Identifier: Apache-2.0
#include "hone/core/device/recording_device.h"
#include "hone/core/error.h"
#include "hone/tests/support/graph_fixture.h"

#include <algorithm>
#include <utility>

namespace hone {
namespace {

std::vector<float> reds(const Value& value) {
    std::vector<float> result;
    for (const vec3& color : value.as<vec3>())
        result.push_back(color.x);
    return result;
}

std::vector<float> tenTimes(float number) {
    return std::vector<float>(10, number);
}

class ExecutorTest : public GraphTest {};

TEST_F(ExecutorTest, RefinesEveryPixelOnce) {
    const auto executor = start(planFile("refinement.json"));
    executor->run();
    EXPECT_EQ(reds(executor->output("color")), (std::vector<float>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
    EXPECT_EQ(reds(executor->output("before")), tenTimes(10));
}

TEST_F(ExecutorTest, TellsWhatALoopDidByIteration) {
    const auto executor = start(planFile("refinement.json"));
    executor->run();
    const Curve& curve = *executor->output("curve").curve;
    EXPECT_EQ(curve.stop, "empty");
    // 10 pixels in batches of 4; the fourth iteration finds nothing and is none.
    ASSERT_EQ(curve.records.size(), 3u);
    EXPECT_EQ(curve.records[0].pixels, 4u);
    EXPECT_EQ(curve.records[1].pixels, 8u);
    EXPECT_EQ(curve.records[2].pixels, 10u);
    EXPECT_EQ(curve.records[2].rays, 10u);
    EXPECT_EQ(curve.records[2].iteration, 3u);
    EXPECT_GE(curve.records[2].ms, curve.records[1].ms);
    EXPECT_EQ(executor->counters().get("rays.primary"), 10u);
}

TEST_F(ExecutorTest, RunsNothingAgainWhenNothingChanged) {
    const auto executor = start(planFile("refinement.json"));
    executor->run();
    const std::vector<NodeReport> before = executor->nodes();
    executor->setCamera(camera);
    executor->setExtent({5, 2});
    executor->setParameter("batch", "4");
    executor->run();
    const std::vector<NodeReport> after = executor->nodes();
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
        EXPECT_EQ(before[i].runs, after[i].runs) << before[i].name;
        EXPECT_EQ(after[i].ms, 0.0) << before[i].name;
    }
}

TEST_F(ExecutorTest, RunsPassesOutsideALoopOnceAndTheLoopsOwnInEachIteration) {
    const auto executor = start(planFile("refinement.json"));
    executor->run();
    EXPECT_EQ(runs(*executor, "raster"), 1u);
    EXPECT_EQ(runs(*executor, "sort"), 1u);
    EXPECT_EQ(runs(*executor, "refine"), 1u);
    EXPECT_EQ(runs(*executor, "refine.trace"), 4u);
    for (const NodeReport& report : executor->nodes())
        EXPECT_NE(report.name, "unused");
}

TEST_F(ExecutorTest, RunsAgainOnlyWhatDependsOnAPassParameter) {
    const auto executor = start(planFile("refinement.json"));
    executor->run();
    executor->setParameter("b.scale", "3");
    executor->run();
    EXPECT_EQ(runs(*executor, "raster"), 1u);
    EXPECT_EQ(runs(*executor, "a"), 1u);
    EXPECT_EQ(runs(*executor, "b"), 2u);
    EXPECT_EQ(runs(*executor, "combine"), 2u);
    // Pixel 0: 0.5 * 1 * 1 + 1 * 3 * 1.
    EXPECT_EQ(executor->find("combine.error")->as<vec2>()[0].x, 3.5f);
    EXPECT_EQ(runs(*executor, "refine"), 2u);
}

TEST_F(ExecutorTest, RunsOnlyTheLoopAgainForAParameterOfItsBody) {
    const auto executor = start(planFile("refinement.json"));
    executor->run();
    executor->setParameter("batch", "10");
    executor->run();
    EXPECT_EQ(runs(*executor, "sort"), 1u);
    EXPECT_EQ(executor->output("curve").curve->records.size(), 1u);
    EXPECT_EQ(reds(executor->output("color"))[9], 9.0f);
}

TEST_F(ExecutorTest, RunsAgainWhatReadsACamera) {
    const auto executor = start(R"({ "hone": 1, "inputs": { "camera": "camera", "scene": "scene" },
        "passes": {
            "r": { "type": "raster", "in": { "scene": "$scene", "camera": "$camera" } },
            "trace": { "type": "trace", "in": { "requests": "l.request.requests" } },
            "l": { "loop": { "carry": { "state": { "zero": "Cursor" } },
                "passes": { "request": { "type": "request", "in": { "order": "s.order", "state": "~state" } } },
                "next": { "state": "request.state" }, "stop": [ { "iterations": 1 } ] } },
            "e": { "type": "error.a", "in": { "depth": "r.depth" } },
            "s": { "type": "sort", "in": { "error": "e.error" } } },
        "outputs": { "color": "r.color", "samples": "trace.samples" } })");
    executor->run();
    camera.position.x = 20;
    executor->setCamera(camera);
    executor->run();
    EXPECT_EQ(runs(*executor, "r"), 2u);
    EXPECT_EQ(reds(executor->output("color")), tenTimes(20));
}

TEST_F(ExecutorTest, NoticesATouchedScene) {
    const auto executor = start(planFile("refinement.json"));
    executor->run();
    scene.version = 2;
    executor->run();
    EXPECT_EQ(runs(*executor, "raster"), 2u);
}

TEST_F(ExecutorTest, FollowsTheExtentUpAndDown) {
    const auto executor = start(planFile("refinement.json"));
    for (const uvec2 extent : {uvec2(3, 1), uvec2(7, 5), uvec2(1, 1)}) {
        executor->setExtent(extent);
        executor->run();
        const std::vector<float> image = reds(executor->output("color"));
        ASSERT_EQ(image.size(), extent.x * extent.y);
        for (std::size_t i = 0; i < image.size(); ++i)
            EXPECT_EQ(image[i], static_cast<float>(i));
        EXPECT_EQ(executor->output("color").extent, extent);
    }
}

TEST_F(ExecutorTest, SharesMemoryInsideALoopWithoutMixingValuesUp) {
    const auto executor = start(planFile("shared_memory.json"));
    executor->run();
    // x -> (x + 4) + 11, from 10: 25, 40, 55; b is x + 2 in the last iteration.
    EXPECT_EQ(reds(executor->output("color")), tenTimes(55));
    EXPECT_EQ(reds(executor->output("b")), tenTimes(42));
    EXPECT_EQ(runs(*executor, "repeat.constant"), 1u);
    EXPECT_EQ(runs(*executor, "repeat.last"), 3u);
    executor->setParameter("repeat.c.amount", "2");
    executor->run();
    EXPECT_EQ(reds(executor->output("color")), tenTimes(58));
    EXPECT_EQ(runs(*executor, "repeat.constant"), 1u);
}

TEST_F(ExecutorTest, FindsOnlyWhatIsStillThere) {
    const auto executor = start(planFile("shared_memory.json"));
    EXPECT_EQ(executor->find("repeat.image"), nullptr) << "not run yet";
    executor->run();
    EXPECT_NE(executor->find("repeat.image"), nullptr);
    EXPECT_EQ(reds(*executor->find("repeat.d.result")), tenTimes(44));
    EXPECT_EQ(executor->find("repeat.a.result"), nullptr) << "its memory went to c and d";
    EXPECT_EQ(executor->find("nothing.here"), nullptr);
}

TEST_F(ExecutorTest, NestsLoopsAndSwapsCarriedValues) {
    const auto executor = start(planFile("nested_loops.json"));
    executor->run();
    // Inner, from (u, 0), four times (x, y) -> (y, x + 1): (u + 2, 2). Outer: x -> (x + 1 + 2) + x,
    // from 10: 23, 49; one more after it.
    EXPECT_EQ(reds(executor->output("color")), tenTimes(50));
    EXPECT_EQ(reds(*executor->find("outer.image")), tenTimes(49));
    EXPECT_EQ(reds(executor->output("y")), tenTimes(2));
    EXPECT_EQ(runs(*executor, "outer.inner.add"), 8u);
    camera.position.x = 0;
    executor->setCamera(camera);
    executor->run();
    EXPECT_EQ(reds(executor->output("color")), tenTimes(10)); // 0, 3, 9
}

TEST_F(ExecutorTest, StopsByItsOwnRules) {
    const auto stop = [&](const std::string& rules) {
        std::string text = planFile("refinement.json");
        const std::string mark = "{ \"empty\": \"request.requests\" }, { \"ms\": \"$max_ms\" }";
        text.replace(text.find(mark), mark.size(), rules + R"({ "ms": "$max_ms" })");
        const auto executor = start(text);
        executor->run();
        const Curve& curve = *executor->output("curve").curve;
        return curve.stop + " " + std::to_string(curve.records.size());
    };
    EXPECT_EQ(stop(R"({ "rays": 5 }, )"), "rays 2");
    EXPECT_EQ(stop(R"({ "iterations": 2 }, { "rays": 5 }, )"), "iterations 2");
    EXPECT_EQ(stop(R"({ "ms": 1e-9 }, )"), "ms 1");
}

TEST_F(ExecutorTest, GoesOnWhereALimitOfTheRunCutTheLoop) {
    const auto executor = start(planFile("refinement.json"));
    executor->run({.max_iterations = 1});
    const Curve& curve = *executor->output("curve").curve;
    EXPECT_EQ(curve.stop, "iterations");
    // The order is from the last pixel to the first.
    EXPECT_EQ(reds(executor->output("color")),
              (std::vector<float>{10, 10, 10, 10, 10, 10, 6, 7, 8, 9}));
    executor->run({.max_rays = 4});
    EXPECT_EQ(curve.stop, "rays");
    EXPECT_EQ(curve.records.back().pixels, 8u);
    executor->run();
    EXPECT_EQ(curve.stop, "empty");
    EXPECT_EQ(curve.records.size(), 3u);
    EXPECT_EQ(runs(*executor, "raster"), 1u);
    EXPECT_EQ(reds(executor->output("color")), (std::vector<float>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

TEST_F(ExecutorTest, BeginsAnewWhenSomethingChangedAfterACut) {
    const auto executor = start(planFile("refinement.json"));
    executor->run({.max_iterations = 2});
    camera.position.x = 30;
    executor->setCamera(camera);
    executor->run({.max_iterations = 1});
    EXPECT_EQ(reds(executor->output("color")),
              (std::vector<float>{30, 30, 30, 30, 30, 30, 6, 7, 8, 9}));
}

TEST_F(ExecutorTest, StopsWhenTheCallbackSaysSo) {
    const auto executor = start(planFile("refinement.json"));
    std::vector<std::uint64_t> pixels;
    executor->run({.on_iteration = [&](const LoopRecord& record) {
        pixels.push_back(record.pixels);
        return record.iteration < 2;
    }});
    EXPECT_EQ(pixels, (std::vector<std::uint64_t>{4, 8}));
    EXPECT_EQ(executor->output("curve").curve->stop, "cancelled");
}

TEST_F(ExecutorTest, RefusesBadParametersAndKeepsTheOldOnes) {
    const auto executor = start(planFile("refinement.json"));
    EXPECT_THROW(executor->setParameter("batch", "0"), GraphError);
    EXPECT_THROW(executor->setParameter("batch", "many"), GraphError);
    EXPECT_THROW(executor->setParameter("refine.trace.backend", "embre"), GraphError);
    try {
        executor->setParameter("bach", "1");
        FAIL();
    } catch (const GraphError& error) {
        EXPECT_NE(std::string(error.what()).find("did you mean \"batch\"?"), std::string::npos)
            << error.what();
    }
    executor->run();
    EXPECT_EQ(executor->output("curve").curve->records.size(), 3u);
}

TEST_F(ExecutorTest, RefusesToTakeALoopsLastBoundAway) {
    std::string text = planFile("refinement.json");
    const std::string mark = "{ \"iterations\": 100000 }";
    text.replace(text.find(mark), mark.size(), R"({ "iterations": "$limit" })");
    text.replace(text.find("\"params\": {"), 11,
                 R"("params": { "limit": { "type": "uint", "default": 2 },)");
    const auto executor = start(text);
    EXPECT_THROW(executor->setParameter("limit", "0"), GraphError);
    executor->run();
    EXPECT_EQ(executor->output("curve").curve->stop, "iterations");
    executor->setParameter("limit", "1");
    executor->run();
    EXPECT_EQ(executor->output("curve").curve->records.size(), 1u);
}

TEST_F(ExecutorTest, SaysWhatIsMissingWithoutADevice) {
    const std::string text = R"({ "hone": 1, "inputs": { "camera": "camera" },
        "passes": { "draw": { "type": "draw", "in": { "camera": "$camera" } } },
        "outputs": { "depth": "draw.depth" } })";
    try {
        (void)start(text);
        FAIL();
    } catch (const DeviceError& error) {
        EXPECT_NE(std::string(error.what()).find("\"draw\""), std::string::npos);
    }
}

constexpr const char* kDrawThenHost = R"({ "hone": 1,
    "inputs": { "camera": "camera" },
    "passes": {
        "draw": { "type": "draw", "in": { "camera": "$camera" } },
        "e": { "type": "error.a", "in": { "depth": "draw.depth" } },
        "sort": { "type": "sort", "in": { "error": "e.error" } } },
    "outputs": { "order": "sort.order" } })";

TEST_F(ExecutorTest, RunsKernelsOnAHardwareDeviceAndWaitsBeforeTheHostReads) {
    RecordingDevice device;
    raster = &device;
    const auto executor = start(kDrawThenHost);
    executor->run();
    EXPECT_EQ(device.takeLines(),
              (std::vector<std::string>{"scope draw", "begin raster 5x2", "end raster",
                                        "copy image -> draw.depth 40", "end scope", "scope e",
                                        "dispatch error_a 10", "end scope", "finish"}));
    EXPECT_STREQ(executor->nodes()[1].where, "device");
    EXPECT_STREQ(executor->nodes()[2].where, "host");
}

TEST_F(ExecutorTest, RunsKernelsOnTheHostBesideASoftwareDevice) {
    RecordingDevice device(true);
    raster = &device;
    const auto executor = start(kDrawThenHost);
    executor->run();
    EXPECT_EQ(device.takeLines(),
              (std::vector<std::string>{"scope draw", "begin raster 5x2", "end raster",
                                        "copy image -> draw.depth 40", "end scope", "finish"}));
    EXPECT_STREQ(executor->nodes()[1].where, "host");
}

TEST_F(ExecutorTest, FollowsTheWishOfTheGraph) {
    RecordingDevice device(true);
    raster = &device;
    std::string text = kDrawThenHost;
    text.replace(text.find("\"error.a\""), 9, "\"error.a\", \"on\": \"device\"");
    const auto executor = start(text);
    executor->run();
    EXPECT_STREQ(executor->nodes()[1].where, "device");
    EXPECT_EQ(executor->find("e.error")->as<vec2>()[9].x, 10.0f);
}

TEST_F(ExecutorTest, CopiesOnTheDeviceWhereKernelsRunThere) {
    RecordingDevice device;
    raster = &device;
    const auto executor = start(planFile("nested_loops.json"));
    executor->run();
    EXPECT_EQ(reds(executor->output("color")), tenTimes(50));
}

TEST_F(ExecutorTest, GivesAllMemoryBack) {
    RecordingDevice device;
    raster = &device;
    {
        const auto executor = start(planFile("nested_loops.json"));
        executor->run();
        executor->setExtent({50, 20});
        executor->run();
        EXPECT_GT(device.buffersAlive(), 0u);
        EXPECT_GE(executor->bytesAllocated(), 8u * 12u * 1000u);
    }
    EXPECT_EQ(device.buffersAlive(), 0u);
}

struct FailsOnce final : RenderPass {
    void execute(PassContext& context) override {
        std::ranges::fill(context.out("depth").as<float>(), 5.0f);
        if (!std::exchange(has_failed, true))
            throw SceneError("not today");
    }
    bool has_failed = false;
};

TEST_F(ExecutorTest, RunsAPassAgainThatFailed) {
    catalog.passes.add(PassType("fails", "Fails once")
                           .in("camera", types::kCamera, "from where")
                           .out("depth", types::kDepth, "5")
                           .implementedBy<FailsOnce>(Domain::kHost));
    const auto executor = start(R"({ "hone": 1, "inputs": { "camera": "camera" },
        "passes": { "f": { "type": "fails", "in": { "camera": "$camera" } } },
        "outputs": { "depth": "f.depth" } })");
    EXPECT_THROW(executor->run(), SceneError);
    executor->run();
    EXPECT_EQ(executor->output("depth").as<float>()[0], 5.0f);
}

TEST_F(ExecutorTest, AsksForItsInputs) {
    Executor executor(plan(planFile("refinement.json")), catalog.catalog(), {host.get(), nullptr});
    EXPECT_THROW(executor.run(), std::logic_error);
    executor.setExtent({1, 1});
    EXPECT_THROW(executor.run(), std::logic_error);
    EXPECT_THROW((void)executor.output("colour"), std::logic_error);
}

} // namespace
} // namespace hone

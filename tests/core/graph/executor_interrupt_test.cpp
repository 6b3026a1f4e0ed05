// SPDX-License-Identifier: Apache-2.0
//
// Runs that end halfway, within an iteration and within a pass, and those that go on from there.
#include "hone/tests/support/graph_fixture.h"

#include <atomic>
#include <functional>

namespace hone {
namespace {

/// The test passes' trace, request by request: asks the interrupt after each, as long as there are
/// more.
struct PatientTrace final : RenderPass {
    void execute(PassContext& context) override {
        const std::span<uvec3> requests = context.in("requests").as<uvec3>();
        Value& samples = context.out("samples");
        if (!context.goes_on)
            done_ = 0;
        samples.count = static_cast<uint>(requests.size());
        while (done_ < requests.size()) {
            const uint pixel = requests[done_].x;
            samples.as<vec4>()[done_++] =
                vec4(static_cast<float>(pixel), 0.0f, 0.0f, glm::uintBitsToFloat(pixel));
            context.counters->add("rays.primary", 1);
            if (after_each)
                after_each();
            if (done_ < requests.size() && context.interrupt.isDue())
                throw Interrupted{};
        }
    }
    static std::function<void()> after_each;

private:
    std::size_t done_ = 0;
};
std::function<void()> PatientTrace::after_each;

/// color in place, + 1; gives up as soon as it may.
struct HastyBump final : RenderPass {
    void execute(PassContext& context) override {
        for (vec3& color : context.out("result").as<vec3>())
            color += 1.0f;
        if (context.interrupt.isDue())
            throw Interrupted{};
    }
};

/// color + 1 for one pixel after another, asking after each.
struct PatientAdd final : RenderPass {
    void execute(PassContext& context) override {
        const std::span<vec3> from = context.in("color").as<vec3>();
        const std::span<vec3> to = context.out("result").as<vec3>();
        for (done_ = context.goes_on ? done_ : 0; done_ < from.size();) {
            to[done_] = from[done_] + 1.0f;
            ++done_;
            if (done_ < from.size() && context.interrupt.isDue())
                throw Interrupted{};
        }
    }

private:
    std::size_t done_ = 0;
};

class ExecutorInterrupt : public GraphTest {
protected:
    ExecutorInterrupt() {
        catalog.passes.add(PassType("patient_trace", "Answers requests, one by one")
                               .in("requests", types::kRequestList, "requests")
                               .inOptional("scene", types::kScene, "what")
                               .out("samples", types::kSamples, "radiance = pixel",
                                    [](const SizeQuery& query) { return query.input("requests"); })
                               .implementedBy<PatientTrace>(Domain::kHost));
        catalog.passes.add(PassType("hasty_bump", "Adds 1 in place")
                               .in("color", types::kRadiance, "colour")
                               .outInPlace("result", types::kRadiance, "color", "color + 1")
                               .implementedBy<HastyBump>(Domain::kHost));
        catalog.passes.add(PassType("patient_add", "Adds 1")
                               .in("color", types::kRadiance, "colour")
                               .out("result", types::kRadiance, "color + 1")
                               .implementedBy<PatientAdd>(Domain::kHost));
        PatientTrace::after_each = nullptr;
    }

    /// The refinement of 5 x 2 pixels in batches of 4, 4 and 2, with a trace that can give up.
    [[nodiscard]] std::unique_ptr<Executor> startRefinement() {
        std::string text = planFile("refinement.json");
        const std::string mark = R"("type": "trace")";
        text.replace(text.find(mark), mark.size(), R"("type": "patient_trace")");
        return start(text);
    }

    static std::vector<float> reds(const Value& value) {
        std::vector<float> result;
        for (const vec3& color : value.as<vec3>())
            result.push_back(color.x);
        return result;
    }

    const RunOptions cancelable() { return {.cancel = &is_cancelled}; }
    std::atomic<bool> is_cancelled = false;
};

const std::vector<float> kRefined{0, 1, 2, 3, 4, 5, 6, 7, 8, 9};

TEST_F(ExecutorInterrupt, ShowsWholeIterationsAndGoesOnWithinThePass) {
    // Cancelled after ray 1 to 10, the next run ends as if nothing had been.
    for (int last = 1; last <= 10; ++last) {
        SCOPED_TRACE(last);
        int rays = 0;
        is_cancelled = false;
        const auto executor = startRefinement();
        PatientTrace::after_each = [&] { is_cancelled = ++rays == last; };
        executor->run(cancelable());
        const Curve& curve = *executor->output("curve").curve;
        EXPECT_EQ(curve.stop, "cancelled");
        EXPECT_EQ(rays, last);
        // Batches of 4, the last pixels first. A batch whose last ray was there is whole.
        const std::size_t batches = last == 10 ? 3 : static_cast<std::size_t>(last) / 4;
        std::vector<float> expected(10, 10.0f);
        for (std::size_t pixel = 10 - std::min<std::size_t>(4 * batches, 10); pixel < 10; ++pixel)
            expected[pixel] = static_cast<float>(pixel);
        EXPECT_EQ(reds(executor->output("color")), expected);
        EXPECT_EQ(curve.records.size(), batches);

        is_cancelled = false;
        executor->run(cancelable());
        EXPECT_EQ(rays, 10); // none was traced twice
        EXPECT_EQ(curve.stop, "empty");
        EXPECT_EQ(reds(executor->output("color")), kRefined);
        std::vector<std::uint64_t> pixels, counted_rays;
        for (const LoopRecord& record : curve.records) {
            pixels.push_back(record.pixels);
            counted_rays.push_back(record.rays);
        }
        EXPECT_EQ(pixels, (std::vector<std::uint64_t>{4, 8, 10}));
        EXPECT_EQ(counted_rays, pixels);
        EXPECT_EQ(runs(*executor, "raster"), 1u);
    }
}

TEST_F(ExecutorInterrupt, GetsOnUnderTheShortestTimeLimit) {
    const auto executor = startRefinement();
    const Curve& curve = *executor->output("curve").curve;
    int runs_needed = 0;
    do {
        executor->run({.max_ms = 1e-9});
        ASSERT_LE(++runs_needed, 20);
        EXPECT_TRUE(curve.stop == "ms" || curve.stop == "empty") << curve.stop;
    } while (curve.stop == "ms");
    EXPECT_GE(runs_needed, 10); // one ray each
    EXPECT_EQ(reds(executor->output("color")), kRefined);
    EXPECT_EQ(curve.records.size(), 3u);
    EXPECT_EQ(curve.records.back().rays, 10u);
    EXPECT_EQ(runs(*executor, "refine.trace"), 4u); // three batches and the empty one
}

TEST_F(ExecutorInterrupt, TakesWhatAnInterruptedPassWroteForNothing) {
    const auto executor = startRefinement();
    PatientTrace::after_each = [&] { is_cancelled = true; };
    executor->run(cancelable());
    EXPECT_EQ(executor->find("refine.trace.samples"), nullptr);
    is_cancelled = false;
    PatientTrace::after_each = nullptr;
    executor->run(cancelable());
    EXPECT_NE(executor->find("refine.trace.samples"), nullptr);
}

TEST_F(ExecutorInterrupt, BeginsAnewWhereSomethingChangedMeanwhile) {
    const auto executor = startRefinement();
    int rays = 0;
    PatientTrace::after_each = [&] { is_cancelled = ++rays == 6; };
    executor->run(cancelable());
    is_cancelled = false;
    camera.position.x = 30;
    executor->setCamera(camera);
    executor->run({.max_iterations = 1, .cancel = &is_cancelled});
    EXPECT_EQ(rays, 10);
    EXPECT_EQ(reds(executor->output("color")),
              (std::vector<float>{30, 30, 30, 30, 30, 30, 6, 7, 8, 9}));
    EXPECT_EQ(executor->output("curve").curve->records.front().rays, 4u);
}

TEST_F(ExecutorInterrupt, RunsNothingIfItIsCancelledBefore) {
    const auto executor = startRefinement();
    is_cancelled = true;
    executor->run(cancelable());
    EXPECT_EQ(runs(*executor, "raster"), 0u);
    EXPECT_EQ(executor->output("color").version, 0u);
    is_cancelled = false;
    executor->run(cancelable());
    EXPECT_EQ(reds(executor->output("color")), kRefined);
}

TEST_F(ExecutorInterrupt, FinishesPassesBehindALoopThatWasCancelled) {
    const auto executor = start(R"({ "hone": 1, "inputs": { "scene": "scene", "camera": "camera" },
        "passes": {
          "raster": { "type": "raster", "in": { "scene": "$scene", "camera": "$camera" } },
          "loop": { "loop": {
            "carry": { "image": "raster.color" },
            "passes": { "up": { "type": "bump", "in": { "color": "~image" } } },
            "next": { "image": "up.result" }, "stop": [ { "iterations": 5 } ] } },
          "after": { "type": "add", "in": { "color": "loop.image" }, "params": { "amount": 100 } } },
        "outputs": { "color": "after.result" } })");
    executor->run({.cancel = &is_cancelled, .on_iteration = [&](const LoopRecord& record) {
                       is_cancelled = record.iteration == 2;
                       return true;
                   }});
    EXPECT_EQ(reds(executor->output("color")), std::vector<float>(10, 112));
    is_cancelled = false;
    executor->run(cancelable());
    EXPECT_EQ(reds(executor->output("color")), std::vector<float>(10, 115));
}

TEST_F(ExecutorInterrupt, LetsNoPassGiveUpThatWritesInPlace) {
    const auto executor = start(R"({ "hone": 1, "inputs": { "scene": "scene", "camera": "camera" },
        "passes": {
          "raster": { "type": "raster", "in": { "scene": "$scene", "camera": "$camera" } },
          "loop": { "loop": {
            "carry": { "image": "raster.color" },
            "passes": { "up": { "type": "hasty_bump", "in": { "color": "~image" } } },
            "next": { "image": "up.result" }, "stop": [ { "iterations": 3 } ] } } },
        "outputs": { "color": "loop.image", "curve": "loop.stats" } })");
    for (int run = 0; run < 3; ++run)
        executor->run({.max_ms = 1e-9}); // a whole iteration each
    EXPECT_EQ(executor->output("curve").curve->stop, "iterations");
    EXPECT_EQ(reds(executor->output("color")), std::vector<float>(10, 13));
}

TEST_F(ExecutorInterrupt, GoesOnWithinNestedLoops) {
    std::string text = planFile("nested_loops.json");
    const std::string mark = R"("type": "add")";
    text.replace(text.find(mark), mark.size(), R"("type": "patient_add")");
    const auto executor = start(text), whole = start(planFile("nested_loops.json"));
    whole->run();
    int runs_needed = 0;
    do {
        executor->run({.max_ms = 1e-9});
        ASSERT_LE(++runs_needed, 200);
    } while (reds(executor->output("color")) != reds(whole->output("color")));
    // Two times four inner iterations of ten pixels, a pixel in each run at most.
    EXPECT_GE(runs_needed, 80);
    EXPECT_EQ(runs(*executor, "outer.inner.add"), 8u);
    executor->run();
    EXPECT_EQ(reds(executor->output("color")), reds(whole->output("color")));
    EXPECT_EQ(reds(executor->output("y")), reds(whole->output("y")));
    EXPECT_EQ(runs(*executor, "outer.inner.add"), 8u);
}

} // namespace
} // namespace hone

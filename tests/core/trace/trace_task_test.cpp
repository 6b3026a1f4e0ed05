// SPDX-License-Identifier: Apache-2.0
#include "hone/core/error.h"
#include "hone/core/trace/trace_task.h"
#include "hone/tests/support/fake_tracers.h"

#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <thread>

namespace hone {
namespace {

using test::FakeTracer;
using Clock = std::chrono::steady_clock;

constexpr Hit kUntouched{99, 99};

double msSince(Clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

/// A list that would take the slowest of tracers, at 0.05 million rays a second, 20 s.
class SlowTask : public testing::Test {
protected:
    SlowTask() { tracer.us_per_ray = 20; }

    void expectPrefix(std::size_t answered) const {
        for (std::size_t i = 0; i < answered; ++i)
            ASSERT_EQ(hits[i].instance, i);
        for (std::size_t i = answered; i < hits.size(); ++i)
            ASSERT_EQ(hits[i].instance, kUntouched.instance) << i << " of " << answered;
    }

    FakeTracer tracer;
    const std::vector<Ray> rays = FakeTracer::rays(1'000'000);
    std::vector<Hit> hits = std::vector<Hit>(rays.size(), kUntouched);
};

TEST(TraceTask, AnswersEverything) {
    const FakeTracer tracer;
    const std::vector<Ray> rays = FakeTracer::rays(5000);
    std::vector<uint> occluded(rays.size());
    TraceTask task(tracer, OccludedQuery{rays, occluded});
    EXPECT_EQ(task.wait(), 5000u);
    EXPECT_TRUE(task.isDone());
    for (uint i = 0; i < rays.size(); ++i)
        EXPECT_EQ(occluded[i], i % 2);
}

TEST(TraceTask, GoesOnFromWhatIsAnswered) {
    const FakeTracer tracer;
    const std::vector<Ray> rays = FakeTracer::rays(1000);
    std::vector<Hit> hits(rays.size(), kUntouched);
    TraceTask task(tracer, ClosestQuery{.rays = rays, .answers = hits, .answered = 640});
    EXPECT_EQ(task.wait(), 1000u);
    EXPECT_EQ(hits[639].instance, kUntouched.instance);
    EXPECT_EQ(hits[640].instance, 640u);
}

TEST_F(SlowTask, IsBackWithin250MsAfterItIsCancelled) {
    TraceTask task(tracer, ClosestQuery{rays, hits});
    std::this_thread::sleep_for(std::chrono::milliseconds(120));
    EXPECT_FALSE(task.isDone());
    const Clock::time_point begin = Clock::now();
    task.cancel();
    const std::size_t answered = task.wait();
    EXPECT_LT(msSince(begin), 250);
    EXPECT_GT(answered, 0u);
    EXPECT_EQ(answered % TraceSlices::kGrain, 0u);
    expectPrefix(answered);
}

TEST_F(SlowTask, TellsItsProgress) {
    TraceTask task(tracer, ClosestQuery{rays, hits});
    std::size_t progress = 0;
    for (int changes = 0; changes < 4;) {
        const std::size_t now = task.progress();
        ASSERT_GE(now, progress);
        if (now > progress) {
            EXPECT_EQ(hits[now - 1].instance, now - 1);
            ++changes;
        }
        progress = now;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

TEST_F(SlowTask, KeepsToItsBudget) {
    const Clock::time_point begin = Clock::now();
    TraceTask in_time(tracer, ClosestQuery{rays, hits}, {.max_ms = 60});
    const std::size_t answered = in_time.wait();
    EXPECT_LT(msSince(begin), 60 + 250);
    EXPECT_GT(answered, 0u);
    expectPrefix(answered);

    // Up to the packets of the grain: 130 rays are 3 * 64.
    std::ranges::fill(hits, kUntouched);
    TraceTask few(tracer, ClosestQuery{rays, hits}, {.max_rays = 130});
    EXPECT_EQ(few.wait(), 192u);
    expectPrefix(192);
}

TEST_F(SlowTask, EndsWithItsOwner) {
    const Clock::time_point begin = Clock::now();
    { const TraceTask task(tracer, ClosestQuery{rays, hits}); }
    EXPECT_LT(msSince(begin), 250);
}

TEST(TraceTask, HandsOnWhatTheBackendThrew) {
    FakeTracer tracer;
    tracer.on_query = [&] {
        if (tracer.lengths.size() == 2)
            throw DeviceError("lost");
    };
    const std::vector<Ray> rays = FakeTracer::rays(5000);
    std::vector<Hit> hits(rays.size(), kUntouched);
    TraceTask task(tracer, ClosestQuery{rays, hits});
    EXPECT_THROW(task.wait(), DeviceError);
    EXPECT_THROW(task.wait(), DeviceError);
    EXPECT_TRUE(task.isDone());
    EXPECT_EQ(task.progress(), TraceSlices::kFirstSlice);
}

} // namespace
} // namespace hone

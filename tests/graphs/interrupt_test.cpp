// SPDX-License-Identifier: Apache-2.0
//
// Whatever a run was cut by, and wherever, runs that follow end at the same image, bit for bit.
#include "hone/backends/embree/embree_backend.h"
#include "hone/backends/host/host_device.h"
#include "hone/core/graph/executor.h"
#include "hone/passes/passes.h"
#include "hone/tests/support/fake_tracers.h"
#include "hone/tests/support/vulkan_fixture.h"

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>

namespace hone {
namespace {

/// A shipped graph with a tracer that tells when it is asked.
class InterruptTest {
public:
    explicit InterruptTest(Device* raster = nullptr) : raster_(raster) {
        registerPasses(passes_);
        tracers_.add("embree", "", [this](const Devices&) {
            return test::watched(makeEmbreeBackend(), [this] {
                if (++queries == cancel_at)
                    is_cancelled = true;
                if (on_query)
                    on_query();
            });
        });
        host_ = makeHostDevice();
        scene_ = loadScene("builtin:cornell");
        camera_ = makeCamera(scene_.camera(""));
    }

    std::unique_ptr<Executor> load(const std::string& graph, const Overrides& overrides) {
        const Catalog catalog{&passes_, &tracers_};
        auto executor = std::make_unique<Executor>(
            loadGraph(HONE_SOURCE_DIR "/graphs/" + graph + ".json", catalog, overrides), catalog,
            Devices{host_.get(), raster_}, 3);
        executor->setScene(scene_);
        executor->setCamera(camera_);
        executor->setExtent({96, 64});
        return executor;
    }

    static std::vector<std::byte> colorOf(const Executor& executor) {
        const std::span<std::byte> bytes =
            std::as_writable_bytes(executor.output("color").as<vec3>());
        return {bytes.begin(), bytes.end()};
    }

    /// Cancels at one query after another, and lets the next run end.
    void cancelEverywhere(const std::string& graph, const Overrides& overrides,
                          int queries_before_loop = 0) {
        const std::unique_ptr<Executor> whole = load(graph, overrides);
        whole->run();
        const std::vector<std::byte> image = colorOf(*whole);
        const std::unique_ptr<Executor> cut = load(graph, overrides);
        const Curve& curve = *cut->output("curve").curve;
        for (cancel_at = 1;; ++cancel_at) {
            SCOPED_TRACE(cancel_at);
            queries = 0;
            cut->run({.cancel = &is_cancelled});
            if (!is_cancelled)
                break; // that many are not asked
            EXPECT_EQ(queries, cancel_at);
            // A query before the loop: that never began.
            EXPECT_EQ(curve.stop, cancel_at > queries_before_loop ? "cancelled" : "");
            is_cancelled = false;
            cut->run({.cancel = &is_cancelled});
            EXPECT_EQ(curve.stop, "empty");
            ASSERT_TRUE(colorOf(*cut) == image);

            // Another camera and back: everything begins anew.
            Camera elsewhere = camera_;
            elsewhere.position.x += 0.25f;
            cut->setCamera(elsewhere);
            cut->run({.max_iterations = 1});
            cut->setCamera(camera_);
        }
        EXPECT_GT(cancel_at, 6);
    }

    int queries = 0;
    int cancel_at = 0;
    std::function<void()> on_query;
    std::atomic<bool> is_cancelled = false;

private:
    Device* raster_;
    PassRegistry passes_;
    TraceBackendRegistry tracers_;
    std::unique_ptr<Device> host_;
    Scene scene_;
    Camera camera_{};
};

TEST(Interrupt, PureRayTracingEndsAtTheSameBitsWhereverItWasCancelled) {
    InterruptTest().cancelEverywhere("prt", {{"samples", "2"}, {"batch", "4000"}});
}

TEST(Interrupt, MillisecondsEndAtTheSameBitsToo) {
    InterruptTest test;
    const std::unique_ptr<Executor> whole = test.load("prt", {}), cut = test.load("prt", {});
    whole->run();
    int runs = 0;
    do {
        cut->run({.max_ms = 1e-6});
        ASSERT_LT(++runs, 1000);
    } while (cut->output("curve").curve->stop == "ms");
    EXPECT_GT(runs, 10);
    EXPECT_TRUE(InterruptTest::colorOf(*cut) == InterruptTest::colorOf(*whole));
}

TEST(Interrupt, IsBackWithin250MsFromTheSlowestTracer) {
    // All pixels in one iteration, on a tracer whose every slice takes 20 ms.
    InterruptTest test;
    const std::unique_ptr<Executor> executor = test.load("prt", {{"batch", "0"}});
    executor->setExtent({1920, 1080});
    using Clock = std::chrono::steady_clock;
    Clock::time_point cancelled_at;
    test.on_query = [&] {
        if (test.queries == 5) {
            cancelled_at = Clock::now();
            test.is_cancelled = true;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    };
    executor->run({.cancel = &test.is_cancelled});
    const std::chrono::duration<double, std::milli> passed = Clock::now() - cancelled_at;
    EXPECT_LT(passed.count(), 250);
    EXPECT_EQ(executor->output("curve").curve->stop, "cancelled");
    EXPECT_TRUE(executor->output("curve").curve->records.empty());

    const Clock::time_point begin = Clock::now();
    executor->run({.max_ms = 100});
    EXPECT_LT((std::chrono::duration<double, std::milli>(Clock::now() - begin)).count(), 350);
    EXPECT_EQ(executor->output("curve").curve->stop, "ms");
}

class InterruptVulkan : public VulkanTest {};

TEST_F(InterruptVulkan, RefinementEndsAtTheSameBitsWhereverItWasCancelled) {
    InterruptTest(&device()).cancelEverywhere("sir", {{"samples", "2"}, {"batch", "3000"}});
}

TEST_F(InterruptVulkan, VisitsWithCountsEndAtTheSameBitsWhereverTheyWereCancelled) {
    InterruptTest(&device()).cancelEverywhere("paper_corrected",
                                              {{"samples", "3"}, {"batch", "3000"}}, 1);
}

} // namespace
} // namespace hone

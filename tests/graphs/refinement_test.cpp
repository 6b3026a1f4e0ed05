// SPDX-License-Identifier: Apache-2.0
//
// What hone promises above all: a refined image is the ray-traced image, bit for bit, once every
// pixel has its samples, whatever the order said and however large the batches were.
#include "hone/core/image/image.h"
#include "hone/tests/graphs/refinement_fixture.h"

namespace hone {
namespace {

class Refinement : public RefinementTest, public testing::WithParamInterface<std::string> {
protected:
    void SetUp() override {
        VulkanTest::SetUp();
        if (!IsSkipped())
            open(GetParam());
    }
};

TEST_P(Refinement, EndsAtTheTracedImageBitForBit) {
    const std::vector<vec3> traced = colorOf(*load("prt"));
    const std::unique_ptr<Executor> refined = load("sir");
    // Mirrors and soft shadows: there is something to refine.
    if (GetParam() == "cornell" || GetParam() == "mirror_sphere") {
        refined->run();
        const std::span<vec3> raster = refined->output("raster").as<vec3>();
        EXPECT_FALSE(areSameBits({raster.begin(), raster.end()}, traced));
    }
    for (const char* strategy : {"select", "radix"})
        for (const char* metric : {"1", "2", "3", "4"})
            for (const char* batch : {"1", "8192", "0"}) {
                SCOPED_TRACE(std::string("strategy ") + strategy + ", metric " + metric +
                             ", batch " + batch);
                refined->setParameter("strategy", strategy);
                refined->setParameter("metric", metric);
                refined->setParameter("batch", batch);
                EXPECT_TRUE(areSameBits(colorOf(*refined), traced));
                const Curve& curve = *refined->output("curve").curve;
                EXPECT_EQ(curve.stop, "empty");
                // Each pixel was requested once.
                constexpr std::size_t kPixels = std::size_t{kExtent.x} * kExtent.y;
                EXPECT_EQ(curve.records.size(), std::string_view(batch) == "1" ? kPixels : 1);
                EXPECT_EQ(curve.records.back().pixels, kPixels);
            }
}

TEST_P(Refinement, EndsAtTheTracedImageWithSeveralSamples) {
    const std::unique_ptr<Executor> prt = load("prt"), sir = load("sir");
    for (Executor* executor : {prt.get(), sir.get()})
        executor->setParameter("samples", "3");
    sir->setParameter("batch", "100");
    EXPECT_TRUE(areSameBits(colorOf(*sir), colorOf(*prt)));
}

// Each sample has its own primary ray then.
TEST_P(Refinement, EndsAtTheTracedImageThroughALens) {
    const std::unique_ptr<Executor> prt = load("prt"), sir = load("sir"), dof = load("dof");
    const std::vector<vec3> sharp = colorOf(*prt);
    camera_.lens_radius = 0.1f;
    for (Executor* executor : {prt.get(), sir.get(), dof.get()}) {
        executor->setCamera(camera_);
        executor->setParameter("samples", "5");
    }
    const std::vector<vec3> traced = colorOf(*prt);
    if (GetParam() == "cornell" || GetParam() == "mirror_sphere") {
        EXPECT_FALSE(areSameBits(traced, sharp)) << "nothing is blurred";
    }
    for (Executor* executor : {sir.get(), dof.get()})
        for (const char* batch : {"0", "100"}) {
            executor->setParameter("batch", batch);
            EXPECT_TRUE(areSameBits(colorOf(*executor), traced)) << "batch " << batch;
        }
}

// With a pinhole dof.json is sir.json.
TEST_P(Refinement, BlursNothingForAPinhole) {
    const std::unique_ptr<Executor> sir = load("sir"), dof = load("dof");
    sir->run();
    dof->run();
    const auto planes = [](Executor& executor, const char* output) {
        const std::span<vec2> error = executor.output(output).as<vec2>();
        return std::vector<vec2>(error.begin(), error.end());
    };
    EXPECT_EQ(planes(*sir, "error"), planes(*dof, "error"));
    const auto raster = [](Executor& executor) {
        const std::span<vec3> pixels = executor.output("raster").as<vec3>();
        return std::vector<vec3>(pixels.begin(), pixels.end());
    };
    EXPECT_TRUE(areSameBits(raster(*sir), raster(*dof)));
}

TEST_P(Refinement, EndsAtTheTracedImageByEveryRuleForTheOrder) {
    const std::vector<vec3> traced = colorOf(*load("prt", {{"samples", "3"}}));
    for (const char* graph :
         {"paper_literal", "paper_corrected", "cab10", "soft_shadows", "kbm10"}) {
        const std::unique_ptr<Executor> refined =
            load(graph, {{"samples", "3"}, {"batch", "700"}, {"scope", "all"}});
        EXPECT_TRUE(areSameBits(colorOf(*refined), traced)) << graph;
    }
}

TEST_P(Refinement, TracesTheSameImageInBatchesOfAnySize) {
    const std::unique_ptr<Executor> prt = load("prt");
    const std::vector<vec3> at_once = colorOf(*prt);
    for (const char* batch : {"1", "1000", "3072"}) {
        prt->setParameter("batch", batch);
        EXPECT_TRUE(areSameBits(colorOf(*prt), at_once)) << "batch " << batch;
    }
}

// Both strategies request the same pixels in every batch, so that an early stop shows the same
// image, too.
TEST_P(Refinement, ShowsTheSameImageForBothStrategiesAtEveryStop) {
    const std::unique_ptr<Executor> refined = load("sir");
    refined->setParameter("batch", "500");
    for (std::uint64_t iterations = 1; iterations <= 6; iterations += 2) {
        std::vector<vec3> images[2];
        for (const int radix : {0, 1}) {
            refined->setParameter("strategy", radix == 1 ? "radix" : "select");
            RunOptions options;
            options.max_iterations = iterations;
            refined->run(options);
            const std::span<vec3> pixels = refined->output("color").as<vec3>();
            images[radix].assign(pixels.begin(), pixels.end());
        }
        EXPECT_TRUE(areSameBits(images[0], images[1])) << "after " << iterations << " batches";
    }
}

// The first batch of the oracle's order leaves the least squared error that so many pixels can.
TEST_P(Refinement, OracleTracesTheWorstPixelsFirst) {
    constexpr std::size_t kBatch = 500;
    const std::vector<vec3> traced = colorOf(*load("prt"));
    const std::unique_ptr<Executor> oracle = load("oracle");
    oracle->setParameter("batch", std::to_string(kBatch));
    EXPECT_TRUE(areSameBits(colorOf(*oracle), traced));

    const std::span<vec3> raster = oracle->output("raster").as<vec3>();
    const std::span<uint> rounds = oracle->output("round").as<uint>();
    const std::vector<vec3> shown = toDisplay({kExtent, {raster.begin(), raster.end()}}).pixels;
    const std::vector<vec3> aimed = toDisplay({kExtent, traced}).pixels;
    float best_left = 0, worst_taken = 1e30f;
    for (std::size_t pixel = 0; pixel < shown.size(); ++pixel) {
        const vec3 difference = shown[pixel] - aimed[pixel];
        const float error = dot(difference, difference);
        float& side = rounds[pixel] == 1 ? worst_taken : best_left;
        side = rounds[pixel] == 1 ? std::min(side, error) : std::max(side, error);
    }
    // The pass sums in another order than this test.
    EXPECT_GE(worst_taken * (1 + 1e-4f), best_left - 1e-6f);
}

// The names of builtinScenes(), which are known only while the program runs.
INSTANTIATE_TEST_SUITE_P(Scenes, Refinement,
                         testing::Values("cornell", "mirror_sphere", "planar_mirror",
                                         "straight_edge", "lit_floor", "alpha_quad", "two_sided",
                                         "one_triangle", "empty"),
                         [](const auto& scene) { return scene.param; });

} // namespace
} // namespace hone

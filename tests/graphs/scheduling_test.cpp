// SPDX-License-Identifier: Apache-2.0
//
// Who is traced when: what makes the order anew, how often pixels are visited, what budgets cut.
#include "hone/tests/graphs/refinement_fixture.h"

#include "hone/core/trace/sample.glsl.h"

#include <algorithm>

namespace hone {
namespace {

class Scheduling : public RefinementTest {
protected:
    void SetUp() override {
        VulkanTest::SetUp();
        if (!IsSkipped())
            open("cornell");
    }
};

TEST_F(Scheduling, SortsOnceHoweverManyIterationsAndRunsThereAre) {
    const std::unique_ptr<Executor> executor = load("sir", {{"batch", "16"}});
    executor->run();
    EXPECT_EQ(executor->output("curve").curve->records.size(), 192u); // 64 * 48 / 16
    for (int again = 0; again < 3; ++again)
        executor->run();
    EXPECT_EQ(runsOf(*executor, "sort"), 1u);
    EXPECT_EQ(runsOf(*executor, "refine.request"), 193u) << "the last finds nothing to do";

    // Cut and gone on with many times.
    const std::unique_ptr<Executor> cut = load("sir", {{"batch", "16"}});
    do {
        cut->run({.max_iterations = 5});
    } while (cut->output("curve").curve->stop == "iterations");
    EXPECT_EQ(runsOf(*cut, "sort"), 1u);
    EXPECT_EQ(runsOf(*cut, "refine.request"), 193u);
}

TEST_F(Scheduling, SortsOnceMoreForEachKindOfChangeAndForNothingElse) {
    const std::unique_ptr<Executor> executor = load("sir");
    std::uint64_t expected = 1;
    const auto sortsAfterRun = [&] {
        executor->run();
        executor->run();
        return runsOf(*executor, "sort");
    };
    EXPECT_EQ(sortsAfterRun(), expected);

    // What the order does not depend on.
    executor->setParameter("samples", "2");
    executor->setParameter("refine.trace.max_depth", "1");
    executor->setCamera(camera_); // the same
    executor->setExtent(kExtent);
    EXPECT_EQ(sortsAfterRun(), expected);

    // What it does.
    camera_.position.x += 0.125f;
    executor->setCamera(camera_);
    EXPECT_EQ(sortsAfterRun(), ++expected) << "camera";
    scene_.lights[0].intensity *= 0.5f;
    touch(scene_);
    EXPECT_EQ(sortsAfterRun(), ++expected) << "light";
    mat4x3 moved = scene_.instances[0].to_world;
    moved[3].y -= 0.25f;
    moveInstance(scene_, 0, moved);
    EXPECT_EQ(sortsAfterRun(), ++expected) << "instance";
    scene_.materials[0].base_color *= 0.5f;
    touch(scene_);
    EXPECT_EQ(sortsAfterRun(), ++expected) << "material";
    executor->setExtent({32, 24});
    EXPECT_EQ(sortsAfterRun(), ++expected) << "resolution";
    executor->setParameter("metric", "2");
    EXPECT_EQ(sortsAfterRun(), ++expected) << "metric";
    executor->setParameter("shadow.iterations", "2");
    EXPECT_EQ(sortsAfterRun(), ++expected) << "parameter of a metric";
    executor->setParameter("scope", "flagged");
    EXPECT_EQ(sortsAfterRun(), ++expected) << "its own parameter";
}

TEST_F(Scheduling, KeepsMapsAndProbesWhenTheCameraMoves) {
    const std::unique_ptr<Executor> executor = load("paper_corrected");
    for (int frame = 0; frame < 3; ++frame) {
        camera_.position.x += 0.125f;
        executor->setCamera(camera_);
        executor->run();
    }
    for (const char* kept : {"shadow_map", "probe", "occlusion"})
        EXPECT_EQ(runsOf(*executor, kept), 1u) << kept;
    for (const char* anew : {"raster", "shadow", "reflection", "combine", "sort", "refine.loop"})
        EXPECT_EQ(runsOf(*executor, anew), 3u) << anew;
}

TEST_F(Scheduling, EndsAtTheTracedImageWhateverTheCountsAndBatches) {
    const std::vector<vec3> traced = colorOf(*load("prt", {{"samples", "5"}}));
    for (const char* graph : {"paper_literal", "paper_corrected"}) {
        const std::unique_ptr<Executor> refined = load(graph, {{"samples", "5"}});
        for (const char* strategy : {"radix", "select"})
            for (const char* max_count : {"1", "3", "8"})
                for (const char* batch : {"7", "8192", "0"}) {
                    SCOPED_TRACE(std::string(graph) + ", " + strategy + ", max_count " + max_count +
                                 ", batch " + batch);
                    refined->setParameter("strategy", strategy);
                    refined->setParameter("max_count", max_count);
                    refined->setParameter("batch", batch);
                    EXPECT_TRUE(areSameBits(colorOf(*refined), traced));
                    EXPECT_EQ(refined->output("curve").curve->stop, "empty");
                }
    }
}

TEST_F(Scheduling, EndsAtTheTracedImagePixelByPixelToo) {
    const std::unique_ptr<Executor> prt = load("prt", {{"samples", "2"}});
    const std::unique_ptr<Executor> refined =
        load("paper_corrected", {{"samples", "2"}, {"batch", "1"}});
    EXPECT_TRUE(areSameBits(colorOf(*refined), colorOf(*prt)));
}

TEST_F(Scheduling, BudgetsCutIterationsNotTheFinalImage) {
    const std::vector<vec3> traced = colorOf(*load("prt", {{"samples", "4"}}));
    const std::unique_ptr<Executor> refined =
        load("paper_corrected", {{"samples", "4"}, {"max_samples", "1000"}});
    EXPECT_TRUE(areSameBits(colorOf(*refined), traced));
    // 64 * 48 * 4 samples, at most 1000 at a time.
    EXPECT_GE(refined->output("curve").curve->records.size(), 13u);
}

TEST_F(Scheduling, VisitsBadPixelsForMoreSamplesFirst) {
    const std::unique_ptr<Executor> refined =
        load("paper_corrected", {{"samples", "8"}, {"max_count", "4"}, {"batch", "100"}});
    refined->run({.max_iterations = 1});
    const std::span<uint> counts = refined->output("counts").as<uint>();
    const std::span<Accumulated> taken =
        refined->find("refine.loop.accumulation")->as<Accumulated>();
    float worst_left = 0, least_taken = 1e30f;
    const std::span<vec2> errors = refined->output("error").as<vec2>();
    std::size_t visited = 0;
    for (std::size_t pixel = 0; pixel < taken.size(); ++pixel)
        if (taken[pixel].count > 0) {
            ++visited;
            EXPECT_EQ(taken[pixel].count, counts[pixel]);
            least_taken = std::min(least_taken, errors[pixel].x);
        } else {
            worst_left = std::max(worst_left, errors[pixel].x);
        }
    EXPECT_EQ(visited, 100u);
    EXPECT_GE(least_taken, worst_left);
    EXPECT_EQ(*std::ranges::max_element(counts), 4u);
}

} // namespace
} // namespace hone

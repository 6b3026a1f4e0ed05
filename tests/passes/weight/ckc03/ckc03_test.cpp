// SPDX-License-Identifier: Apache-2.0
#include "hone/core/trace/ray.glsl.h"
#include "hone/passes/passes.h"
#include "hone/passes/weight/ckc03/task_distance.h"
#include "hone/tests/support/run_pass.h"
#include "hone/tests/support/scene_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace hone {
namespace {

TEST(TaskDistance, IsThatOfTheNearestPixelOfTheSet) {
    const uvec2 extent{23, 17};
    std::mt19937 random(4);
    for (uint of : {2u, 20u, 300u}) {
        std::vector<float> squared;
        for (uint pixel = 0; pixel < extent.x * extent.y; ++pixel)
            squared.push_back(random() % of == 0 ? 0.0f : 1.0f);
        squared[100] = 0;
        const std::vector<float> set = squared;
        squaredDistances(extent, squared);
        for (uint pixel = 0; pixel < set.size(); ++pixel) {
            uint nearest = ~0u;
            for (uint other = 0; other < set.size(); ++other)
                if (set[other] == 0) {
                    const uint dx = pixel % extent.x - other % extent.x;
                    const uint dy = pixel / extent.x - other / extent.x;
                    nearest = std::min(nearest, dx * dx + dy * dy); // also of negative ones
                }
            ASSERT_EQ(squared[pixel], static_cast<float>(nearest)) << pixel;
        }
    }
}

TEST(TaskDistance, IsInfiniteFromAnEmptySet) {
    std::vector<float> squared(6, 1.0f);
    squaredDistances({3, 2}, squared);
    EXPECT_EQ(squared, std::vector<float>(6, std::numeric_limits<float>::infinity()));
}

/// Five instances, of which these are looked for.
Scene sceneOf(std::vector<uint> task_objects) {
    test::SceneBuilder builder;
    const vec3 positions[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const uvec3 triangles[] = {{0, 1, 2}};
    const uint mesh = builder.addMesh(positions, triangles, builder.addMaterial({}));
    for (int instance = 0; instance < 5; ++instance)
        builder.addInstance(mesh);
    Scene scene = builder.finish();
    scene.task_objects = std::move(task_objects);
    return scene;
}

/// A row of pixels with an error of 0.05 and a bound of 1, of which the first shows instance 3.
PassRun& row(PassRun& run, const Scene& scene) {
    run.scene(scene);
    run.extent({5, 1}).param("noticeable", 0.01f).param("pixels_per_degree", 1.0f);
    run.plane<vec2>("error", std::vector<vec2>(5, vec2(0.05f, 1.0f)));
    return run.plane<Hit>("gbuffer", {{3, 0}, {2, 0}, {4, 0}, {kNone, kNone}, {0, 0}});
}

TEST(Ckc03, LooksAtTheTasksObjectsAndLessTheFartherAway) {
    const Scene scene = sceneOf({3});
    PassRun run(ckc03WeightPass());
    row(run, scene).param("falloff_degrees", 2.0f).execute();
    const std::vector<vec2> error = run.output<vec2>("error");
    for (std::size_t x = 0; x < 5; ++x) {
        // S (0.05 / 0.01 - 1) with S = 1 / (1 + degrees / 2)
        EXPECT_NEAR(error[x].x, 4.0f / (1.0f + static_cast<float>(x) / 2.0f), 1e-5f) << x;
        EXPECT_EQ(error[x].y, 1.0f) << "a bound stays a bound";
    }
}

TEST(Ckc03, LooksAtNothingElseWithoutARamp) {
    const Scene scene = sceneOf({2, 3});
    PassRun run(ckc03WeightPass());
    row(run, scene).param("falloff_degrees", 0.0f);
    const std::vector<vec2> error = run.execute().output<vec2>("error");
    for (std::size_t x = 0; x < 5; ++x) {
        EXPECT_NEAR(error[x].x, x < 2 ? 4.0f : 0.0f, 1e-5f) << x;
        EXPECT_EQ(error[x].y, 1.0f);
    }
}

TEST(Ckc03, LooksEverywhereWhenNoObjectIsSeen) {
    const Scene scene = sceneOf({1}); // is there, but not in the image
    PassRun run(ckc03WeightPass());
    row(run, scene).param("falloff_degrees", 0.0f).execute();
    for (vec2 error : run.output<vec2>("error"))
        EXPECT_NEAR(error.x, 4.0f, 1e-5f);
}

TEST(Ckc03, DoesNotSeeWhatIsBelowTheThreshold) {
    const Scene scene = sceneOf({3});
    PassRun run(ckc03WeightPass());
    row(run, scene);
    run.plane<float>("tolerance", {0.05f, 0.1f, 0.025f, 1.0f, 1.0f}).execute();
    const std::vector<vec2> error = run.output<vec2>("error");
    EXPECT_EQ(error[0].x, 0.0f);
    EXPECT_EQ(error[1].x, 0.0f);
    EXPECT_GT(error[2].x, 0.0f);
}

TEST(Ckc03, IsFiniteAndPositiveWhateverTheErrors) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    const Scene scene = sceneOf({3});
    PassRun run(ckc03WeightPass());
    row(run, scene);
    run.plane<vec2>("error", {{kNan, 1}, {INFINITY, 1}, {-INFINITY, 1}, {3e38f, 1}, {-1, 1}});
    for (vec2 error : run.execute().output<vec2>("error"))
        EXPECT_TRUE(error.x >= 0 && std::isfinite(error.x)) << error.x;
}

TEST(Ckc03, LeavesNothingOfTheGreatestErrorsWhereNobodyLooks) {
    constexpr float kMost = std::numeric_limits<float>::max();
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    const Scene scene = sceneOf({3});
    PassRun run(ckc03WeightPass());
    row(run, scene).param("falloff_degrees", 0.0f);
    run.plane<vec2>("error", {{kMost, 1}, {kMost, kNan}, {kMost, -1}, {0, 0}, {0, kMost}});
    // 0 times what is more than a float holds once it is divided by 0.01.
    EXPECT_EQ(run.execute().output<vec2>("error"),
              (std::vector<vec2>{{kMost, 1}, {0, 1}, {0, 0}, {0, 0}, {0, kMost}}));
}

} // namespace
} // namespace hone

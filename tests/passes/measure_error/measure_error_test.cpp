// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/support/each_build.h"

#include <gtest/gtest.h>

#include <limits>

namespace hone {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

class MeasureError : public EachBuild {};
HONE_ON_EACH_BUILD(MeasureError);

TEST_P(MeasureError, IsTheGreatestDifferenceOfAChannel) {
    PassRun run = pass(measureErrorPass());
    run.extent({2, 1}).param("space", "linear");
    run.plane<vec3>("image", {{1, 2, 3}, {0, 0, 0}});
    run.plane<vec3>("reference", {{1.5f, 0, 2}, {0, 0, 0}}).execute();
    EXPECT_EQ(run.output<vec2>("error"), (std::vector<vec2>{vec2(2), vec2(0)}));
}

TEST_P(MeasureError, MeasuresWhatAScreenShows) {
    PassRun run = pass(measureErrorPass());
    run.extent({3, 1});
    // 0.0025 is on the linear part of sRGB: 12.92 * 0.0025. Above 1 all is white.
    run.plane<vec3>("image", {{0.0025f, 0, 0}, {5, 1, 1}, {1, 0, 0}});
    run.plane<vec3>("reference", {{0, 0, 0}, {1, 1, 1}, {0, 0, 0}}).execute();
    const std::vector<vec2> error = run.output<vec2>("error");
    EXPECT_FLOAT_EQ(error[0].x, 0.0323f);
    EXPECT_EQ(error[1], vec2(0));
    EXPECT_FLOAT_EQ(error[2].y, 1.0f);
}

TEST_P(MeasureError, ExposesAndCurvesAsTonemapDoes) {
    PassRun run = pass(measureErrorPass());
    run.extent({2, 1}).param("exposure", 0.5f).param("curve", "reinhard");
    // 0.004 / 2 is 0.002 (1 + 0.002 / 16) / 1.002 after the curve; white is at 4, so 8 and 800 are.
    run.plane<vec3>("image", {{0.004f, 0, 0}, vec3(8)});
    run.plane<vec3>("reference", {{0, 0, 0}, vec3(800)}).execute();
    const std::vector<vec2> error = run.output<vec2>("error");
    EXPECT_FLOAT_EQ(error[0].x, 12.92f * 0.00199625748f);
    EXPECT_EQ(error[1], vec2(0));
}

TEST_P(MeasureError, MeansTheSquaresOfTheChannels) {
    PassRun run = pass(measureErrorPass());
    run.extent({1, 1}).param("space", "linear").param("norm", "mean_square");
    run.plane<vec3>("image", {{1, 2, 3}});
    run.plane<vec3>("reference", {{2, 0, 5}}).execute();
    EXPECT_EQ(run.output<vec2>("error"), (std::vector<vec2>{vec2(3)})); // (1 + 4 + 4) / 3
}

TEST_P(MeasureError, CountsWhatCannotBeComparedAsOne) {
    for (const char* space : {"display", "linear"}) {
        PassRun run = pass(measureErrorPass());
        run.extent({3, 1}).param("space", space);
        run.plane<vec3>("image", {vec3(kNan), vec3(0.5f), vec3(kInfinity)});
        run.plane<vec3>("reference", {vec3(0), vec3(kInfinity), vec3(kInfinity)}).execute();
        EXPECT_EQ(run.output<vec2>("error"), (std::vector<vec2>{vec2(1), vec2(1), vec2(0)}))
            << space;
    }
}

TEST_P(MeasureError, ShowsATemperatureFromBlueToRed) {
    PassRun run = pass(measureErrorPass());
    run.extent({4, 1}).param("space", "linear").param("scale", 2.0f);
    run.plane<vec3>("image", {vec3(0), vec3(0.25f), vec3(0.5f), vec3(9)});
    run.plane<vec3>("reference", std::vector<vec3>(4)).execute();
    EXPECT_EQ(run.output<vec3>("display"), (std::vector<vec3>{{0, 0, 0.375f},           // 0
                                                              {0.375f, 0.875f, 0.375f}, // 0.5
                                                              {0.75f, 0, 0},            // 1
                                                              {0.75f, 0, 0}}));         // cut at 1
}

} // namespace
} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/passes.h"
#include "hone/passes/weight/ypg01/vision.h"
#include "hone/tests/support/run_pass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace hone {
namespace {

TEST(Vision, SensitivityIsKellysAndDalys) {
    // v = 0.15: c2 v = 0.255, k = 6.1 + 7.3 |log10 0.085|^3 = 15.0574, rho_max = 45.9 / 2.255 =
    // 20.3548. At 4 cycles a degree: (2 pi 4 0.67)^2 = 283.549, exp(-33.678 / 20.3548) = 0.19118,
    // so 15.0574 * 1.14 * 0.255 * 283.549 * 0.19118 = 237.28.
    EXPECT_NEAR(vision::sensitivity(4, 0.15), 237.28, 0.01);
    EXPECT_NEAR(vision::sensitivity(1, 0.15), 51.294, 0.001);
    EXPECT_NEAR(vision::sensitivity(16, 0.15), 26.528, 0.001);
    // Fine detail that moves fast is not seen at all.
    EXPECT_NEAR(vision::sensitivity(4, 10), 0.0447, 0.0001);
}

TEST(Vision, SensitivityHasItsPeakWhereItSays) {
    for (double v : {0.15, 1.0, 10.0}) {
        const double peak = vision::peakFrequency(v);
        EXPECT_GT(vision::sensitivity(peak, v), vision::sensitivity(0.99 * peak, v));
        EXPECT_GT(vision::sensitivity(peak, v), vision::sensitivity(1.01 * peak, v));
    }
    EXPECT_NEAR(vision::peakFrequency(0.15), 20.3548 / (2 * 3.14159265 * 0.67), 1e-4);
}

TEST(Vision, EyesFollowMostOfAMovement) {
    EXPECT_NEAR(vision::retinalVelocity(0), 0.15, 1e-12);     // they drift
    EXPECT_NEAR(vision::retinalVelocity(10), 1.65, 1e-12);    // 10 - (8.2 + 0.15)
    EXPECT_NEAR(vision::retinalVelocity(200), 120, 1e-12);    // not faster than 80
    EXPECT_NEAR(vision::retinalVelocity(0.8333), 0.15, 1e-4); // never at rest
}

TEST(Vision, ThresholdIsFerwerdasForCones) {
    EXPECT_NEAR(vision::thresholdOf(100), 5.559, 0.001);    // 10^(2 - 1.255)
    EXPECT_NEAR(vision::thresholdOf(1), 0.3913, 0.0001);    // 10^(0.65^2.7 - 0.72)
    EXPECT_NEAR(vision::thresholdOf(1e-4), 0.1905, 0.0001); // 10^-0.72
    EXPECT_NEAR(vision::thresholdOf(0), 0.1905, 0.0001);
}

PassRun& show(PassRun& run, uvec2 extent, const std::vector<float>& grey) {
    std::vector<vec3> color;
    for (float value : grey)
        color.emplace_back(value);
    return run.extent(extent)
        .plane("color", color)
        .plane("error", std::vector<vec2>(color.size(), vec2(0.5f, 1.0f)));
}

std::vector<float> toleranceOf(uvec2 extent, const std::vector<float>& grey) {
    PassRun run(ypg01WeightPass());
    return show(run, extent, grey).execute().output<float>("tolerance");
}

TEST(Ypg01, OfUniformGreyIsTheThresholdAloneEverywhere) {
    for (uvec2 extent : {uvec2(64, 48), uvec2(37, 5), uvec2(1, 1)})
        for (float tolerance :
             toleranceOf(extent, std::vector<float>(std::size_t{extent.x} * extent.y, 0.5f)))
            EXPECT_NEAR(tolerance, vision::thresholdOf(50) / 100, 1e-5);
}

/// 64 x 64: the left half grey 0.5, the right half stripes of `width` pixels around it.
std::vector<float> halfStriped(float contrast, uint width) {
    std::vector<float> grey;
    for (uint y = 0; y < 64; ++y)
        for (uint x = 0; x < 64; ++x)
            grey.push_back(x < 32 ? 0.5f : 0.5f + (x / width % 2 == 0 ? contrast : -contrast));
    return grey;
}

TEST(Ypg01, ToleratesMoreInTextureThanInFlatGrey) {
    // Stripes of two pixels are the finest octave and nothing else, centred at 40 / 4 / sqrt(2) =
    // 7.07 cycles a degree. There S = 208.2; at its peak, 4.835, it is 245.4: 1.179 times as much.
    const std::vector<float> tolerance = toleranceOf({64, 64}, halfStriped(0.2f, 2));
    const float flat = tolerance[32 * 64 + 4], textured = tolerance[32 * 64 + 58];
    EXPECT_NEAR(textured / flat, 1.179f, 0.001f);
}

TEST(Ypg01, ToleratesMostWhereEyesAreLeastSensitive) {
    // Stripes of 16 pixels, about 1 cycle a degree, hide more than those of 4 near the peak.
    const auto textured = [](uint width) {
        return toleranceOf({64, 64}, halfStriped(0.2f, width))[32 * 64 + 58];
    };
    EXPECT_GT(textured(16), textured(4));
}

TEST(Ypg01, ToleratesMoreTheMoreContrastThereIs) {
    float last = 0;
    for (float contrast : {0.0f, 0.0002f, 0.0005f, 0.001f}) { // up to the threshold, 1 / 245
        const float tolerance = toleranceOf({64, 64}, halfStriped(contrast, 2))[32 * 64 + 58];
        EXPECT_GT(tolerance, last) << contrast;
        last = tolerance;
    }
}

TEST(Ypg01, DividesTheErrorAndLeavesTheBound) {
    PassRun run(ypg01WeightPass());
    show(run, {8, 8}, std::vector<float>(64, 0.5f)).execute();
    const float tolerance = run.output<float>("tolerance").front();
    for (vec2 error : run.output<vec2>("error")) {
        EXPECT_NEAR(error.x, 0.5f / tolerance, 1e-4f);
        EXPECT_EQ(error.y, 1.0f);
    }
}

TEST(Ypg01, IsFiniteAndPositiveWhateverTheImageHolds) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    PassRun run(ypg01WeightPass());
    run.extent({3, 2}).plane<vec3>(
        "color", {vec3(0), vec3(kNan), vec3(kInfinity), vec3(-1), vec3(1e30f), vec3(1)});
    run.plane<vec2>("error", {{kNan, 1}, {kInfinity, 1}, {0, 0}, {1, 1}, {3e38f, 1}, {1, 0}});
    run.execute();
    for (float tolerance : run.output<float>("tolerance"))
        EXPECT_TRUE(tolerance > 0 && std::isfinite(tolerance)) << tolerance;
    for (vec2 error : run.output<vec2>("error"))
        EXPECT_TRUE(error.x >= 0 && std::isfinite(error.x)) << error.x;
    EXPECT_EQ(run.output<vec2>("error")[2], vec2(0.0f));
}

TEST(Ypg01, TakesOnlyWhatIsNotFiniteForAFailedMetric) {
    constexpr float kMost = std::numeric_limits<float>::max();
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    PassRun run(ypg01WeightPass());
    show(run, {3, 1}, std::vector<float>(3, 0.5f));
    run.plane<vec2>("error", {{kMost, kMost}, {kNan, kNan}, {-1, -1}}).execute();
    const std::vector<vec2> error = run.output<vec2>("error");
    EXPECT_EQ(error[0], vec2(kMost)) << "in units of the tolerance it is more than a float holds";
    EXPECT_FLOAT_EQ(error[1].x, 1 / run.output<float>("tolerance")[1]);
    EXPECT_EQ(error[1].y, 1.0f);
    EXPECT_EQ(error[2], vec2(0.0f));
}

} // namespace
} // namespace hone

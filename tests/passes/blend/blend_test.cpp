// SPDX-License-Identifier: Apache-2.0
#include "hone/core/trace/sample.glsl.h"
#include "hone/passes/passes.h"
#include "hone/tests/support/run_pass.h"
#include "hone/tests/support/vulkan_fixture.h"

#include <gtest/gtest.h>

#include <limits>

namespace hone {
namespace {

/// A pixel of raster radiance 1 with `count` samples that sum to `sum`, of which there will be 4.
vec3 blended(const char* mode, vec3 sum, uint count, bool has_base = true) {
    PassRun run(blendPass());
    run.extent({1, 1}).param("mode", mode).param("samples", 4u);
    run.list<uvec3>("requests", {{0, 0, 1}}).plane<vec3>("image", {vec3(1)});
    run.plane<Accumulated>("accumulation", {{sum, count}});
    if (has_base)
        run.plane<vec3>("base", {vec3(1)});
    return run.execute().output<vec3>("image").front();
}

TEST(Blend, ReplacesByTheMeanOfTheSamplesSoFar) {
    EXPECT_EQ(blended("replace", {1, 2, 4}, 2), vec3(0.5f, 1, 2));
}

TEST(Blend, RampsFromTheBaseByTheShareOfSamples) {
    EXPECT_EQ(blended("ramp", {5, 1, 2}, 1), vec3(2, 1, 1.25f)); // 1 + 1/4 * (mean - 1)
    EXPECT_EQ(blended("ramp", {10, 2, 4}, 2), vec3(3, 1, 1.5f)); // 1 + 2/4 * (mean - 1)
}

TEST(Blend, EndsAtExactlyTheMean) {
    // 1 + (0.1 - 1) is not 0.1 in floats; a copy is.
    for (const char* mode : {"replace", "ramp", "credit"})
        EXPECT_EQ(blended(mode, vec3(0.4f), 4), vec3(0.4f / 4.0f)) << mode;
    EXPECT_NE(1.0f + 1.0f * (0.1f - 1.0f), 0.1f);
}

TEST(Blend, ReplacesWithoutABase) {
    EXPECT_EQ(blended("ramp", {1, 2, 4}, 2, false), vec3(0.5f, 1, 2));
    EXPECT_EQ(blended("credit", {1, 2, 4}, 2, false), vec3(0.5f, 1, 2));
}

constexpr uint kMany = 1u << 20; ///< samples, so many that 1 - n / N is almost 1

/// Feeds a pixel of raster radiance 0 with `count` samples of mean 1, so that its blend is alpha.
PassRun& feedUnit(PassRun& run, uint count, uint samples = kMany) {
    run.extent({1, 1}).param("mode", "credit").param("samples", samples);
    run.list<uvec3>("requests", {{0, 0, 1}}).plane<vec3>("image", {vec3(0)});
    run.plane<Accumulated>("accumulation", {{vec3(static_cast<float>(count)), count}});
    return run.plane<vec3>("base", {vec3(0)});
}

float alphaOf(PassRun& run) {
    return run.execute().output<vec3>("image").front().x;
}

/// Of a base whose error is `expect`.
float alphaWith(float expect, float sigma, uint count, uint samples = kMany) {
    PassRun run(blendPass());
    feedUnit(run, count, samples).param("sigma", sigma).plane<vec2>("error", {{expect, 1.0f}});
    return alphaOf(run);
}

TEST(Blend, CreditMakesTheExpectedSquaredErrorLeast) {
    // e^2 = 4, sigma^2 = 1: k = 1/4; alpha = n / (n + k).
    EXPECT_NEAR(alphaWith(2, 1, 1), 0.8f, 1e-6f);
    EXPECT_NEAR(alphaWith(2, 1, 4), 4.0f / 4.25f, 1e-6f);
    const auto mse = [](float alpha, float n) {
        return (1 - alpha) * (1 - alpha) * 4 + alpha * alpha / n;
    };
    EXPECT_NEAR(mse(alphaWith(2, 1, 1), 1), 0.8f, 1e-6f);
    EXPECT_NEAR(mse(alphaWith(2, 1, 4), 4), 0.23529f, 1e-5f);
}

TEST(Blend, CreditRunsOutAtTheLastSample) {
    // N = 4, k = 1: n / (n + 1 - n / 4) is 4/7, 4/5, 12/13, 1.
    EXPECT_FLOAT_EQ(alphaWith(1, 1, 1, 4), 4.0f / 7.0f);
    EXPECT_FLOAT_EQ(alphaWith(1, 1, 2, 4), 0.8f);
    EXPECT_FLOAT_EQ(alphaWith(1, 1, 3, 4), 12.0f / 13.0f);
    EXPECT_EQ(alphaWith(1, 1, 4, 4), 1.0f);
}

TEST(Blend, ExactSamplesReplaceTheBaseAndAnExactBaseStaysLongest) {
    EXPECT_EQ(alphaWith(0.5f, 0, 1), 1.0f); // k = 0
    // Errors of 0, or too small to square, clamp k to N = 4: 1 / (1 + 4 * 3/4).
    for (float exact : {0.0f, 1e-30f})
        EXPECT_EQ(alphaWith(exact, 1, 1, 4), 0.25f) << exact;
    EXPECT_EQ(alphaWith(0, 0, 1, 4), 0.25f);
}

TEST(Blend, OfABaseWhoseErrorIsNoNumberNothingIsLeft) {
    EXPECT_EQ(alphaWith(std::numeric_limits<float>::quiet_NaN(), 1, 1), 1.0f);
    EXPECT_EQ(alphaWith(std::numeric_limits<float>::infinity(), 1, 1), 1.0f);
}

TEST(Blend, CreditIsTheParameterWithoutErrors) {
    PassRun run(blendPass());
    EXPECT_NEAR(alphaOf(feedUnit(run, 1).param("credit", 3.0f)), 0.25f, 1e-6f);
    PassRun much(blendPass()); // clamped to 2 samples: 1 / (1 + 2 * 1/2)
    EXPECT_EQ(alphaOf(feedUnit(much, 1, 2).param("credit", 99.0f)), 0.5f);
}

TEST(Blend, KeepsTheBitsOfASingleSample) {
    PassRun run(blendPass());
    const vec3 radiance(0.1f, 1e-40f, 3e38f);
    run.extent({1, 1}).list<uvec3>("requests", {{0, 0, 1}}).plane<vec3>("image", {vec3(1)});
    run.plane<Accumulated>("accumulation", {{radiance, 1}}).execute();
    EXPECT_EQ(run.output<vec3>("image").front(), radiance);
}

TEST(Blend, WritesRequestedPixelsOnly) {
    PassRun run(blendPass());
    run.extent({3, 1}).list<uvec3>("requests", {{1, 0, 1}}, 8);
    run.plane<vec3>("image", {vec3(5), vec3(6), vec3(7)});
    run.plane<Accumulated>("accumulation", {{vec3(1), 1}, {vec3(2), 1}, {vec3(3), 1}}).execute();
    EXPECT_EQ(run.output<vec3>("image"), (std::vector<vec3>{vec3(5), vec3(2), vec3(7)}));
}

TEST(Blend, RemembersWhichRoundFirstTracedAPixel) {
    PassRun run(blendPass());
    run.extent({3, 1}).iteration(4).list<uvec3>("requests", {{0, 1, 1}, {1, 0, 1}});
    run.plane<vec3>("image", {vec3(0), vec3(0), vec3(0)}).plane<uint>("round", {2, 0, 0});
    run.plane<Accumulated>("accumulation", {{vec3(1), 2}, {vec3(2), 1}, {vec3(0), 0}}).execute();
    EXPECT_EQ(run.output<uint>("round"), (std::vector<uint>{2, 4, 0}));
}

class BlendVulkan : public VulkanTest {};

TEST_F(BlendVulkan, GivesCreditAsTheHostDoes) {
    for (uint count : {1u, 2u, 3u, 4u}) {
        PassRun run(blendPass(), device());
        feedUnit(run, count, 4).param("sigma", 1.0f).plane<vec2>("error", {{1.0f, 1.0f}});
        EXPECT_FLOAT_EQ(alphaOf(run), alphaWith(1, 1, count, 4)) << count;
    }
}

} // namespace
} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/support/each_build.h"
#include "hone/tests/support/lens_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace hone {
namespace {

class PropagateError : public EachBuild {};
HONE_ON_EACH_BUILD(PropagateError);

constexpr uvec2 kExtent{64, 64}; // the focal length of lensCamera() is 64 pixels
constexpr uint kPixels = 64 * 64;
const Camera kLens = test::lensCamera(1, 4);

std::vector<vec2> propagated(const std::vector<vec2>& error, const std::vector<float>& depth,
                             const char* mode = "propagate", const std::vector<vec2>& post = {}) {
    PassRun run = EachBuild::pass(propagateErrorPass());
    run.extent(kExtent).camera(kLens).param("mode", mode).param("taps", 0u);
    run.plane("error", error).plane("depth", depth);
    if (!post.empty())
        run.plane("post", post);
    return run.execute().output<vec2>("error");
}

/// Blurred over 16 pixels, and sharp.
const std::vector<float> kBlurred(kPixels, 2.0f), kSharp(kPixels, 4.0f);

/// Depths and errors of all kinds.
std::vector<float> roughDepth() {
    std::mt19937 random(11);
    std::vector<float> depth(kPixels);
    for (uint i = 0; i < kPixels; ++i)
        depth[i] = i % 64 < 20 ? 0.0f : 2.0f + 0.01f * static_cast<float>(random() % 400);
    return depth;
}

// SCIENCE 9.19.
TEST_P(PropagateError, SpreadsAWrongPixelOverItsDiscAndKeepsTheSum) {
    std::vector<vec2> error(kPixels, vec2(0));
    error[32 * 64 + 32] = vec2(0.5f, 1.0f);
    const std::vector<vec2> spread = propagated(error, kBlurred);
    const float area = 3.14159265f * 8 * 8;
    vec2 sum(0);
    for (uint i = 0; i < kPixels; ++i) {
        const float distance =
            std::hypot(static_cast<float>(i % 64) - 32, static_cast<float>(i / 64) - 32);
        if (distance < 7.4f) {
            EXPECT_NEAR(spread[i].x, 0.5f / area, 1e-4f);
            EXPECT_NEAR(spread[i].y, 1.0f / area, 1e-4f);
        } else if (distance > 8.6f) {
            EXPECT_EQ(spread[i], vec2(0));
        }
        sum += spread[i];
    }
    EXPECT_NEAR(sum.x, 0.5f, 1e-4f);
    EXPECT_NEAR(sum.y, 1.0f, 1e-4f);
}

// Where no pixel is without an error nothing is passed over.
TEST_P(PropagateError, PassesOverOnlyWhatNothingWrongReaches) {
    std::vector<float> depth = roughDepth();
    for (uint i = 0; i < kPixels; ++i)
        if (i / 64 > 40)
            depth[i] = 1.0f; // blurred over 48 pixels, three tiles
    std::vector<vec2> few(kPixels, vec2(0)), all(kPixels, vec2(1e-30f));
    for (const uint pixel : {5u, 20u * 64 + 33, 41u * 64 + 1, 63u * 64 + 63})
        few[pixel] = all[pixel] = vec2(0.5f, 1.0f);
    const std::vector<vec2> a = propagated(few, depth), b = propagated(all, depth);
    uint reached = 0;
    for (uint i = 0; i < kPixels; ++i) {
        EXPECT_NEAR(a[i].x, b[i].x, 1e-7f) << i;
        EXPECT_NEAR(a[i].y, b[i].y, 1e-7f) << i;
        reached += a[i].y > 0.0f ? 1u : 0u;
    }
    EXPECT_GT(reached, 1000u);
}

TEST_P(PropagateError, KeepsTheBitsWhereNothingIsBlurred) {
    std::vector<vec2> error(kPixels);
    for (uint i = 0; i < kPixels; ++i)
        error[i] = vec2(static_cast<float>(i % 97), static_cast<float>(i % 101)) / 7.0f;
    EXPECT_EQ(propagated(error, kSharp), error);
}

TEST_P(PropagateError, NeverFallsBelowWhatTheFilterDoesToTheImage) {
    // Two images and their difference through the same filter: |F(a) - F(b)| <= F(|a - b|).
    const std::vector<float> depth = roughDepth();
    std::mt19937 random(5);
    std::vector<vec3> a(kPixels), b(kPixels);
    std::vector<vec2> error(kPixels);
    for (uint i = 0; i < kPixels; ++i) {
        a[i] = vec3(static_cast<float>(random() % 1000) / 1000);
        b[i] = random() % 4 == 0 ? vec3(static_cast<float>(random() % 1000) / 1000) : a[i];
        error[i] = vec2(std::abs(a[i].x - b[i].x));
    }
    const auto blurred = [&](const std::vector<vec3>& image) {
        PassRun run = EachBuild::pass(depthOfFieldPass());
        run.extent(kExtent).camera(kLens).param("taps", 0u);
        return run.plane("image", image).plane("depth", depth).execute().output<vec3>("color");
    };
    const std::vector<vec3> blurred_a = blurred(a), blurred_b = blurred(b);
    const std::vector<vec2> bound = propagated(error, depth);
    for (uint i = 0; i < kPixels; ++i)
        EXPECT_LE(std::abs(blurred_a[i].x - blurred_b[i].x), bound[i].y + 1e-6f) << i;
}

TEST_P(PropagateError, ComposesWithTheErrorOfTheBlur) {
    const std::vector<vec2> error(kPixels, vec2(0.5f, 0.75f)), post(kPixels, vec2(0.25f, 1.0f));
    const auto at = [&](const char* mode) { return propagated(error, kSharp, mode, post).front(); };
    EXPECT_EQ(at("propagate"), vec2(0.75f, 1.75f));
    EXPECT_EQ(at("sum"), vec2(0.75f, 1.75f));
    EXPECT_EQ(at("max"), vec2(0.5f, 1.0f));
    EXPECT_EQ(at("noisy_or"), vec2(0.625f, 1.0f)); // 1 - 0.5 * 0.75
}

TEST_P(PropagateError, ComposesPixelByPixelUnlessItPropagates) {
    std::vector<vec2> error(kPixels, vec2(0));
    error[32 * 64 + 32] = vec2(1);
    for (const char* mode : {"max", "sum", "noisy_or"})
        EXPECT_EQ(propagated(error, kBlurred, mode), error) << mode;
}

TEST_P(PropagateError, IsFiniteAndNotNegativeWhateverComes) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    std::vector<vec2> error(kPixels, vec2(-1, NAN));
    std::fill(error.begin() + 2000, error.end(), vec2(std::numeric_limits<float>::max()));
    error[7] = vec2(kInfinity, std::numeric_limits<float>::max());
    for (const char* mode : {"propagate", "max", "sum", "noisy_or"})
        for (const vec2& result : propagated(error, roughDepth(), mode, error)) {
            EXPECT_TRUE(std::isfinite(result.x) && result.x >= 0) << mode;
            EXPECT_TRUE(std::isfinite(result.y) && result.y >= 0) << mode;
        }
    const std::vector<vec2> sharp = propagated(error, kSharp);
    EXPECT_EQ(sharp[0], vec2(0, 1));
    EXPECT_EQ(sharp[7].x, 1.0f);
}

} // namespace
} // namespace hone

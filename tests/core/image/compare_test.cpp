// SPDX-License-Identifier: Apache-2.0
#include "hone/core/image/compare.h"

#include "hone/core/error.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

namespace hone {
namespace {

RgbImage constant(uvec2 extent, vec3 color) {
    return {extent, std::vector<vec3>(std::size_t(extent.x) * extent.y, color), true};
}

/// Neither flat nor periodic, in [0.1, 0.6).
RgbImage textured(uvec2 extent) {
    RgbImage image = constant(extent, vec3(0));
    std::uint32_t state = 1;
    for (vec3& pixel : image.pixels)
        for (glm::length_t c = 0; c < 3; ++c) {
            state = state * 1664525u + 1013904223u;
            pixel[c] = 0.1f + 0.5f * float(state >> 8) / float(1u << 24);
        }
    return image;
}

TEST(Compare, EqualImagesDifferInNothing) {
    const RgbImage image = textured({40, 30});
    const ImageDifference d = compareImages(image, image);
    EXPECT_EQ(d.mse, 0);
    EXPECT_EQ(d.rmse, 0);
    EXPECT_EQ(d.psnr, std::numeric_limits<double>::infinity());
    EXPECT_EQ(d.ssim, 1);
    EXPECT_EQ(d.max, 0);
    EXPECT_EQ(d.differing_pixels, 0u);
    EXPECT_EQ(d.differing_bits, 0u);
}

TEST(Compare, ConstantOffsetGivesItsSquare) {
    // 0.25 and 0.375 are exact: d = 1/8, MSE = 1/64, PSNR = 10 log10(64) = 18.0618 dB.
    const ImageDifference d =
        compareImages(constant({20, 15}, vec3(0.25f)), constant({20, 15}, vec3(0.375f)));
    EXPECT_DOUBLE_EQ(d.mse, 1.0 / 64);
    EXPECT_DOUBLE_EQ(d.rmse, 0.125);
    EXPECT_NEAR(d.psnr, 18.0617997, 1e-6);
    EXPECT_DOUBLE_EQ(d.max, 0.125);
    EXPECT_EQ(d.differing_pixels, 300u);
}

TEST(Compare, OneChannelOfOnePixelCountsOnce) {
    RgbImage a = constant({2, 2}, vec3(0)), b = a;
    b.pixels[3].y = 3.0f;
    const ImageDifference d = compareImages(a, b);
    EXPECT_DOUBLE_EQ(d.mse, 9.0 / 12);
    EXPECT_DOUBLE_EQ(d.max, 3);
    EXPECT_EQ(d.differing_pixels, 1u);
}

TEST(Compare, SsimOfConstantsIsTheLuminanceTerm) {
    // No variance: SSIM = (2ab + C1) / (a^2 + b^2 + C1), C1 = 0.0001. For grey, luminance = value.
    const double a = 0.25, b = 0.75;
    const double expected = (2 * a * b + 1e-4) / (a * a + b * b + 1e-4);
    for (const uvec2 extent : {uvec2(30, 20), uvec2(11, 11), uvec2(3, 2), uvec2(1, 1)})
        EXPECT_NEAR(
            compareImages(constant(extent, vec3(0.25f)), constant(extent, vec3(0.75f))).ssim,
            expected, 1e-9);
}

TEST(Compare, SsimWeighsChannelsByRec709) {
    // Luminances 0.2126 (red) and 0.7152 (green).
    const double a = 0.2126, b = 0.7152;
    EXPECT_NEAR(compareImages(constant({16, 16}, {1, 0, 0}), constant({16, 16}, {0, 1, 0})).ssim,
                (2 * a * b + 1e-4) / (a * a + b * b + 1e-4), 1e-9);
}

TEST(Compare, SsimOfNegatedContrastIsNegative) {
    // y = 2m - x keeps mean and variance and negates the covariance.
    RgbImage a = textured({32, 32}), b = a;
    for (vec3& pixel : b.pixels)
        pixel = vec3(0.7f) - pixel;
    EXPECT_LT(compareImages(a, b).ssim, -0.5);
}

TEST(Compare, SsimOfOneWindowMatchesHandComputation) {
    // One row of two pixels, window (1/2, 1/2): x = 0, 1 and y = 0, 1/2:
    // means 1/2, 1/4; variances 1/4, 1/16; covariance 1/8.
    const double c1 = 1e-4, c2 = 9e-4;
    const double expected =
        (2 * 0.125 + c1) * (2 * 0.125 + c2) / ((0.25 + 0.0625 + c1) * (0.25 + 0.0625 + c2));
    const RgbImage a{{2, 1}, {vec3(0), vec3(1)}, true}, b{{2, 1}, {vec3(0), vec3(0.5f)}, true};
    EXPECT_NEAR(compareImages(a, b).ssim, expected, 1e-12);
}

TEST(Compare, CountsPlantedBits) {
    RgbImage a = constant({3, 1}, vec3(1.0f)), b = a;
    b.pixels[0].x = std::bit_cast<float>(std::bit_cast<std::uint32_t>(1.0f) ^ 0x00000001u);
    b.pixels[2].z = std::bit_cast<float>(std::bit_cast<std::uint32_t>(1.0f) ^ 0x00000700u);
    const ImageDifference d = compareImages(a, b);
    EXPECT_EQ(d.differing_bits, 4u);
    EXPECT_EQ(d.differing_pixels, 2u);
}

TEST(Compare, TellsTheZerosApart) {
    const ImageDifference d =
        compareImages(constant({1, 1}, {0, 0, 0}), constant({1, 1}, {-0.0f, 0, 0}));
    EXPECT_EQ(d.differing_bits, 1u);
    EXPECT_EQ(d.max, 0);
}

TEST(Compare, EqualNotANumbersAreEqual) {
    const RgbImage a = constant({2, 1}, {NAN, 1, 2});
    const ImageDifference d = compareImages(a, a);
    EXPECT_EQ(d.mse, 0);
    EXPECT_EQ(d.max, 0);
    EXPECT_EQ(d.differing_bits, 0u);
    EXPECT_EQ(d.nonfinite_pixels, 2u);
    EXPECT_FALSE(std::isnan(d.ssim));
}

TEST(Compare, NotANumberAgainstANumberIsInfinitelyFar) {
    const ImageDifference d =
        compareImages(constant({1, 1}, {NAN, 0, 0}), constant({1, 1}, {1, 0, 0}));
    EXPECT_EQ(d.mse, std::numeric_limits<double>::infinity());
    EXPECT_EQ(d.max, std::numeric_limits<double>::infinity());
    EXPECT_EQ(d.psnr, -std::numeric_limits<double>::infinity());
    EXPECT_GT(d.differing_bits, 0u);
    EXPECT_EQ(d.nonfinite_pixels, 1u);
}

TEST(Compare, RefusesDifferentExtentsNamingBoth) {
    try {
        (void)compareImages(constant({2, 3}, vec3(0)), constant({3, 2}, vec3(0)));
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("2 x 3 and 3 x 2"), std::string::npos);
    }
}

} // namespace
} // namespace hone

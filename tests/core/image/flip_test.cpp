// SPDX-License-Identifier: Apache-2.0
#include "hone/core/image/flip.h"

#include "hone/backends/host/parallel_for.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace hone {
namespace {

using std::numbers::pi;

RgbImage constant(uvec2 extent, vec3 color, bool is_display = true) {
    return {extent, std::vector<vec3>(std::size_t(extent.x) * extent.y, color), is_display};
}

/// Uniform in [low, high).
RgbImage random(uvec2 extent, float low, float high, bool is_display, std::uint32_t state) {
    RgbImage image = constant(extent, vec3(0), is_display);
    for (vec3& pixel : image.pixels)
        for (glm::length_t c = 0; c < 3; ++c) {
            state = state * 1664525u + 1013904223u;
            pixel[c] = low + (high - low) * float(state >> 8) / float(1u << 24);
        }
    return image;
}

FlipError flipOf(const RgbImage& reference, const RgbImage& test, double ppd = kPixelsPerDegree) {
    return flip(reference, test, hostParallelFor, ppd);
}

// --- The paper once more, pixel by pixel, in double, with two-dimensional filters

using Vector = std::array<double, 3>;

double decoded(double x) {
    return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

/// Linear sRGB to XYZ (D65); the white's XYZ are the sums of the rows. Eight digits, as Lab
/// magnifies what is left out 500 times.
constexpr double kXyz[3][3]{{0.41239080, 0.35758434, 0.18048079},
                            {0.21263901, 0.71516868, 0.07219232},
                            {0.01933082, 0.11919478, 0.95053215}};
/// Its inverse.
constexpr double kRgb[3][3]{{3.24096994, -1.53738318, -0.49861076},
                            {-0.96924364, 1.87596750, 0.04155506},
                            {0.05563008, -0.20397696, 1.05697151}};

double dot(const double (&row)[3], const Vector& v) {
    return row[0] * v[0] + row[1] * v[1] + row[2] * v[2];
}

double white(std::size_t i) {
    return kXyz[i][0] + kXyz[i][1] + kXyz[i][2];
}

Vector ycxcz(const Vector& linear) {
    const double x = dot(kXyz[0], linear) / white(0), y = dot(kXyz[1], linear) / white(1),
                 z = dot(kXyz[2], linear) / white(2);
    return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Vector huntLab(const Vector& linear) {
    const auto f = [](double t) {
        return t > std::pow(6 / 29.0, 3) ? std::cbrt(t) : t * 841 / 108 + 4 / 29.0;
    };
    const double x = f(dot(kXyz[0], linear) / white(0)), y = f(dot(kXyz[1], linear) / white(1)),
                 z = f(dot(kXyz[2], linear) / white(2));
    const double lightness = 116 * y - 16;
    return {lightness, lightness / 100 * 500 * (x - y), lightness / 100 * 200 * (y - z)};
}

double hyab(const Vector& a, const Vector& b) {
    return std::abs(a[0] - b[0]) + std::sqrt(std::pow(a[1] - b[1], 2) + std::pow(a[2] - b[2], 2));
}

/// The colour error of linear colours of which nothing is filtered away.
double colorError(const Vector& a, const Vector& b) {
    const double largest = std::pow(hyab(huntLab({0, 1, 0}), huntLab({0, 0, 1})), 0.7);
    const double d = std::pow(hyab(huntLab(a), huntLab(b)), 0.7), bend = 0.4 * largest;
    return d < bend ? 0.95 / bend * d : 0.95 + (d - bend) / (largest - bend) * 0.05;
}

class Paper {
public:
    Paper(const RgbImage& image, double ppd) : image_(image), ppd_(ppd) {}

    [[nodiscard]] static double error(const Paper& a, const Paper& b, int x, int y) {
        const double edge = std::abs(a.gradient(x, y, false) - b.gradient(x, y, false));
        const double point = std::abs(a.gradient(x, y, true) - b.gradient(x, y, true));
        const double feature = std::pow(std::max(edge, point) / std::sqrt(2.0), 0.5);
        return std::pow(colorError(a.seen(x, y), b.seen(x, y)), 1 - feature);
    }

private:
    [[nodiscard]] Vector at(int x, int y) const {
        const int width = int(image_.extent.x), height = int(image_.extent.y);
        const vec3 p = image_.pixels[std::size_t(std::clamp(y, 0, height - 1) * width +
                                                 std::clamp(x, 0, width - 1))];
        return ycxcz({decoded(p.x), decoded(p.y), decoded(p.z)});
    }

    /// Linear sRGB of what contrast sensitivity leaves.
    [[nodiscard]] Vector seen(int x, int y) const {
        constexpr double a1[]{1, 1, 34.1}, b1[]{0.0047, 0.0053, 0.04};
        constexpr double a2[]{0, 0, 13.5}, b2[]{1e-5, 1e-5, 0.025};
        const int radius = int(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd_));
        Vector mean{}, total{};
        for (int v = -radius; v <= radius; ++v)
            for (int u = -radius; u <= radius; ++u) {
                const double square = (u * u + v * v) / (ppd_ * ppd_);
                const Vector color = at(x + u, y + v);
                for (std::size_t c = 0; c < 3; ++c) {
                    const double weight =
                        a1[c] * std::sqrt(pi / b1[c]) * std::exp(-pi * pi * square / b1[c]) +
                        a2[c] * std::sqrt(pi / b2[c]) * std::exp(-pi * pi * square / b2[c]);
                    mean[c] += weight * color[c];
                    total[c] += weight;
                }
            }
        for (std::size_t c = 0; c < 3; ++c)
            mean[c] /= total[c];
        const double y_relative = (mean[0] + 16) / 116;
        const Vector xyz{(mean[1] / 500 + y_relative) * white(0), y_relative * white(1),
                         (y_relative - mean[2] / 200) * white(2)};
        return {std::clamp(dot(kRgb[0], xyz), 0.0, 1.0), std::clamp(dot(kRgb[1], xyz), 0.0, 1.0),
                std::clamp(dot(kRgb[2], xyz), 0.0, 1.0)};
    }

    /// The length of the gradient that edges (first derivatives) or points (second) have.
    [[nodiscard]] double gradient(int x, int y, bool is_point) const {
        const double deviation = 0.5 * 0.082 * ppd_;
        const int radius = int(std::ceil(3 * deviation));
        double sums[2][2]{}, totals[2]{}; // of positive and negative weights; along x and y
        for (int v = -radius; v <= radius; ++v)
            for (int u = -radius; u <= radius; ++u) {
                const double gauss = std::exp(-(u * u + v * v) / (2 * deviation * deviation));
                const double weight =
                    is_point ? (u * u / (deviation * deviation) - 1) * gauss : -u * gauss;
                const std::size_t sign = weight > 0 ? 0 : 1;
                totals[sign] += std::abs(weight);
                sums[sign][0] += std::abs(weight) * (at(x + u, y + v)[0] + 16) / 116;
                sums[sign][1] += std::abs(weight) * (at(x + v, y + u)[0] + 16) / 116;
            }
        return std::hypot(sums[0][0] / totals[0] - sums[1][0] / totals[1],
                          sums[0][1] / totals[0] - sums[1][1] / totals[1]);
    }

    const RgbImage& image_;
    double ppd_;
};

/// Lab and distances are floats: 6e-8 in Lab's cube roots are 3e-5 of a distance of 10 or more.
constexpr double kTolerance = 1e-5;

TEST(Flip, OfNoiseAndStepsIsThePapers) {
    const uvec2 extent(24, 19);
    RgbImage a = random(extent, 0, 1, true, 1), b = random(extent, 0, 1, true, 2);
    for (uint y = 0; y < extent.y; ++y)
        for (uint x = 0; x < 12; ++x) { // left: steps of colour, down and across
            a.pixels[y * extent.x + x] = y < 7 ? vec3(0.2f, 0.6f, 0.3f) : vec3(0.7f, 0.5f, 0.4f);
            b.pixels[y * extent.x + x] = x < 5 ? vec3(0.3f, 0.5f, 0.9f) : vec3(0.4f, 0.5f, 0.1f);
        }
    for (const double ppd : {67.0, 20.0, 1.0}) {
        const FlipError error = flipOf(a, b, ppd);
        EXPECT_EQ(error.exposures, 0u);
        const Paper paper_a(a, ppd), paper_b(b, ppd);
        for (const ivec2 p : {ivec2(0, 0), ivec2(4, 6), ivec2(5, 7), ivec2(11, 9), ivec2(12, 2),
                              ivec2(17, 10), ivec2(23, 18)})
            EXPECT_NEAR(error.pixels[std::size_t(p.y) * extent.x + std::size_t(p.x)],
                        Paper::error(paper_a, paper_b, p.x, p.y), kTolerance)
                << p.x << "," << p.y << " at " << ppd;
    }
}

TEST(Flip, OfConstantsIsTheColourError) {
    // Filters keep constants and no edge appears, so FLIP = colour error^(1 - 0).
    const vec3 a(0.25f, 0.5f, 0.75f), b(0.3f, 0.4f, 0.9f);
    const double expected = colorError({decoded(0.25), decoded(0.5), decoded(0.75)},
                                       {decoded(0.3), decoded(0.4), decoded(0.9)});
    for (const uvec2 extent : {uvec2(30, 20), uvec2(7, 1), uvec2(1, 9), uvec2(1, 1)}) {
        const FlipError error = flipOf(constant(extent, a), constant(extent, b));
        EXPECT_NEAR(error.mean, expected, kTolerance);
        EXPECT_EQ(error.pixels.size(), std::size_t(extent.x) * extent.y);
    }
}

TEST(Flip, OfBlackAndWhiteIsAlmostTheLargest) {
    // Lightness 0 and 100 without colour: HyAB 100, 100^0.7 = 25.1189. Green and blue are the
    // farthest apart: HyAB 203.25, 203.25^0.7 = 41.276. The ratio 0.60856 is above 0.4:
    // 0.95 + 0.05 (0.60856 - 0.4) / 0.6 = 0.96738.
    EXPECT_NEAR(flipOf(constant({4, 4}, vec3(0)), constant({4, 4}, vec3(1))).mean, 0.96738, 2e-5);
    EXPECT_NEAR(flipOf(constant({4, 4}, {0, 1, 0}), constant({4, 4}, {0, 0, 1})).mean, 1, 1e-6);
}

TEST(Flip, SeesNoFartherColoursThanGreenAndBlue) {
    // All pairs of a grid over the cube of colours, one pair a time as constants.
    std::vector<vec3> grid;
    for (int i = 0; i < 125; ++i)
        grid.push_back(vec3(i % 5, i / 5 % 5, i / 25) / 4.0f);
    for (const vec3 a : grid)
        for (const vec3 b : grid) {
            const double error = flipOf(constant({1, 1}, a), constant({1, 1}, b), 1).mean;
            EXPECT_GE(error, 0);
            EXPECT_LE(error, 1);
            EXPECT_EQ(error == 0, a == b);
        }
}

TEST(Flip, OfAStepHasTheWholeEdgeBesideIt) {
    // Black against black with a white right half. The edge filter's positive weights sum to 1 and
    // all see white in the two columns at the step: the feature error is (1 / sqrt 2)^(1/2).
    // Contrast sensitivity leaves there the Gaussian's share on the white side.
    const uvec2 extent(40, 3);
    const RgbImage black = constant(extent, vec3(0));
    RgbImage step = black;
    for (std::size_t i = 0; i < step.pixels.size(); ++i)
        step.pixels[i] = vec3(i % extent.x >= 20 ? 1.0f : 0.0f);
    double right = 0, all = 0; // strictly right of the pixel
    for (int i = -10; i <= 10; ++i) {
        const double weight = std::exp(-std::pow(pi * i / 67, 2) / 0.0047);
        right += i > 0 ? weight : 0;
        all += weight;
    }
    const double feature = std::pow(2, -0.25);
    const FlipError error = flipOf(black, step);
    for (const auto& [x, light] : {std::pair(19u, right / all), std::pair(20u, 1 - right / all)})
        EXPECT_NEAR(error.pixels[extent.x + x],
                    std::pow(colorError({0, 0, 0}, {light, light, light}), 1 - feature),
                    kTolerance);
    EXPECT_EQ(error.pixels[0], 0.0f);              // farther than any filter reaches
    EXPECT_NEAR(error.pixels[39], 0.96738, 2e-5f); // white through and through
}

TEST(Flip, OfEqualImagesIsZero) {
    for (const bool is_display : {true, false}) {
        RgbImage image = random({33, 17}, -0.5f, 4, is_display, 3);
        image.pixels[5] = {NAN, INFINITY, -INFINITY};
        EXPECT_EQ(flipOf(image, image).mean, 0);
    }
}

TEST(Flip, OfDisplayImagesIsSymmetric) {
    const RgbImage a = random({33, 17}, 0, 1, true, 4), b = random({33, 17}, 0, 1, true, 5);
    EXPECT_EQ(flipOf(a, b).pixels, flipOf(b, a).pixels);
}

TEST(Flip, GrowsWithTheDifference) {
    const RgbImage grey = constant({9, 9}, vec3(0.3f));
    double last = 0;
    for (float step = 0.05f; step < 0.7f; step += 0.05f) {
        RgbImage spot = grey;
        spot.pixels[40] = vec3(0.3f + step);
        const double mean = flipOf(grey, spot).mean;
        EXPECT_GT(mean, last) << step;
        last = mean;
    }
}

TEST(Flip, StaysInItsRangeWhateverTheValues) {
    const RgbImage wild = random({32, 16}, -3e38f, 3e38f, false, 6);
    const RgbImage dark = random({32, 16}, 0, 1e-38f, false, 7);
    const RgbImage checks = [] {
        RgbImage image = constant({32, 16}, vec3(0));
        for (uint i = 0; i < 512; ++i)
            image.pixels[i] = vec3((i + i / 32) % 2 == 0 ? 2.0f : -1.0f);
        return image;
    }();
    for (const FlipError& error :
         {flipOf(wild, dark), flipOf(dark, wild), flipOf(checks, constant({32, 16}, vec3(0.5f))),
          flipOf(checks, constant({32, 16}, vec3(0.5f)), 1000)})
        for (const float x : error.pixels)
            EXPECT_TRUE(x >= 0 && x <= 1) << x;
}

TEST(Flip, MovesWithTheImages) {
    // What is the same around a spot gives the same bits, wherever the spot is.
    const RgbImage grey = constant({64, 64}, vec3(0.4f, 0.5f, 0.2f));
    const auto withSpot = [&](std::size_t x, std::size_t y) {
        RgbImage image = grey;
        image.pixels[y * 64 + x] = {0.9f, 0.1f, 0.3f};
        image.pixels[y * 64 + x + 1] = {0.0f, 0.8f, 1.0f};
        return flipOf(grey, image);
    };
    const FlipError here = withSpot(20, 22), there = withSpot(41, 35);
    for (std::size_t y = 0; y < 21; ++y)
        for (std::size_t x = 0; x < 21; ++x)
            EXPECT_EQ(here.pixels[(12 + y) * 64 + 10 + x], there.pixels[(25 + y) * 64 + 31 + x]);
}

TEST(Flip, SeesLessOfFineNoiseFromFartherAway) {
    const RgbImage a = random({64, 64}, 0.3f, 0.7f, true, 8),
                   b = random({64, 64}, 0.3f, 0.7f, true, 9);
    EXPECT_LT(flipOf(a, b, 120).mean, flipOf(a, b, 60).mean);
    EXPECT_LT(flipOf(a, b, 60).mean, flipOf(a, b, 30).mean);
}

TEST(Flip, CountsWhatIsNoNumberAsOne) {
    for (const bool is_display : {true, false}) {
        RgbImage a = constant({20, 1}, vec3(0), is_display), b = a;
        a.pixels[3].y = NAN;
        b.pixels[16].z = INFINITY;
        const FlipError error = flipOf(a, b);
        EXPECT_EQ(error.pixels[3], 1.0f);
        EXPECT_EQ(error.pixels[16], 1.0f);
        EXPECT_DOUBLE_EQ(error.mean, 0.1); // seen as 0, like their surroundings
    }
}

TEST(Flip, HasTheSameBitsOnOneThread) {
    const RgbImage a = random({70, 90}, 0, 9, false, 10), b = random({70, 90}, 0, 9, false, 11);
    const auto serial = [](std::size_t count, std::size_t,
                           void (*body)(void*, std::size_t, std::size_t),
                           void* context) { body(context, 0, count); };
    EXPECT_EQ(flip(a, b, serial).pixels, flipOf(a, b).pixels);
}

// --- HDR-FLIP

/// ACES by Narkowicz of radiance times 0.6 2^stops.
double toneMapped(double radiance, double stops) {
    const double x = 0.6 * radiance * std::exp2(stops);
    return std::min(1.0, x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14));
}

TEST(HdrFlip, ExposesFromTheBrightestToTheMedian) {
    // Luminances 0.25 (3 of 5 pixels), 1 and 32: seven stops between the first and the last.
    RgbImage image = constant({5, 1}, vec3(0.25f), false);
    image.pixels[1] = vec3(1);
    image.pixels[3] = vec3(32);
    const FlipError error = flipOf(image, image);
    EXPECT_EQ(error.exposures, 7u);
    EXPECT_NEAR(error.last_exposure - error.first_exposure, 7, 1e-6);
    EXPECT_NEAR(toneMapped(32, error.first_exposure), 0.85, 1e-6);
    EXPECT_NEAR(toneMapped(0.25, error.last_exposure), 0.85, 1e-6);
}

TEST(HdrFlip, LeavesOutBlackFromTheMedian) {
    RgbImage image = constant({9, 1}, vec3(0), false);
    image.pixels[4] = vec3(2);
    const FlipError one = flipOf(image, image);
    EXPECT_EQ(one.exposures, 1u);
    EXPECT_NEAR(toneMapped(2, one.first_exposure), 0.85, 1e-6);

    const FlipError black = flipOf(constant({9, 1}, vec3(0), false), image);
    EXPECT_EQ(black.exposures, 1u);
    EXPECT_EQ(black.first_exposure, 0);
    EXPECT_GT(black.mean, 0);
}

TEST(HdrFlip, OfConstantsIsTheColourErrorOfWhatIsToneMapped) {
    // x (2.51 x + 0.03) = 0.85 (x (2.43 x + 0.59) + 0.14): 0.4445 x^2 - 0.4715 x - 0.119 = 0,
    // x = 1.271324, R = x / 0.6 = 2.118873: the only exposure is log2(R / 0.5) = 2.083297.
    const FlipError error =
        flipOf(constant({6, 6}, vec3(0.5f), false), constant({6, 6}, {0.5f, 0.75f, 0.25f}, false));
    EXPECT_NEAR(error.first_exposure, 2.083297, 2e-6);
    EXPECT_NEAR(error.mean,
                colorError({0.85, 0.85, 0.85},
                           {0.85, toneMapped(0.75, 2.083297), toneMapped(0.25, 2.083297)}),
                kTolerance);
}

TEST(HdrFlip, DoesNotDependOnTheUnitOfRadiance) {
    // A power of two changes exponents only: exposures make up for it.
    RgbImage a = random({24, 24}, 0, 8, false, 12), b = random({24, 24}, 0, 8, false, 13);
    const FlipError before = flipOf(a, b);
    for (RgbImage* image : {&a, &b})
        for (vec3& pixel : image->pixels)
            pixel *= 64.0f;
    const FlipError after = flipOf(a, b);
    EXPECT_EQ(after.exposures, before.exposures);
    EXPECT_NEAR(after.mean, before.mean, 1e-6);
}

TEST(HdrFlip, SeesWhatOneExposureCutsOff) {
    // A sky of 40 or 80 beside a room of 0.1: white on a display either way.
    RgbImage a = constant({40, 20}, vec3(0.1f), false), b = a;
    for (std::size_t y = 0; y < 20; ++y)
        for (std::size_t x = 0; x < 10; ++x) {
            a.pixels[y * 40 + x] = vec3(40);
            b.pixels[y * 40 + x] = vec3(80);
        }
    EXPECT_EQ(flipOf(toDisplay(a), toDisplay(b)).mean, 0);
    EXPECT_GT(flipOf(a, b).pixels[0], 0.05f);
}

} // namespace
} // namespace hone

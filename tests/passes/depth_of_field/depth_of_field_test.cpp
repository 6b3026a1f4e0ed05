// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/passes.h"
#include "hone/tests/support/lens_scenes.h"
#include "hone/tests/support/run_pass.h"
#include "hone/tests/support/vulkan_fixture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace hone {
namespace {

constexpr uvec2 kExtent{64, 64}; // the focal length of lensCamera() is 64 pixels
constexpr uint kPixels = 64 * 64;

struct Picture {
    std::vector<vec3> image{kPixels};
    std::vector<float> depth = std::vector<float>(kPixels);
};

/// `color` and `depth` of (x, y) measured in pixels from the image's middle.
template <class Color, class Depth> Picture paint(Color color, Depth depth) {
    Picture picture;
    for (uint i = 0; i < kPixels; ++i) {
        const float x = static_cast<float>(i % 64) - 31.5f;
        const float y = static_cast<float>(i / 64) - 31.5f;
        picture.image[i] = vec3(color(x, y));
        picture.depth[i] = depth(x, y);
    }
    return picture;
}

struct BlurRun : PassRun {
    BlurRun(const Picture& picture, const Camera& camera) : PassRun(depthOfFieldPass()) {
        prepare(picture, camera);
    }
    BlurRun(const Picture& picture, const Camera& camera, Device& device)
        : PassRun(depthOfFieldPass(), device) {
        prepare(picture, camera);
    }
    void prepare(const Picture& picture, const Camera& eye) {
        extent(kExtent).camera(eye).param("taps", 0u);
        plane("image", picture.image).plane("depth", picture.depth);
    }
    std::vector<vec3> color() { return execute().output<vec3>("color"); }
};

float noise(float x, float y) {
    return 0.5f + 0.5f * std::sin(12.9898f * x + 78.233f * y) * std::cos(3.1f * x * y);
}

Picture noisePicture(float depth) {
    return paint(noise, [&](float, float) { return depth; });
}

TEST(DepthOfField, KeepsTheBitsOfAPinholesImage) {
    const Picture picture = noisePicture(2);
    EXPECT_EQ(BlurRun(picture, test::lensCamera(0, 4)).color(), picture.image);
}

TEST(DepthOfField, KeepsTheBitsOfWhatIsInFocus) {
    const Picture picture = noisePicture(2);
    EXPECT_EQ(BlurRun(picture, test::lensCamera(1, 2)).color(), picture.image);
    // 0.9 pixels of blur: less than a pixel.
    EXPECT_EQ(BlurRun(picture, test::lensCamera(0.9f / 64 * 4, 4)).color(), picture.image);
}

TEST(DepthOfField, KeepsTheBitsOfSharpPixelsBeforeABlurredBackground) {
    // A disc of radius 10 pixels in focus, the rest blurred over 12 pixels.
    const auto is_disc = [](float x, float y) { return x * x + y * y < 100; };
    const Picture picture =
        paint(noise, [&](float x, float y) { return is_disc(x, y) ? 2.f : 8.f; });
    const std::vector<vec3> color = BlurRun(picture, test::lensCamera(0.5f, 2)).color();
    for (uint i = 0; i < kPixels; ++i)
        if (is_disc(static_cast<float>(i % 64) - 31.5f, static_cast<float>(i / 64) - 31.5f)) {
            EXPECT_EQ(color[i], picture.image[i]) << i;
        }
}

TEST(DepthOfField, BlursANearPlanesEdgeByWhatItCoversOfTheLens) {
    // Near: radiance 1 at 2 m, blurred over 64 |1/4 - 1/2| = 16 pixels; far: 1/4.
    const Picture picture = paint([](float x, float) { return x < 0 ? 1.0f : 0.25f; },
                                  [](float x, float) { return x < 0 ? 2.0f : 8.0f; });
    const std::vector<vec3> color = BlurRun(picture, test::lensCamera(1, 4)).color();
    for (uint i = 12 * 64; i < 52 * 64; ++i) {
        const float covered = test::discBeyond((static_cast<float>(i % 64) - 31.5f) / 8);
        EXPECT_NEAR(color[i].x, covered + 0.25f * (1 - covered), 0.01f) << i % 64;
    }
}

TEST(DepthOfField, LeavesTheEdgeOfASharpNearPlaneAStep) {
    const Picture picture = paint([](float x, float) { return x < 0 ? 1.0f : 0.25f; },
                                  [](float x, float) { return x < 0 ? 2.0f : 8.0f; });
    const std::vector<vec3> color = BlurRun(picture, test::lensCamera(1, 2)).color();
    for (uint i = 0; i < kPixels; ++i)
        EXPECT_NEAR(color[i].x, picture.image[i].x, 1e-6f) << i % 64;
}

TEST(DepthOfField, IsAMeanWhateverTheDepth) {
    std::mt19937 random(7);
    for (const bool has_sky : {false, true}) {
        const Picture picture = paint([](float, float) { return 0.75f; },
                                      [&](float, float) {
                                          const float u = static_cast<float>(random() % 1000);
                                          return has_sky && u < 300 ? 0.0f : 0.5f + 0.01f * u;
                                      });
        for (const uint taps : {0u, 49u})
            for (const vec3& color : BlurRun(picture, test::lensCamera(1, 2))
                                         .param("taps", taps)
                                         .execute()
                                         .output<vec3>("color"))
                EXPECT_NEAR(color.x, 0.75f, 1e-5f);
    }
}

/// Radiance at which sums of floats overflow, and infinity, at many depths.
Picture hugePicture() {
    std::mt19937 random(7);
    return paint(
        [](float x, float) { return x < 0 ? 3e38f : std::numeric_limits<float>::infinity(); },
        [&](float, float) { return 0.5f + 0.01f * static_cast<float>(random() % 1000); });
}

/// A mean of what is cut at 1e30 is 1e30; what nothing spreads to is kept.
void expectCut(const std::vector<vec3>& color, const Picture& picture) {
    uint cut = 0;
    for (uint i = 0; i < kPixels; ++i)
        if (color[i] != picture.image[i]) {
            EXPECT_NEAR(color[i].x, 1e30f, 1e25f) << i;
            ++cut;
        }
    EXPECT_GT(cut, kPixels / 2);
}

TEST(DepthOfField, CutsWhatIsHugeSoThatSumsStayFinite) {
    const Picture picture = hugePicture();
    expectCut(BlurRun(picture, test::lensCamera(1, 2)).color(), picture);
}

TEST(DepthOfField, SpreadsAPointEvenlyOverItsDiscAndKeepsItsSum) {
    Picture picture = noisePicture(2);
    std::ranges::fill(picture.image, vec3(0));
    picture.image[32 * 64 + 32] = vec3(1);
    const std::vector<vec3> color = BlurRun(picture, test::lensCamera(1, 4)).color();
    float sum = 0;
    for (uint i = 0; i < kPixels; ++i) {
        const float distance =
            std::hypot(static_cast<float>(i % 64) - 32, static_cast<float>(i / 64) - 32);
        if (distance < 7.4f) {
            EXPECT_NEAR(color[i].x, 1 / (3.14159265f * 64), 1e-4f);
        } else if (distance > 8.6f) {
            EXPECT_EQ(color[i].x, 0.0f);
        }
        sum += color[i].x;
    }
    EXPECT_NEAR(sum, 1.0f, 1e-4f);
}

TEST(DepthOfField, TakesASlantedPlaneForOneSurface) {
    // Inverse depth, and so blur, grows linearly from -15 to 15 pixels: a mean over discs, without
    // layers.
    const auto diameter = [](float x) { return 15.0f / 32 * x; };
    const Picture picture = paint(noise, [&](float x, float) {
        return 1 / (0.25f - diameter(x) / 64); // aperture 1, focal length 64, focus 4
    });
    const std::vector<vec3> color = BlurRun(picture, test::lensCamera(1, 4)).color();
    for (int row = 20; row < 44; row += 5)
        for (int column = 0; column < 64; ++column) {
            float sum = 0, weights = 0;
            for (int y = -9; y <= 9; ++y)
                for (int x = -9; x <= 9; ++x) {
                    if (column + x < 0 || column + x >= 64)
                        continue;
                    const float r = std::max(
                        0.5f, 0.5f * std::abs(diameter(static_cast<float>(column + x) - 31.5f)));
                    const float distance = std::sqrt(static_cast<float>(x * x + y * y));
                    const float weight = std::clamp(r - distance + 0.5f, 0.0f, 1.0f) /
                                         (3.14159265f * (r * r + 1.0f / 12));
                    const int tap = (row + y) * 64 + column + x;
                    sum += weight * picture.image[static_cast<std::size_t>(tap)].x;
                    weights += weight;
                }
            EXPECT_NEAR(color[static_cast<std::size_t>(row * 64 + column)].x, sum / weights, 2e-4f)
                << column << ", " << row;
        }
}

TEST(DepthOfField, CountsThePixelsWhoseBlurTheLimitCutsShort) {
    const Picture picture = paint([](float x, float) { return x < 0 ? 1.0f : 0.25f; },
                                  [](float x, float) { return x < 0 ? 2.0f : 4.0f; });
    BlurRun run(picture, test::lensCamera(1, 4)); // radii of 8 and 0
    run.param("radius_limit", 7.5f).execute();
    EXPECT_EQ(run.counter("depth_of_field.limited"), kPixels / 2);
    run.param("radius_limit", 8.5f).execute();
    EXPECT_EQ(run.counter("depth_of_field.limited"), 0);
}

class DepthOfFieldVulkan : public VulkanTest {
protected:
    static double meanSquare(const std::vector<vec3>& a, const std::vector<vec3>& b) {
        double sum = 0;
        for (uint i = 0; i < kPixels; ++i)
            sum += glm::dot(a[i] - b[i], a[i] - b[i]) / 3;
        return sum / kPixels;
    }
};

TEST_F(DepthOfFieldVulkan, ComesNearToTheLensesImage) {
    const Scene scene = test::posts();
    for (const float focus : {2.5f, 5.0f, 9.0f}) {
        const Camera camera = test::lensCamera(0.4f, focus);
        PassRun raster(rasterPass(), device());
        raster.kernelsOnHost().extent(kExtent).scene(scene).camera(camera).execute();

        const std::vector<vec3> truth = test::tracedMeans(scene, camera, kExtent, 256);
        PassRun blur(depthOfFieldPass(), device());
        blur.kernelsOnHost().extent(kExtent).camera(camera).param("taps", 0u);
        blur.input("image", raster.value("color")).input("depth", raster.value("depth")).execute();
        const double sharp = meanSquare(raster.output<vec3>("color"), truth);
        const double blurred = meanSquare(blur.output<vec3>("color"), truth);
        // What is left: edges between pixels' centres, and what the pinhole did not see.
        EXPECT_LT(blurred, sharp / 3) << "focus " << focus;
    }
}

TEST_F(DepthOfFieldVulkan, CutsWhatIsHugeSoThatSumsStayFinite) {
    const Picture picture = hugePicture();
    expectCut(BlurRun(picture, test::lensCamera(1, 2), device()).color(), picture);
}

TEST_F(DepthOfFieldVulkan, BlursAsTheHostDoes) {
    const Picture picture = paint(noise, [](float x, float y) {
        return x > 20 ? 0.0f : x * y > 100 ? 2.0f : 5 + 0.05f * x;
    });
    for (const uint taps : {0u, 49u}) {
        BlurRun host(picture, test::lensCamera(1, 4));
        BlurRun vulkan(picture, test::lensCamera(1, 4), device());
        host.param("taps", taps).execute();
        vulkan.param("taps", taps).execute();
        const std::vector<vec3> a = host.output<vec3>("color"), b = vulkan.output<vec3>("color");
        for (uint i = 0; i < kPixels; ++i)
            EXPECT_LT(glm::distance(a[i], b[i]), 1e-4f) << i;
    }
}

} // namespace
} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/measure/ranking.h"
#include "hone/passes/passes.h"
#include "hone/tests/support/lens_scenes.h"
#include "hone/tests/support/run_pass.h"
#include "hone/tests/support/vulkan_fixture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace hone {
namespace {

constexpr uvec2 kExtent{64, 64}; // the focal length of lensCamera() is 64 pixels
constexpr uint kPixels = 64 * 64;
/// Blur of 64 |1/4 - 1/depth| pixels.
const Camera kLens = test::lensCamera(1, 4);

/// `depth` of (x, y) in pixels from the image's middle.
template <class Depth> std::vector<float> paint(Depth depth) {
    std::vector<float> plane(kPixels);
    for (uint i = 0; i < kPixels; ++i)
        plane[i] = depth(static_cast<float>(i % 64) - 31.5f, static_cast<float>(i / 64) - 31.5f);
    return plane;
}

struct DofRun : PassRun {
    explicit DofRun(const std::vector<float>& depth, const Camera& eye = kLens)
        : PassRun(dofErrorPass()) {
        extent(kExtent).camera(eye).plane("depth", depth).param("border", false);
    }
};

std::vector<vec2> errorOf(PassRun& run) {
    return run.execute().output<vec2>("error");
}

/// Of the middle row.
std::string row(PassRun& run) {
    const std::vector<vec2> all = errorOf(run);
    std::string text;
    for (uint x = 0; x < 64; ++x) {
        EXPECT_EQ(all[32 * 64 + x].x, all[32 * 64 + x].y);
        text += all[32 * 64 + x].x == 0 ? '.' : '#';
    }
    return text;
}

/// `count` pixels in error from `first` on.
std::string flagged(std::size_t first, std::size_t count) {
    return std::string(first, '.') + std::string(count, '#') + std::string(64 - first - count, '.');
}

/// 2 m to the left (blur 16), 8 m to the right (blur 8); infinity has 16.
std::vector<float> edge() {
    return paint([](float x, float) { return x < 0 ? 2.0f : 8.0f; });
}

TEST(DofError, IsNothingForAPinhole) {
    DofRun run(edge(), test::lensCamera(0, 4));
    for (const vec2& error : run.param("border", true).execute().output<vec2>("error"))
        EXPECT_EQ(error, vec2(0));
}

TEST(DofError, GrowsBothSidesOfAJumpByTheirRadii) {
    // The jump is between pixels 31 and 32. own: 8 pixels around 31, 4 around 32.
    DofRun run(edge());
    EXPECT_EQ(row(run.param("radius", "own")), flagged(23, 17));
    // tight: 8 around both. paper: max(8, 8) and max(4, 8); paper_diameter: 16.
    EXPECT_EQ(row(run.param("radius", "tight")), flagged(23, 18));
    EXPECT_EQ(row(run.param("radius", "paper")), flagged(23, 18));
    EXPECT_EQ(row(run.param("radius", "paper_diameter")), flagged(15, 34));
}

// The strip in which the far plane's blur is not what the pinhole saw (SCIENCE 9.5): c / 2 = 7.5
// pixels to each side of the near plane's edge.
TEST(DofError, CoversTheBlurOfAnEdge) {
    DofRun run(edge());
    const std::vector<vec2> error = errorOf(run);
    for (uint i = 0; i < kPixels; ++i) {
        const float distance = std::abs(static_cast<float>(i % 64) - 31.5f);
        const float covered = test::discBeyond(distance / 8);
        EXPECT_EQ(error[i].x, distance < 9 ? 1.0f : 0.0f);
        EXPECT_TRUE(covered == 0.0f || error[i].x == 1.0f);
    }
}

TEST(DofError, SparesSlantedPlanes) {
    // Blur grows by 0.9 pixels a pixel, more than the 0.5 that are a jump.
    const std::vector<float> depth =
        paint([](float x, float) { return 1 / (0.25f + 0.9f * x / 64 / 64 * 8); });
    for (const char* scope : {"blur", "all"})
        for (const vec2& error : DofRun(depth, test::lensCamera(8, 4))
                                     .param("scope", scope)
                                     .param("jump", 0.5f)
                                     .execute()
                                     .output<vec2>("error"))
            EXPECT_EQ(error, vec2(0)) << scope;
}

TEST(DofError, LooksForJumpsOfBlurUnlessAskedForAll) {
    // Far behind the focus both are blurred over about 16 pixels.
    const std::vector<float> depth = paint([](float x, float) { return x < 0 ? 1e4f : 2e4f; });
    DofRun run(depth), all(depth), sobel(depth);
    EXPECT_EQ(row(run), flagged(0, 0));
    EXPECT_EQ(row(all.param("scope", "all")), flagged(23, 18));
    EXPECT_EQ(row(sobel.param("detector", "sobel_z")), flagged(23, 18));
}

TEST(DofError, SobelFindsJumpsByTheirPartOfDepth) {
    // A step of 2 % of depth halves to 1 % beside it.
    const std::vector<float> depth = paint([](float x, float) { return x < 0 ? 8.0f : 8.2f; });
    DofRun run(depth);
    run.param("detector", "sobel_z").param("radius", "own");
    EXPECT_EQ(row(run.param("slope", 0.013f)), flagged(0, 0));
    EXPECT_EQ(row(run.param("slope", 0.012f)), flagged(27, 11)); // 4 around 31, ceil(4.1) around 32
}

TEST(DofError, TakesTheEdgeOfTheSkyForAJump) {
    const std::vector<float> depth = paint([](float x, float) { return x < 0 ? 4.0f : 0.0f; });
    for (const char* detector : {"coc_jump", "sobel_z"}) {
        DofRun run(depth);
        run.param("detector", detector).param("radius", "own");
        EXPECT_EQ(row(run), flagged(24, 17)) << detector; // 0 around 31, 8 around 32
    }
}

TEST(DofError, TakesTheBorderForAJumpOfTheGreatestRadius) {
    const std::vector<float> depth = paint([](float, float) { return 3.2f; }); // blur 4 pixels
    DofRun run(depth);
    run.param("border", true).param("radius", "own");
    const std::vector<vec2> error = errorOf(run);
    for (uint i = 0; i < kPixels; ++i) {
        const uint x = i % 64, y = i / 64;
        const uint inward = std::min({x, y, 63 - x, 63 - y});
        EXPECT_EQ(error[i].x, inward <= 2 ? 1.0f : 0.0f) << x << ", " << y;
    }
}

TEST(DofError, GrowsToSquaresWhenAsked) {
    // One pixel in front.
    const std::vector<float> depth =
        paint([](float x, float y) { return x == 0.5f && y == 0.5f ? 2.0f : 4.0f; });
    DofRun run(depth);
    run.param("radius", "own"); // 8 around the pixel, 0 around its neighbours
    for (const bool is_square : {false, true}) {
        const std::vector<vec2> error = errorOf(run.param("shape", is_square ? "square" : "disc"));
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) {
                const int dx = x - 32, dy = y - 32;
                const bool reaches =
                    is_square ? std::abs(dx) <= 8 && std::abs(dy) <= 8 : dx * dx + dy * dy <= 64;
                EXPECT_EQ(error[static_cast<std::size_t>(y * 64 + x)].x, reaches ? 1.0f : 0.0f)
                    << x << ", " << y;
            }
    }
}

TEST(DofError, CountsTheJumpsWhoseRadiusTheLimitCuts) {
    DofRun run(edge());
    run.param("radius", "own").param("radius_limit", 5.0f);
    EXPECT_EQ(row(run), flagged(26, 11)); // 5 around 31, 4 around 32
    EXPECT_EQ(run.counter("error.dof.limited"), 64);
}

TEST(DofError, IsFiniteForDepthsThatAreNot) {
    const std::vector<float> depth = paint([](float x, float) { return x < 0 ? NAN : INFINITY; });
    for (const char* detector : {"coc_jump", "sobel_z"}) {
        DofRun run(depth);
        for (const vec2& error : errorOf(run.param("detector", detector)))
            EXPECT_TRUE(error.x == 0 || error.x == 1);
    }
}

/// A pass that estimates, of `color` of (x, y).
template <class Color> void estimate(PassRun& run, Color color) {
    std::vector<vec3> image(kPixels);
    for (uint i = 0; i < kPixels; ++i)
        image[i] =
            vec3(color(static_cast<float>(i % 64) - 31.5f, static_cast<float>(i / 64) - 31.5f));
    run.param("expect", "layers").param("space", "linear").param("taps", 0u);
    run.plane("image", image);
}

/// 0 or 1.
float speckle(float x, float y) {
    const float v = std::sin(12.9898f * x + 78.233f * y) * 43758.5f;
    return v - std::floor(v) < 0.5f ? 0.0f : 1.0f;
}

TEST(DofLayers, ExpectNoErrorOfOneColourButBoundNone) {
    DofRun run(edge());
    estimate(run, [](float, float) { return 0.5f; });
    const std::vector<vec2> error = errorOf(run);
    for (uint i = 0; i < kPixels; ++i) {
        EXPECT_NEAR(error[i].x, 0.0f, 1e-3f); // rounding of squares
        EXPECT_EQ(error[i].y, std::abs(static_cast<float>(i % 64) - 31.5f) < 9 ? 1.0f : 0.0f);
    }
}

TEST(DofLayers, TakeWhatIsNoNumberForWrongWhereverItSpreads) {
    for (const char* space : {"linear", "display"}) {
        DofRun run(paint([](float, float) { return 2.0f; })); // discs of radius 8
        estimate(run, [](float x, float y) {
            return x == 0.5f && y == 0.5f ? std::numeric_limits<float>::quiet_NaN() : 0.5f;
        });
        const std::vector<vec2> error = errorOf(run.param("space", space));
        EXPECT_EQ(error[32 * 64 + 32], vec2(1)) << space;
        EXPECT_EQ(error[32 * 64 + 36], vec2(1)) << space;
        EXPECT_EQ(error[32 * 64 + 44], vec2(0)) << space;
    }
}

TEST(DofLayers, ExpectNothingOfWhatIsInFocus) {
    DofRun run(paint([](float, float) { return 4.0f; }));
    estimate(run, speckle);
    for (const vec2& error : errorOf(run))
        EXPECT_EQ(error, vec2(0));
}

TEST(DofLayers, GrowAsContrastDoes) {
    std::vector<vec2> once, twice;
    for (const float contrast : {1.0f, 2.0f}) {
        DofRun run(edge());
        estimate(run, [&](float x, float y) { return contrast * speckle(x, y); });
        (contrast == 1 ? once : twice) = errorOf(run.param("least", 0.0f));
    }
    for (uint i = 0; i < kPixels; ++i)
        EXPECT_NEAR(twice[i].x, 2 * once[i].x, 1e-5f) << i;
}

TEST(DofLayers, ExpectOfHiddenGroundWhatItVariesBesideIt) {
    // A sharp plane hides part of what is blurred over discs of radius 8 behind it: of a pixel at
    // distance x from the edge the share of a disc beyond x / 8. Speckles vary by 1/2.
    const std::vector<float> depth = paint([](float x, float) { return x < 0 ? 4.0f : 0.0f; });
    DofRun run(depth);
    estimate(run, speckle);
    const std::vector<vec2> error = errorOf(run);
    // Of the disc's about 201 pixels speckles' edges cross all; 2 * 0.3 * sqrt(16) / 201 * 1/2.
    const float loss = 0.006f;
    for (uint x = 33; x < 39; ++x) {
        float mean = 0;
        for (uint y = 20; y < 44; ++y)
            mean += error[y * 64 + x].x / 24;
        const float hidden = test::discBeyond((static_cast<float>(x) - 31.5f) / 8);
        EXPECT_NEAR(mean, 0.5f * hidden + loss, 0.03f) << x;
    }
    for (uint i = 0; i < kPixels; ++i)
        if (i % 64 < 32) {
            EXPECT_EQ(error[i].x, 0.0f) << "in focus";
        }
}

TEST(DofLayers, SayWhatTheyWantToLookAt) {
    DofRun run(edge());
    try {
        run.param("expect", "layers").execute();
        FAIL();
    } catch (const GraphError& error) {
        EXPECT_STREQ(error.what(),
                     "error.dof: \"expect\": \"layers\" looks at \"image\", which nothing is "
                     "connected to; connect what depth_of_field blurs");
    }
}

class DofErrorVulkan : public VulkanTest {};

TEST_F(DofErrorVulkan, EstimatesAsTheHostDoes) {
    const std::vector<float> depth = paint([](float x, float y) {
        return x > 20 ? 0.0f : x * y > 100 ? 2.0f : 5 + 0.05f * x;
    });
    const auto estimated = [&](PassRun&& run) {
        run.extent(kExtent).camera(kLens).plane("depth", depth);
        estimate(run, speckle);
        return errorOf(run.param("space", "display").param("taps", 441u));
    };
    const std::vector<vec2> host = estimated(PassRun(dofErrorPass()));
    const std::vector<vec2> vulkan = estimated(PassRun(dofErrorPass(), device()));
    for (uint i = 0; i < kPixels; ++i)
        EXPECT_LT(glm::distance(host[i], vulkan[i]), 2e-3f) << i;
}

/// How wrong the blurred image of posts() is, and what passes say of it.
struct Judged {
    std::vector<float> error, squared;
    std::vector<float> mask, layers, bound;
};

Judged judge(Device& device, float focus) {
    const Scene scene = test::posts();
    const Camera camera = test::lensCamera(0.4f, focus);
    const std::vector<vec3> truth = test::tracedMeans(scene, camera, kExtent, 256);
    PassRun raster(rasterPass(), device);
    raster.kernelsOnHost().extent(kExtent).scene(scene).camera(camera).execute();
    PassRun blur(depthOfFieldPass(), device);
    blur.kernelsOnHost().extent(kExtent).camera(camera).param("taps", 0u);
    blur.input("image", raster.value("color")).input("depth", raster.value("depth")).execute();
    Judged judged;
    for (const char* expect : {"mask", "layers"}) {
        PassRun error(dofErrorPass(), device);
        error.kernelsOnHost().extent(kExtent).camera(camera).param("expect", expect);
        error.param("space", "linear").param("taps", 0u);
        error.input("depth", raster.value("depth")).input("image", raster.value("color"));
        for (const vec2& value : errorOf(error)) {
            (expect[0] == 'm' ? judged.mask : judged.layers).push_back(value.x);
            if (expect[0] == 'm')
                judged.bound.push_back(value.y);
        }
    }
    const std::vector<vec3> color = blur.output<vec3>("color");
    for (uint i = 0; i < kPixels; ++i) {
        const vec3 difference = glm::abs(color[i] - truth[i]);
        judged.error.push_back(std::max({difference.x, difference.y, difference.z}));
        judged.squared.push_back(glm::dot(difference, difference));
    }
    return judged;
}

// The promise of the mask: what it spares is right. The posts are of one colour each, so that all
// that differs is what lies around their edges.
TEST_F(DofErrorVulkan, FlagsWhateverTheBlurGotWrong) {
    for (const float focus : {2.5f, 5.0f, 9.0f}) {
        const Judged judged = judge(device(), focus);
        const Detection detection = detect(judged.error, judged.bound, 2.0f / 255);
        EXPECT_GT(detection.positives, 0.02) << "focus " << focus;
        EXPECT_EQ(detection.recall, 1.0) << "focus " << focus;
    }
}

TEST_F(DofErrorVulkan, OrdersByLayersFarBetterThanByTheMask) {
    for (const float focus : {2.5f, 5.0f, 9.0f}) {
        const Judged judged = judge(device(), focus);
        const Convergence oracle = convergeOracle(judged.squared, {});
        const double mask = gain(converge(judged.squared, judged.mask, {}), oracle);
        const double layers = gain(converge(judged.squared, judged.layers, {}), oracle);
        // Posts of two or three pixels: which way an edge between pixels is off, nobody can say.
        EXPECT_GT(layers, 0.5) << "focus " << focus;
        EXPECT_GT(layers, mask + 0.1) << "focus " << focus;
    }
}

} // namespace
} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/support/each_build.h"

#include <gtest/gtest.h>

#include <limits>

namespace hone {
namespace {

class TonemapTest : public EachBuild {
protected:
    /// The red of a pixel of this radiance.
    static float shown(float radiance, float exposure = 1, const char* curve = "clip") {
        PassRun run = pass(tonemapPass());
        run.extent({1, 1}).param("exposure", exposure).param("curve", curve);
        return run.plane<vec3>("color", {{radiance, 0, 0}}).execute().output<vec3>("display")[0].x;
    }
};
HONE_ON_EACH_BUILD(TonemapTest);

TEST_P(TonemapTest, EncodesAsSrgb) {
    EXPECT_EQ(shown(0), 0.0f);
    EXPECT_FLOAT_EQ(shown(0.002f), 0.02584f);    // 12.92 x
    EXPECT_NEAR(shown(0.25f), 0.537099f, 1e-6f); // 1.055 * 0.25^(1 / 2.4) - 0.055
    EXPECT_NEAR(shown(1), 1.0f, 1e-6f);
}

TEST_P(TonemapTest, ExposesBeforeItEncodes) {
    EXPECT_FLOAT_EQ(shown(0.008f, 0.25f), 0.02584f);
    EXPECT_EQ(shown(5, 0), 0.0f);
}

TEST_P(TonemapTest, CompressesHighlightsWithWhiteAtFour) {
    const char* const curve = "reinhard";
    EXPECT_FLOAT_EQ(shown(0.002f, 1, curve), 12.92f * 0.00199625748f); // x (1 + x / 16) / (1 + x)
    EXPECT_NEAR(shown(1, 1, curve), 0.755575f, 1e-6f);                 // of 17 / 32
    EXPECT_LT(shown(3.9f, 1, curve), 1.0f);
    EXPECT_NEAR(shown(4, 1, curve), 1.0f, 1e-6f);
}

TEST_P(TonemapTest, TreatsEachChannelAlone) {
    PassRun run = pass(tonemapPass());
    run.extent({2, 1}).plane<vec3>("color", {{0.001f, 0.002f, 0.003f}, {9, 0.002f, -1}}).execute();
    const std::vector<vec3> display = run.output<vec3>("display");
    EXPECT_FLOAT_EQ(display[0].x, 0.01292f);
    EXPECT_FLOAT_EQ(display[0].y, 0.02584f);
    EXPECT_FLOAT_EQ(display[0].z, 0.03876f);
    EXPECT_EQ(display[1].y, display[0].y) << "though its neighbour is white";
}

TEST_P(TonemapTest, ShowsWhatIsBrighterThanWhiteAsWhiteAndWhatIsNoNumberAsBlack) {
    constexpr float kMost = std::numeric_limits<float>::max();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (const char* curve : {"clip", "reinhard"}) {
        for (const float bright : {5.0f, 1e20f, kMost, kInfinity})
            EXPECT_EQ(shown(bright, 1, curve), shown(4, 1, curve)) << curve << " " << bright;
        EXPECT_EQ(shown(kMost, kMost, curve), shown(4, 1, curve)) << curve;
        for (const float dark : {-1.0f, -kInfinity, std::numeric_limits<float>::quiet_NaN()})
            EXPECT_EQ(shown(dark, 1, curve), 0.0f) << curve << " " << dark;
    }
}

} // namespace
} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/support/each_build.h"
#include "hone/tests/support/shadow_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace hone {
namespace {

using namespace test;

constexpr uint kMapSize = 512;

class Kbm10Error : public EachRasterBuild {
protected:
    static constexpr uvec2 kExtent{128, 128};

    /// The error of each pixel, by the maps of the scene's lights.
    std::vector<vec2> errorOf(const Scene& scene, const Camera& camera, uint points = 5,
                              uint dilation = 2, bool include_umbra = false) {
        PassRun maps = pass(shadowMapPass());
        maps.scene(scene).param("size", kMapSize).param("points", points).execute();
        PassRun raster = pass(rasterPass());
        raster.extent(kExtent).scene(scene).camera(camera).execute();
        PassRun error = pass(kbm10ErrorPass());
        error.extent(kExtent).scene(scene).camera(camera);
        error.param("dilation", dilation).param("include_umbra", include_umbra);
        error.input("gbuffer", raster.value("gbuffer"));
        error.input("shadow_maps", maps.value("maps")).execute();
        return error.output<vec2>("error");
    }
};

HONE_ON_EACH_BUILD(Kbm10Error);

TEST_P(Kbm10Error, FlagsThePenumbraOfAStraightEdge) {
    // The penumbra is L h / (H - h) = 4/3 wide: |x| <= 2/3.
    const std::vector<vec2> error = errorOf(edgeOverFloor(lampOf()), lookingDown());
    const float pixel = 7.0f / 128;
    const float texel = 2 * 10.0f / kMapSize;
    for (uint i = 0; i < error.size(); ++i) {
        const float x = (static_cast<float>(i % 128) + 0.5f) * pixel - 3.5f;
        EXPECT_EQ(error[i].x, error[i].y);
        if (std::abs(x) < 0.6667f - texel) {
            EXPECT_EQ(error[i].x, 1.0f) << "x = " << x;
        }
        // 3 x 3 texels, the receiver's offset, and the dilation of two pixels.
        if (std::abs(x) > 0.6667f + 3 * texel + 3 * pixel) {
            EXPECT_EQ(error[i].x, 0.0f) << "x = " << x;
        }
    }
}

TEST_P(Kbm10Error, FlagsTheEdgeOfAMapAroundAPointLight) {
    Scene scene = edgeOverFloor(lampOf());
    scene.lights[0].kind = kLightPoint;
    const std::vector<vec2> error = errorOf(scene, lookingDown(), 1, 0);
    const float pixel = 7.0f / 128;
    const float texel = 2 * 10.0f / kMapSize;
    for (uint i = 0; i < error.size(); ++i) {
        const float x = (static_cast<float>(i % 128) + 0.5f) * pixel - 3.5f;
        // The edge falls on x = 0; a map's edge lies up to a texel from it.
        if (std::abs(x) < 0.5f * texel) {
            EXPECT_EQ(error[i].x, 1.0f) << "x = " << x;
        }
        if (std::abs(x) > 3 * texel) {
            EXPECT_EQ(error[i].x, 0.0f) << "x = " << x;
        }
    }
}

TEST_P(Kbm10Error, DilatesByPixelsToEachSide) {
    const std::vector<vec2> narrow = errorOf(edgeOverFloor(lampOf()), lookingDown(), 5, 0);
    const std::vector<vec2> wide = errorOf(edgeOverFloor(lampOf()), lookingDown(), 5, 3);
    // Along the middle row.
    uint narrow_count = 0, wide_count = 0;
    for (uint x = 0; x < 128; ++x) {
        narrow_count += narrow[64 * 128 + x].x > 0 ? 1u : 0u;
        wide_count += wide[64 * 128 + x].x > 0 ? 1u : 0u;
    }
    EXPECT_EQ(wide_count, narrow_count + 6);
}

TEST_P(Kbm10Error, FlagsTheUmbraWhenAsked) {
    const std::vector<vec2> error = errorOf(edgeOverFloor(lampOf()), lookingDown(), 5, 0, true);
    EXPECT_EQ(error[64 * 128 + 10].x, 1.0f) << "in the umbra";
    EXPECT_EQ(error[64 * 128 + 117].x, 0.0f) << "in the light";
}

TEST_P(Kbm10Error, IsNothingOnALitFloor) {
    SceneBuilder builder;
    addSquare(builder, vec3(0), vec3(1, 0, 0), vec3(0, 0, -1));
    Scene scene = builder.finish();
    scene.lights = {lampOf()};
    for (const vec2& error : errorOf(scene, lookingDown()))
        EXPECT_EQ(error, vec2(0.0f));
}

TEST_P(Kbm10Error, IsNothingOnAReceiverSlantedBy80Degrees) {
    // Its own neighbours in the map must not count as what blocks it, whichever way it leans.
    for (float turn : {0.0f, 0.4f, 0.785398f}) {
        const float angle = 80 * 0.017453293f;
        const vec3 down_the_slope(std::cos(angle) * std::cos(turn), -std::sin(angle),
                                  std::cos(angle) * std::sin(turn));
        const vec3 across(-std::sin(turn), 0, std::cos(turn));
        SceneBuilder builder;
        addSquare(builder, vec3(0), down_the_slope, across);
        Scene scene = builder.finish();
        scene.lights = {lampOf()};
        const vec3 normal = glm::cross(across, down_the_slope);
        const vec3 seen_from = normal.y > 0 ? normal : -normal;
        const Camera camera = cameraAt(3.0f * seen_from, -seen_from, across);
        uint flagged = 0;
        for (const vec2& error : errorOf(scene, camera))
            flagged += error.x > 0 ? 1u : 0u;
        EXPECT_EQ(flagged, 0u) << "turned by " << turn;
    }
}

TEST_P(Kbm10Error, IsNothingWhereNoLightCanArrive) {
    // From below, the floor turns its back to the lamp; the half-plane's shadow does not matter.
    const Camera camera = cameraAt({0, -3.5f, 0}, {0, 1, 0}, {0, 0, -1});
    for (const vec2& error : errorOf(edgeOverFloor(lampOf()), camera))
        EXPECT_EQ(error, vec2(0.0f));
}

} // namespace
} // namespace hone

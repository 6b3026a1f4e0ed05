// SPDX-License-Identifier: Apache-2.0
#include "hone/core/error.h"
#include "hone/passes/passes.h"
#include "hone/tests/support/run_pass.h"
#include "hone/tests/support/shadow_scenes.h"
#include "hone/tests/support/vulkan_fixture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <vector>

namespace hone {
namespace {

using namespace test;

constexpr uint kMapSize = 512;
constexpr float kTexel = 2 * 10.0f / kMapSize; // on the floor
constexpr float kPixel = 7.0f / 128;

using Params = std::map<std::string_view, ParamValue>;
const Params kPaper{{"magnitude", std::string("binary")}, {"certified", false}, {"retest", false}};
const Params kBinary{{"magnitude", std::string("binary")}};
const Params kDetailed{{"detail", 16u}};

/// Once with kernels on the host, once on the Vulkan device.
class ShadowError : public VulkanTest, public testing::WithParamInterface<bool> {
protected:
    static constexpr uvec2 kExtent{128, 128};

    std::vector<vec2> errorOf(const Scene& scene, const Camera& camera, const Params& params = {},
                              const char* query = "nbuffer") {
        PassRun maps(shadowMapPass(), device()), ranges(shadowRangePass(), device());
        PassRun raster(rasterPass(), device()), error(shadowErrorPass(), device());
        for (PassRun* run : {&maps, &ranges, &raster, &error}) {
            run->extent(kExtent).scene(scene).camera(camera);
            if (GetParam())
                run->kernelsOnHost();
        }
        maps.param("size", kMapSize).param("points", 1u).execute();
        ranges.param("size", kMapSize).param("query", query);
        ranges.input("shadow_maps", maps.value("maps")).execute();
        raster.input("shadow_maps", maps.value("maps")).execute();
        for (const auto& [name, value] : params)
            error.param(name, value);
        error.input("shadow_maps", maps.value("maps"));
        error.input("shadow_ranges", ranges.value("ranges"));
        return error.input("gbuffer", raster.value("gbuffer")).execute().output<vec2>("error");
    }
};
INSTANTIATE_TEST_SUITE_P(Kernels, ShadowError, testing::Values(true, false),
                         [](const auto& each) { return each.param ? "OnHost" : "OnDevice"; });

/// Across the image from -3.5 to 3.5.
float acrossImage(std::size_t pixel_coordinate) {
    return (static_cast<float>(pixel_coordinate) + 0.5f) * kPixel - 3.5f;
}

uint flagged(const std::vector<vec2>& error) {
    uint count = 0;
    for (const vec2& pixel : error)
        count += pixel.y > 0 ? 1u : 0u;
    return count;
}

/// What a white floor sends from `x` beside a lamp over `center`, nothing in between, seen from
/// anywhere.
float unshadowed(const Light& light, vec3 point) {
    const float pi = 3.14159265f;
    if (light.kind == kLightDirectional)
        return 1 / pi;
    const vec3 to_light = light.position - point;
    const float squared = glm::dot(to_light, to_light);
    const float cosine = to_light.y / std::sqrt(squared);
    const float area = light.kind == kLightRectangle ? 4.0f : pi;
    return area * cosine * (light.kind == kLightSphere ? 1 : cosine) / squared / pi;
}

/// Flags exactly |x| <= half, up to `rim` outside and a texel inside.
void expectFlagged(const std::vector<vec2>& error, float half, float texel, float rim) {
    for (std::size_t i = 0; i < error.size(); ++i) {
        const float x = acrossImage(i % 128);
        EXPECT_EQ(error[i].x, error[i].y);
        if (std::abs(x) < half - texel) {
            EXPECT_EQ(error[i].x, 1.0f) << "x = " << x;
        }
        if (std::abs(x) > half + rim) {
            EXPECT_EQ(error[i].x, 0.0f) << "x = " << x;
        }
    }
}

TEST_P(ShadowError, FlagsThePenumbraOfAStraightEdge) {
    // L h / (H - h) = 4/3 wide. To each side 1.5 texels count, and cells hold two; certified, the
    // occluder's end is seen from the cell before it.
    const Scene scene = edgeOverFloor(lampOf());
    expectFlagged(errorOf(scene, lookingDown(), kPaper), 0.6667f, kTexel, 2.5f * kTexel);
    expectFlagged(errorOf(scene, lookingDown(), kBinary), 0.6667f, kTexel, 4.5f * kTexel);
}

TEST_P(ShadowError, FlagsThePenumbraOfTheSun) {
    // 4 * 2 * 0.1 wide; the map is a box around the scene: x in [-40, 20], y in [0, 4], z in +-20.
    const Scene scene = edgeOverFloor(lampOf(kLightDirectional));
    const float texel = 2 * std::sqrt(30.0f * 30 + 2 * 2 + 20 * 20) / kMapSize;
    expectFlagged(errorOf(scene, lookingDown(), kPaper), 0.4f, texel, 2.5f * texel);
}

TEST_P(ShadowError, RefusesRangesOfOtherMaps) {
    const Scene scene = edgeOverFloor(lampOf());
    PassRun maps(shadowMapPass(), device()), small(shadowMapPass(), device());
    PassRun ranges(shadowRangePass(), device()), raster(rasterPass(), device());
    PassRun error(shadowErrorPass(), device());
    for (PassRun* run : {&maps, &small, &ranges, &raster, &error}) {
        run->extent(kExtent).scene(scene).camera(lookingDown());
        if (GetParam())
            run->kernelsOnHost();
    }
    maps.param("size", 64u).execute();
    ranges.param("size", 16u)
        .input("shadow_maps", small.param("size", 16u).execute().value("maps"));
    raster.execute();
    error.input("shadow_maps", maps.value("maps")).input("gbuffer", raster.value("gbuffer"));
    error.input("shadow_ranges", ranges.execute().value("ranges"));
    try {
        error.execute();
        FAIL() << "nothing was thrown";
    } catch (const GraphError& wrong) {
        EXPECT_STREQ(wrong.what(),
                     "error.shadow: the shadow maps have faces of 64 texels, but the shadow ranges "
                     "were made of maps with 16; connect the maps that pass shadow_range reads");
    }
}

TEST_P(ShadowError, FlagsMoreFromWiderBlocksOfThePyramid) {
    const Scene scene = edgeOverFloor(lampOf());
    const std::vector<vec2> exact = errorOf(scene, lookingDown(), kBinary, "nbuffer");
    const std::vector<vec2> wider = errorOf(scene, lookingDown(), kBinary, "hsm");
    Params unsplit = kBinary;
    unsplit["retest"] = false;
    const std::vector<vec2> widest = errorOf(scene, lookingDown(), unsplit, "hsm");
    for (std::size_t i = 0; i < exact.size(); ++i) {
        EXPECT_LE(exact[i].x, wider[i].x);
        EXPECT_LE(wider[i].x, widest[i].x);
    }
    // An eighth of the area's width to each side instead of half.
    EXPECT_LT(flagged(wider), 1.4 * flagged(exact));
    EXPECT_GT(flagged(widest), 1.4 * flagged(exact));
}

TEST_P(ShadowError, FlagsMoreFromOneUnrefinedSearch) {
    // The first area is taken at depth 1.5: |x| <= L / 2 (H / 1.5 - 1) = 5.6667. On the dark side
    // it reaches over the edge of the map's face, which decides nothing.
    Params unrefined = kPaper;
    unrefined["iterations"] = 0u;
    unrefined["near"] = 1.5f;
    Camera camera = lookingDown();
    camera.tan_half_fov_y = 2; // sees +-7
    const std::vector<vec2> error = errorOf(edgeOverFloor(lampOf()), camera, unrefined);
    for (std::size_t i = 64 * 128; i < 65 * 128; ++i) {
        const float x = 2 * acrossImage(i % 128);
        if (std::abs(x) < 5.6667f - kTexel) {
            EXPECT_EQ(error[i].x, 1.0f) << "x = " << x;
        }
        if (x > 5.6667f + 2 * kTexel) {
            EXPECT_EQ(error[i].x, 0.0f) << "x = " << x;
        }
    }
}

Light turned(Light light, float angle) {
    light.half_u = vec3(std::cos(angle), 0, std::sin(angle));
    light.half_v = vec3(-std::sin(angle), 0, std::cos(angle));
    return light;
}

TEST_P(ShadowError, EstimatesTheShareThatIsSeen) {
    // Under the lamp, and where the map's faces meet: 45 degrees from it, at x = 10.
    const struct {
        Light light;
        float edge, middle;
    } cases[] = {{lampOf(), 0, 0},
                 {lampOf(kLightDisc), 0, 0},
                 {lampOf(kLightSphere), 0, 0},
                 {lampOf(kLightDirectional), 0, 0},
                 {lampOf(), 6, 10},
                 {lampOf(kLightSphere), 6, 10}};
    for (const auto& each : cases) {
        const std::vector<vec2> error =
            errorOf(edgeOverFloor(each.light, each.edge), lookingDown(each.middle), kDetailed);
        for (std::size_t column = 0; column < 128; column += 3) {
            const float x = each.middle + acrossImage(column);
            const float z = 0.5f * kPixel;
            const float visible = visibleBesideEdge(each.light, each.edge, x, z);
            const float drawn = x > each.middle ? 1.0f : 0.0f;
            const vec2 share = error[64 * 128 + column] / unshadowed(each.light, {x, 0, z});
            if (std::abs(x - each.middle) < kTexel)
                continue; // the map may draw either
            // Half a cell of the mask, and a texel of the map, of a penumbra of 4/3 or 0.8.
            EXPECT_NEAR(share.x, std::abs(visible - drawn), 1 / 32.0f + kTexel / 0.8f)
                << "kind " << each.light.kind << ", x = " << x;
            if (visible > 0.001f && visible < 0.999f) {
                EXPECT_NEAR(share.y, 1.0f, 1e-3f) << x;
            }
        }
    }
}

TEST_P(ShadowError, EstimatesTheShareOfATurnedLight) {
    const Light light = turned(lampOf(), 0.5f);
    const std::vector<vec2> error = errorOf(edgeOverFloor(light), lookingDown(), kDetailed);
    for (std::size_t column = 0; column < 128; column += 3) {
        const float x = acrossImage(column);
        if (std::abs(x) < kTexel)
            continue;
        const float visible = visibleBesideEdge(light, 0, x, 0.5f * kPixel);
        const float share = error[64 * 128 + column].x / unshadowed(light, {x, 0, 0});
        EXPECT_NEAR(share, std::abs(visible - (x > 0 ? 1.0f : 0.0f)), 0.04f) << "x = " << x;
    }
}

/// Two occluders that only together hide the lamp from its centre (SCIENCE 9.6).
Scene counterexample() {
    SceneBuilder builder;
    addSquare(builder, vec3(0), vec3(1, 0, 0), vec3(0, 0, -1));
    addSquare(builder, vec3(0.134f - 20, 8, 0), vec3(1, 0, 0), vec3(0, 0, -1));
    const vec3 low[] = {{0.4f, 4, 20}, {2.8f, 4, 20}, {2.8f, 4, -20}, {0.4f, 4, -20}};
    const uvec3 triangles[] = {{0, 1, 2}, {0, 2, 3}};
    builder.add(low, triangles, builder.addMaterial(plainMaterial(kMaterialTwoSided)));
    Scene scene = builder.finish();
    scene.lights = {lampOf()};
    return scene;
}

TEST_P(ShadowError, TakesAGapBetweenOccludersForUmbraUnlessCertified) {
    // From x = 0.027 the lamp is seen from (0.134 - 0.2 x) / 0.8 to (0.4 - 0.6 x) / 0.4.
    const std::size_t pixel = 64 * 128 + 64;
    const float x = acrossImage(64);
    const float visible = 0.5f * ((0.4f - 0.6f * x) / 0.4f - (0.134f - 0.2f * x) / 0.8f);
    EXPECT_NEAR(visible, 0.41625f, 0.02f) << "at x = 0";
    EXPECT_EQ(errorOf(counterexample(), lookingDown(), kPaper)[pixel], vec2(0.0f));
    for (const char* query : {"hsm", "nbuffer"}) {
        Params certified = kPaper;
        certified["certified"] = true;
        EXPECT_EQ(errorOf(counterexample(), lookingDown(), certified, query)[pixel], vec2(1.0f));
        const vec2 error = errorOf(counterexample(), lookingDown(), kDetailed, query)[pixel];
        const float lit = unshadowed(lampOf(), {x, 0, 0});
        EXPECT_NEAR(error.x / lit, visible, 1 / 32.0f + kTexel);
        EXPECT_NEAR(error.y / lit, 1.0f, 1e-3f);
    }
}

TEST_P(ShadowError, FlagsTheEdgeOfAMapAroundAPointLight) {
    const std::vector<vec2> error =
        errorOf(edgeOverFloor(lampOf(kLightPoint)), lookingDown(), kBinary);
    expectFlagged(error, 1.5f * kTexel, kTexel, 3 * kTexel);
}

TEST_P(ShadowError, IsNothingOnALitFloor) {
    SceneBuilder builder;
    addSquare(builder, vec3(0), vec3(1, 0, 0), vec3(0, 0, -1));
    Scene scene = builder.finish();
    for (uint kind : {kLightRectangle, kLightDisc, kLightSphere, kLightDirectional, kLightPoint}) {
        scene.lights = {lampOf(kind)};
        EXPECT_EQ(flagged(errorOf(scene, lookingDown(), kBinary)), 0u) << kind;
        EXPECT_EQ(flagged(errorOf(scene, lookingDown(9))), 0u) << kind;
    }
}

TEST_P(ShadowError, IsNothingOnAReceiverSlantedBy80Degrees) {
    // Its own neighbours in the map must not count as what blocks it, whichever way it leans.
    for (float turn : {0.0f, 0.4f, 0.785398f}) {
        const float angle = 80 * 0.017453293f;
        const vec3 down_the_slope(std::cos(angle) * std::cos(turn), -std::sin(angle),
                                  std::cos(angle) * std::sin(turn));
        const vec3 along(-std::sin(turn), 0, std::cos(turn));
        SceneBuilder builder;
        addSquare(builder, vec3(0), down_the_slope, along);
        Scene scene = builder.finish();
        scene.lights = {lampOf()};
        const vec3 normal = glm::cross(along, down_the_slope);
        const vec3 seen_from = normal.y > 0 ? normal : -normal;
        const Camera camera = cameraAt(3.0f * seen_from, -seen_from, along);
        EXPECT_EQ(flagged(errorOf(scene, camera)), 0u) << "turned by " << turn;
    }
}

TEST_P(ShadowError, CountsWhatTheHorizonHides) {
    // A wall at x = -0.5 sees what of the lamp is before its plane: x in [-0.5, 1], three quarters.
    SceneBuilder builder;
    addSquare(builder, vec3(-0.5f, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1));
    Scene scene = builder.finish();
    scene.lights = {lampOf()};
    const Camera camera = cameraAt({3, 0, 0}, {-1, 0, 0}, {0, 1, 0});
    const std::vector<vec2> error = errorOf(scene, camera);
    // The middle's cosine at the wall is 0.5 / d, at the lamp 10 / d.
    const float squared = 0.25f + 100;
    const float lit = 4 * 0.5f * 10 / (squared * squared) / 3.14159265f;
    EXPECT_NEAR(error[64 * 128 + 64].x / lit, 0.25f, 1 / 32.0f);
    EXPECT_NEAR(error[64 * 128 + 64].y / lit, 1.0f, 0.05f);
}

TEST_P(ShadowError, IsNothingWhereNoLightCanArrive) {
    // From below, the floor turns its back to the lamp; the half-plane's shadow does not matter.
    const Camera camera = cameraAt({0, -3.5f, 0}, {0, 1, 0}, {0, 0, -1});
    EXPECT_EQ(flagged(errorOf(edgeOverFloor(lampOf()), camera)), 0u);
}

TEST_P(ShadowError, IsNothingForLightsThatNothingBlocks) {
    Scene scene = edgeOverFloor(lampOf());
    scene.lights = {lampOf(), lampOf(kLightDisc)};
    const uint both = flagged(errorOf(scene, lookingDown()));
    scene.lights[0].shadowless = 1;
    EXPECT_GT(both, 0u);
    EXPECT_EQ(flagged(errorOf(scene, lookingDown(), kBinary)),
              flagged(errorOf(edgeOverFloor(lampOf(kLightDisc)), lookingDown(), kBinary)));
    scene.lights[1].shadowless = 1;
    EXPECT_EQ(flagged(errorOf(scene, lookingDown())), 0u);
}

TEST_P(ShadowError, AddsWhatSeveralLightsMayBeWrongBy) {
    Scene scene = edgeOverFloor(lampOf());
    const std::vector<vec2> once = errorOf(scene, lookingDown());
    scene.lights = {lampOf(), lampOf()};
    const std::vector<vec2> twice = errorOf(scene, lookingDown());
    for (std::size_t i = 0; i < once.size(); ++i)
        EXPECT_EQ(twice[i], 2.0f * once[i]);
    EXPECT_EQ(flagged(errorOf(scene, lookingDown(), kBinary)), flagged(once));
}

TEST_P(ShadowError, IsFiniteForALightThatIsNot) {
    for (float intensity :
         {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
        Scene scene = edgeOverFloor(lampOf());
        scene.lights[0].intensity = vec3(intensity);
        for (const vec2& error : errorOf(scene, lookingDown())) {
            EXPECT_TRUE(error.x >= 0 && error.x <= error.y && error.y <= 1);
        }
    }
}

} // namespace
} // namespace hone

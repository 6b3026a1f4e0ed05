// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/passes.h"
#include "hone/tests/support/run_pass.h"
#include "hone/tests/support/scene_builder.h"
#include "hone/tests/support/vulkan_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace hone {
namespace {

constexpr float kRadians = 0.017453293f;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Material mirror(float f0) {
    Material material = test::plainMaterial(kMaterialMirror | kMaterialTwoSided);
    material.f0 = vec3(f0);
    return material;
}

/// One pixel that looks along -z from the origin.
Camera straightAhead() {
    Camera camera{};
    camera.forward = vec3(0, 0, -1);
    camera.right = vec3(1, 0, 0);
    camera.up = vec3(0, 1, 0);
    camera.tan_half_fov_y = 1.0f;
    camera.near = 0.01f;
    return camera;
}

/// A triangle of a mirror sphere of radius 1 whose first vertex is what the pixel sees, with the
/// sphere's normal theta away from the direction to the eye. The probe is at the sphere's centre.
/// All corners are on the sphere, as are those of any tessellation.
Scene sphereAt(float theta, float f0 = 1.0f) {
    const vec3 normal(std::sin(theta), 0, std::cos(theta));
    const vec3 seen(0, 0, -5);
    const vec3 center = seen - normal;
    test::SceneBuilder builder;
    const vec3 positions[] = {seen, center + vec3(0, 1, 0), center + vec3(-1, 0, 0)};
    const uvec3 triangles[] = {{0, 1, 2}};
    builder.add(positions, triangles, builder.addMaterial(mirror(f0)));
    Scene scene = builder.finish();
    std::ranges::fill(scene.normals, normal);
    scene.probes = {{center, 0}};
    scene.instances[0].probe = 0;
    return scene;
}

float errorOf(const Scene& scene, uint metric, const char* orientation = "corrected") {
    const Camera camera = straightAhead();
    PassRun run(reflectionErrorPass());
    run.extent({1, 1}).scene(scene).camera(camera);
    run.param("metric", metric).param("orientation", std::string(orientation));
    run.plane<Hit>("gbuffer", {{0, 0}}).execute();
    const vec2 error = run.output<vec2>("error").front();
    EXPECT_EQ(error.x, error.y) << "expect and bound are the paper's one number";
    return error.x;
}

// SCIENCE 9.1, mirror sphere of radius 1 with the probe at its centre.
TEST(ReflectionError, OfASphereWithCentredProbeIsGreatestInDistanceEverywhere) {
    for (float degrees : {0.0f, 30.0f, 60.0f, 90.0f})
        EXPECT_NEAR(errorOf(sphereAt(degrees * kRadians), 2), 1.0f, 1e-5f) << degrees;
}

TEST(ReflectionError, OfTheReflectedAngleIsTheSquaredSineOfTheIncidentAngle) {
    EXPECT_NEAR(errorOf(sphereAt(0.0f), 3), 0.0f, 1e-5f);
    EXPECT_NEAR(errorOf(sphereAt(30 * kRadians), 3), 0.25f, 1e-5f);
    EXPECT_NEAR(errorOf(sphereAt(60 * kRadians), 3), 0.75f, 1e-5f);
    EXPECT_NEAR(errorOf(sphereAt(90 * kRadians), 3), 1.0f, 1e-5f);
}

TEST(ReflectionError, OfTheNormalGrowsAsTheCosineFalls) {
    EXPECT_NEAR(errorOf(sphereAt(0.0f), 4), 0.0f, 1e-5f);
    EXPECT_NEAR(errorOf(sphereAt(30 * kRadians), 4), 0.13397f, 1e-5f);
    EXPECT_NEAR(errorOf(sphereAt(60 * kRadians), 4), 0.5f, 1e-5f);
    EXPECT_NEAR(errorOf(sphereAt(90 * kRadians), 4), 1.0f, 1e-5f);
}

TEST(ReflectionError, AsPrintedIsGreatestWhereTheLookupIsExact) {
    EXPECT_NEAR(errorOf(sphereAt(0.0f), 3, "as_printed"), 1.0f, 1e-5f);
    EXPECT_NEAR(errorOf(sphereAt(0.0f), 4, "as_printed"), 1.0f, 1e-5f);
    EXPECT_NEAR(errorOf(sphereAt(30 * kRadians), 3, "as_printed"), 0.5f, 1e-5f);
    EXPECT_NEAR(errorOf(sphereAt(30 * kRadians), 4, "as_printed"), 0.8660f, 1e-4f);
    EXPECT_NEAR(errorOf(sphereAt(60 * kRadians), 3, "as_printed"), 0.0f, 1e-5f);
    EXPECT_NEAR(errorOf(sphereAt(60 * kRadians), 4, "as_printed"), 0.5f, 1e-5f);
}

TEST(ReflectionError, OfReflectedAngleAndNormalRankAlike) {
    // Both rise with theta, so any set of angles is ordered alike.
    std::vector<float> third, fourth;
    for (int k = 0; k < 40; ++k) {
        const float theta = 90.0f * kRadians * static_cast<float>(k * 17 % 40) / 40.0f;
        third.push_back(errorOf(sphereAt(theta), 3));
        fourth.push_back(errorOf(sphereAt(theta), 4));
    }
    auto ranking = [](const std::vector<float>& values) {
        std::vector<std::size_t> order(values.size());
        std::iota(order.begin(), order.end(), 0u);
        std::ranges::stable_sort(order, {}, [&](std::size_t i) { return values[i]; });
        return order;
    };
    EXPECT_EQ(ranking(third), ranking(fourth));
}

TEST(ReflectionError, OfTheFirstKindIsOneWhereAMirrorReflects) {
    EXPECT_EQ(errorOf(sphereAt(30 * kRadians), 1), 1.0f);
}

TEST(ReflectionError, IsNothingAtTheProbeItself) {
    // SCIENCE 9.2: the probe at the shaded point.
    Scene scene = sphereAt(30 * kRadians);
    scene.probes[0].position = vec3(0, 0, -5);
    EXPECT_NEAR(errorOf(scene, 2), 0.0f, 1e-6f);
}

TEST(ReflectionError, OfAPlanarMirrorIsThereInDistanceThoughNotInAngle) {
    // SCIENCE 9.3: a mirror 4 x 4 seen at its middle, the probe 1 in front of it. The lookup is
    // exact, metric 2 says |p-c| / M = 1 / sqrt(2^2 + 2^2 + 1) = 1/3 all the same.
    test::SceneBuilder builder;
    const vec3 positions[] = {{-2, -2, -5}, {2, -2, -5}, {2, 2, -5}, {-2, 2, -5}};
    const uvec3 triangles[] = {{0, 1, 2}, {0, 2, 3}};
    builder.add(positions, triangles, builder.addMaterial(mirror(1.0f)));
    Scene scene = builder.finish();
    scene.probes = {{vec3(0, 0, -4), 0}};
    scene.instances[0].probe = 0;
    EXPECT_NEAR(errorOf(scene, 2), 1.0f / 3.0f, 1e-6f);
    EXPECT_NEAR(errorOf(scene, 4), 0.0f, 1e-6f);
}

TEST(ReflectionError, MeasuresDistanceAgainstTheSceneWhenAsked) {
    const Scene scene = sphereAt(30 * kRadians);
    const Camera camera = straightAhead();
    PassRun run(reflectionErrorPass());
    run.extent({1, 1}).scene(scene).camera(camera);
    run.param("metric", 2u).param("max_distance", std::string("scene"));
    run.plane<Hit>("gbuffer", {{0, 0}}).execute();
    const float half_diagonal = 0.5f * glm::distance(scene.bounds.low, scene.bounds.high);
    EXPECT_NEAR(run.output<vec2>("error").front().x, std::min(1.0f / half_diagonal, 1.0f), 1e-5f);
}

TEST(ReflectionError, MeasuresDistanceAgainstTheFarthestPixelWhenAsked) {
    // Three pixels side by side on a mirror 5 away, the probe on the middle one: x = -10/3, 0, 10/3
    // with 3 x 1 pixels of tangent 1.
    test::SceneBuilder builder;
    const vec3 positions[] = {{-20, -9, -5}, {20, -9, -5}, {20, 9, -5}, {-20, 9, -5}};
    const uvec3 triangles[] = {{0, 1, 2}, {0, 2, 3}};
    builder.add(positions, triangles, builder.addMaterial(mirror(1.0f)));
    Scene scene = builder.finish();
    scene.probes = {{vec3(0, 0, -5), 0}};
    scene.instances[0].probe = 0;
    PassRun run(reflectionErrorPass());
    run.extent({3, 1}).scene(scene).camera(straightAhead());
    run.param("metric", 2u).param("max_distance", std::string("visible"));
    run.plane<Hit>("gbuffer", {{0, 1}, {0, 0}, {0, 0}}).execute();
    const std::vector<vec2> error = run.output<vec2>("error");
    EXPECT_EQ(error[0].x, 1.0f);
    EXPECT_NEAR(error[1].x, 0.0f, 1e-6f);
    EXPECT_EQ(error[2].x, 1.0f);

    // The farthest gone from the image, another is.
    run.plane<Hit>("gbuffer", {{kNone, kNone}, {0, 0}, {kNone, kNone}}).execute();
    EXPECT_EQ(run.output<vec2>("error")[0], vec2(0.0f));
}

/// A probe's map of 2 x 2 texels a face, which sees that far along +x, and 5 everywhere else.
std::vector<vec4> mapsOf(float along_x) {
    std::vector<vec4> maps(1 + 6 * 4, vec4(0, 0, 0, 5));
    maps[0] = vec4(2, 1, 0, 0);
    for (std::size_t texel = 1; texel <= 4; ++texel)
        maps[texel].w = along_x;
    return maps;
}

float errorAgainstProbe(const std::vector<vec4>& maps) {
    const Scene scene = sphereAt(30 * kRadians);
    PassRun run(reflectionErrorPass());
    run.extent({1, 1}).scene(scene).camera(straightAhead());
    run.param("metric", 2u).param("max_distance", std::string("probe"));
    run.list("environment_maps", maps).plane<Hit>("gbuffer", {{0, 0}}).execute();
    return run.output<vec2>("error").front().x;
}

TEST(ReflectionError, MeasuresDistanceAgainstWhatTheProbeSeesWhenAsked) {
    // A sphere of radius 1 in a room of radius 5: |p - c| / 5.
    EXPECT_NEAR(errorAgainstProbe(mapsOf(5)), 0.2f, 1e-6f);
    // Each face fills a sixth of all directions: (2 + 5 * 5) / 6 = 4.5.
    EXPECT_NEAR(errorAgainstProbe(mapsOf(2)), 1 / 4.5f, 1e-6f);
    // The sky is left out.
    EXPECT_NEAR(errorAgainstProbe(mapsOf(1e30f)), 0.2f, 1e-6f);
    std::vector<vec4> sky(25, vec4(0, 0, 0, 1e30f));
    sky[0] = vec4(2, 1, 0, 0);
    EXPECT_EQ(errorAgainstProbe(sky), 0.0f);
}

TEST(ReflectionError, OfAnObjectWithoutProbeIsUnknown) {
    Scene scene = sphereAt(30 * kRadians);
    scene.instances[0].probe = kNone;
    EXPECT_EQ(errorOf(scene, 2), 1.0f);
}

TEST(ReflectionError, IsNothingWhereNothingReflects) {
    // Less than 1/512 at normal incidence; no mirror at all; nothing seen.
    EXPECT_EQ(errorOf(sphereAt(0.0f, 1.0f / 1024.0f), 1), 0.0f);
    Scene plain = sphereAt(0.0f);
    plain.materials[0].flags = 0;
    EXPECT_EQ(errorOf(plain, 1), 0.0f);

    const Scene scene = sphereAt(0.0f);
    const Camera camera = straightAhead();
    PassRun run(reflectionErrorPass());
    run.extent({1, 1}).scene(scene).camera(camera).param("metric", 1u);
    run.plane<Hit>("gbuffer", {{kNone, kNone}}).execute();
    EXPECT_EQ(run.output<vec2>("error").front(), vec2(0.0f));
}

TEST(ReflectionError, OfSelfOcclusionIsTheVerticesMixedByBarycentrics) {
    // The pixel sees the middle of a triangle: a third of each corner.
    test::SceneBuilder builder;
    const vec3 positions[] = {{-1, -1, -5}, {1, -1, -5}, {0, 2, -5}};
    const uvec3 triangles[] = {{0, 1, 2}};
    builder.add(positions, triangles, builder.addMaterial(mirror(1.0f)));
    const Scene scene = builder.finish();
    const Camera camera = straightAhead();
    PassRun run(reflectionErrorPass());
    run.extent({1, 1}).scene(scene).camera(camera).param("metric", 5u);
    run.list<float>("occlusion", {0.2f, 0.4f, 0.9f});
    run.plane<Hit>("gbuffer", {{0, 0}}).execute();
    EXPECT_NEAR(run.output<vec2>("error").front().x, 0.5f, 1e-6f);
    run.param("orientation", std::string("accessibility")).execute();
    EXPECT_NEAR(run.output<vec2>("error").front().x, 0.5f, 1e-6f);
    run.list<float>("occlusion", {0.9f, 0.9f, 0.9f}).execute();
    EXPECT_NEAR(run.output<vec2>("error").front().x, 0.1f, 1e-6f);
}

TEST(ReflectionError, OfAnySelfOcclusionIsOneHoweverLittleIsCovered) {
    const Scene scene = sphereAt(0.0f);
    PassRun run(reflectionErrorPass());
    run.extent({1, 1}).scene(scene).camera(straightAhead()).param("metric", 5u);
    run.param("covered", std::string("any")).plane<Hit>("gbuffer", {{0, 0}});
    run.list<float>("occlusion", {0.015625f, 0, 0}).execute();
    EXPECT_EQ(run.output<vec2>("error").front().x, 1.0f);
    run.list<float>("occlusion", {0, 0, 0}).execute();
    EXPECT_EQ(run.output<vec2>("error").front().x, 0.0f);
    run.param("orientation", std::string("accessibility"));
    run.list<float>("occlusion", {1, 1, 1}).execute();
    EXPECT_EQ(run.output<vec2>("error").front().x, 0.0f);
    run.list<float>("occlusion", {kNan, kNan, kNan}).execute();
    EXPECT_EQ(run.output<vec2>("error").front().x, 1.0f);
}

TEST(ReflectionError, OfSelfOcclusionTakesThePixelsWhereTheyAreGiven) {
    const Scene scene = sphereAt(0.0f);
    PassRun run(reflectionErrorPass());
    run.extent({1, 1}).scene(scene).camera(straightAhead()).param("metric", 5u);
    run.plane<Hit>("gbuffer", {{0, 0}}).plane<float>("screen_occlusion", {0.25f}).execute();
    EXPECT_EQ(run.output<vec2>("error").front(), vec2(0.25f));
}

class ReflectionErrorVulkan : public VulkanTest {};

TEST_F(ReflectionErrorVulkan, IsWhatItIsOnTheHost) {
    const Scene scene = sphereAt(50 * kRadians);
    const auto errors = [&](PassRun& run, uint metric, const char* reach) {
        run.extent({1, 1}).scene(scene).camera(straightAhead()).param("metric", metric);
        run.param("max_distance", std::string(reach)).plane<Hit>("gbuffer", {{0, 0}});
        run.list<float>("occlusion", {0.25f, 0.5f, 0.75f}).list("environment_maps", mapsOf(2));
        return run.execute().output<vec2>("error").front().x;
    };
    for (uint metric = 1; metric <= 5; ++metric)
        for (const char* reach : {"object", "visible", "scene", "probe"}) {
            PassRun host(reflectionErrorPass()), vulkan(reflectionErrorPass(), device());
            EXPECT_NEAR(errors(vulkan, metric, reach), errors(host, metric, reach), 1e-6f)
                << metric << " " << reach;
        }
}

TEST(ReflectionError, OfSelfOcclusionSaysWhatToConnect) {
    const Scene scene = sphereAt(0.0f);
    try {
        (void)errorOf(scene, 5);
        FAIL() << "metric 5 ran without occlusion";
    } catch (const GraphError& error) {
        EXPECT_NE(std::string(error.what()).find("error.self_occlusion"), std::string::npos);
    }
}

} // namespace
} // namespace hone

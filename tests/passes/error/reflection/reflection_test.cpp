// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/passes.h"
#include "hone/tests/support/run_pass.h"
#include "hone/tests/support/scene_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hone {
namespace {

constexpr float kRadians = 0.017453293f;

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

// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/brute/brute_backend.h"
#include "hone/backends/host/host_device.h"
#include "hone/core/device/kernel.glsl.h"
#include "hone/core/error.h"
#include "hone/passes/passes.h"
#include "hone/tests/support/run_pass.h"
#include "hone/tests/support/scene_builder.h"
#include "hone/tests/support/vulkan_fixture.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace hone {
namespace {

/// The functions that raster and trace share, for the answers that a ray tracer would give.
struct Library : HostKernel {
    using HostKernel::HostKernel;
#include "hone/core/scene/texture.glsl.h"

#include "hone/core/scene/surface.glsl.h"

#include "hone/core/scene/camera.glsl.h"

#include "hone/passes/shading/shading.glsl.h"
};

Camera cameraAt(vec3 position, vec3 target) {
    Camera camera{};
    camera.position = position;
    camera.forward = glm::normalize(target - position);
    camera.right = glm::normalize(glm::cross(camera.forward, vec3(0, 1, 0)));
    camera.up = glm::cross(camera.right, camera.forward);
    camera.tan_half_fov_y = 0.6f;
    camera.near = 0.1f;
    return camera;
}

/// Triangles of all kinds in a ball of radius 3: single-sided, two-sided, with holes, and a mesh
/// that is placed twice, once mirrored.
Scene tumble(uint seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> position(-2.5f, 2.5f), corner(-0.6f, 0.6f);
    auto point = [](auto& distribution, std::mt19937& generator) {
        const float x = distribution(generator);
        const float y = distribution(generator);
        return vec3(x, y, distribution(generator));
    };
    test::SceneBuilder builder;
    Material holes = test::plainMaterial(kMaterialMasked | kMaterialTwoSided);
    holes.base_color_texture = builder.addTexture(
        2, 2, std::vector<uint>{0xffffffffu, 0x00ffffffu, 0x00ffffffu, 0xffffffffu}, 0);
    Material red = test::plainMaterial();
    red.base_color = vec3(0.8f, 0.2f, 0.1f);
    const uint materials[] = {builder.addMaterial(test::plainMaterial()),
                              builder.addMaterial(test::plainMaterial(kMaterialTwoSided)),
                              builder.addMaterial(holes), builder.addMaterial(red)};
    for (const uint material : materials) {
        std::vector<vec3> positions;
        std::vector<uvec3> triangles;
        std::vector<vec2> uvs;
        for (uint i = 0; i < 40; ++i) {
            const vec3 middle = point(position, random);
            for (int k = 0; k < 3; ++k)
                positions.push_back(middle + point(corner, random));
            uvs.insert(uvs.end(), {{0, 0}, {2, 0}, {0, 2}});
            triangles.push_back(uvec3(0, 1, 2) + 3 * i);
        }
        const uint mesh = builder.addMesh(positions, triangles, material, uvs);
        builder.addInstance(mesh);
        if (material == materials[0]) {
            mat4 mirrored(1.0f);
            mirrored[0][0] = -1.5f;
            mirrored[3] = vec4(0.3f, -0.2f, 0.1f, 1);
            builder.addInstance(mesh, mirrored);
        }
    }
    Scene scene = builder.finish();
    scene.environment.zenith = vec3(0.1f, 0.2f, 0.4f);
    scene.environment.horizon = vec3(0.5f);
    scene.environment.ground = vec3(0.2f, 0.1f, 0.0f);
    scene.environment.ambient = vec3(0.05f, 0.06f, 0.07f);
    Light lamp{};
    lamp.kind = kLightPoint;
    lamp.position = vec3(1, 4, 5);
    lamp.intensity = vec3(30, 29, 28);
    Light sun{};
    sun.kind = kLightDirectional;
    sun.direction = glm::normalize(vec3(1, -2, -1));
    sun.intensity = vec3(1, 1, 0.9f);
    scene.lights = {lamp, sun};
    return scene;
}

class Raster : public VulkanTest {
protected:
    static constexpr uvec2 kExtent{160, 120};
    static constexpr uint kPixels = kExtent.x * kExtent.y;
};

/// What a linear search finds along each pixel's ray.
std::vector<Hit> searched(const Scene& scene, const Camera& camera, uvec2 extent) {
    const auto host = makeHostDevice();
    SceneBuffers buffers(*host, scene);
    Arguments arguments;
    arguments.bind(buffers.arguments());
    Library library(arguments, nullptr);
    std::vector<Ray> rays;
    for (uint i = 0; i < extent.x * extent.y; ++i)
        rays.push_back(library.cameraRay(camera, extent, library.pixelCenter(i, extent)));
    std::vector<Hit> hits(rays.size());
    const auto tracer = makeBruteBackend();
    tracer->build(scene);
    tracer->closest(rays, hits, Coherence::kCoherent, {});
    return hits;
}

// Needs no Vulkan device; the extent is no multiple of a tile.
TEST(RasterByRays, SeesExactlyWhatTheTracerAnswers) {
    const Scene scene = tumble(1);
    const Camera camera = cameraAt({1, 2, 6}, {0, 0, 0});
    const uvec2 extent{101, 67};
    TraceBackendRegistry tracers;
    tracers.add("brute", "", [](const Devices&) { return makeBruteBackend(); });
    PassRun run(rasterPass());
    run.extent(extent).scene(scene).camera(camera).tracers(tracers);
    run.param("visibility", "rays").param("backend", "brute").execute();
    const std::vector<Hit> hits = run.output<Hit>("gbuffer");
    const std::vector<Hit> expected = searched(scene, camera, extent);
    for (std::size_t i = 0; i < hits.size(); ++i) {
        ASSERT_EQ(hits[i].instance, expected[i].instance) << i;
        ASSERT_EQ(hits[i].primitive, expected[i].primitive) << i;
    }
    EXPECT_EQ(run.counter("rays.visibility"), hits.size());
}

TEST_F(Raster, SeesWhatRaysSee) {
    const Scene scene = tumble(1);
    const Camera camera = cameraAt({1, 2, 6}, {0, 0, 0});
    PassRun run(rasterPass(), device());
    run.kernelsOnHost().extent(kExtent).scene(scene).camera(camera).execute();
    const std::vector<Hit> hits = run.output<Hit>("gbuffer");
    const std::vector<Hit> traced = searched(scene, camera, kExtent);

    uint different = 0;
    uint seen = 0;
    for (uint i = 0; i < kPixels; ++i) {
        seen += traced[i].instance != kNone ? 1u : 0u;
        if (hits[i].instance != traced[i].instance || hits[i].primitive != traced[i].primitive)
            ++different;
    }
    EXPECT_GT(seen, kPixels / 5);
    // The rasteriser snaps vertices to 1/256 of a pixel. About 200 triangles of 30 pixels' outline
    // have 6000 edge pixels, of which that share may fall to the other side.
    EXPECT_LE(different, 24u);
}

TEST_F(Raster, IsTheSameBitsAsTracingWhereNothingIsShadowed) {
    const Scene scene = tumble(2);
    const Camera camera = cameraAt({1, 2, 6}, {0, 0, 0});
    PassRun run(rasterPass(), device());
    run.kernelsOnHost().extent(kExtent).scene(scene).camera(camera).execute();
    const std::vector<Hit> hits = run.output<Hit>("gbuffer");
    const std::vector<vec3> color = run.output<vec3>("color");
    const std::vector<float> depth = run.output<float>("depth");

    // A tracer's order: the unshadowed part, then each light's share by its visibility, here 1.
    SceneBuffers buffers(device(), scene);
    Arguments arguments;
    arguments.bind(buffers.arguments());
    Library library(arguments, nullptr);
    for (uint i = 0; i < kPixels; ++i) {
        const Ray ray = library.cameraRay(camera, kExtent, library.pixelCenter(i, kExtent));
        if (hits[i].instance == kNone) {
            EXPECT_EQ(color[i], library.environmentRadiance(ray.direction));
            EXPECT_EQ(depth[i], 0.0f);
            continue;
        }
        const Library::Surface surface = library.surfaceAt(ray, hits[i]);
        const float footprint =
            surface.t * 2.0f * camera.tan_half_fov_y / static_cast<float>(kExtent.y);
        const vec3 albedo(library.baseColor(surface, ray.direction, footprint));
        vec3 traced = library.unshadowedRadiance(surface, albedo);
        for (uint light = 0; light < 2; ++light)
            traced += library.directLight(scene.lights[light], surface, albedo) * 1.0f;
        EXPECT_EQ(color[i], traced) << "pixel " << i;
        EXPECT_EQ(depth[i], surface.t);
    }
}

TEST_F(Raster, DeviceAndHostKernelsAgree) {
    // Vulkan allows some units in the last place for division and square roots; texture lookups and
    // sums of lights carry them on.
    const Scene scene = tumble(3);
    const Camera camera = cameraAt({1, 2, 6}, {0, 0, 0});
    PassRun on_device(rasterPass(), device());
    on_device.extent(kExtent).scene(scene).camera(camera).execute();
    PassRun on_host(rasterPass(), device());
    on_host.kernelsOnHost().extent(kExtent).scene(scene).camera(camera).execute();
    const std::vector<vec3> a = on_device.output<vec3>("color");
    const std::vector<vec3> b = on_host.output<vec3>("color");
    for (uint i = 0; i < kPixels; ++i)
        EXPECT_LE(glm::distance(a[i], b[i]), 1e-4f * (1 + glm::length(b[i]))) << "pixel " << i;
}

/// A mirror that fills the view, 5 in front of a camera that looks along -z.
Scene mirrorWall() {
    test::SceneBuilder builder;
    Material mirror = test::plainMaterial(kMaterialMirror);
    mirror.base_color = vec3(0.0f);
    mirror.f0 = vec3(0.5f);
    const vec3 positions[] = {{-50, -50, -5}, {50, -50, -5}, {50, 50, -5}, {-50, 50, -5}};
    const uvec3 triangles[] = {{0, 1, 2}, {0, 2, 3}};
    builder.add(positions, triangles, builder.addMaterial(mirror));
    Scene scene = builder.finish();
    scene.environment.zenith = scene.environment.horizon = scene.environment.ground =
        vec3(1.0f, 2.0f, 4.0f);
    return scene;
}

TEST_F(Raster, ReflectsTheSkyWithoutAProbe) {
    const Scene scene = mirrorWall();
    const Camera camera = cameraAt({0, 0, 0}, {0, 0, -1});
    PassRun run(rasterPass(), device());
    run.extent({1, 1}).scene(scene).camera(camera).execute();
    // Straight on, Schlick's weight is f0.
    EXPECT_EQ(run.output<vec3>("color").front(), vec3(0.5f, 1.0f, 2.0f));
}

TEST_F(Raster, ReflectsWhatItsProbeSaw) {
    Scene scene = mirrorWall();
    scene.probes = {{vec3(0, 0, -5), 0}};
    scene.instances[0].probe = 0;
    // Face 4 (+z) is what a mirror that faces +z reflects straight on.
    std::vector<vec4> maps(1 + 6 * 4, vec4(0.0f));
    maps[0] = vec4(2, 1, 0, 0);
    for (uint texel = 0; texel < 4; ++texel)
        maps[1 + 4 * 4 + texel] = vec4(8.0f, 6.0f, 4.0f, 1.0f);
    const Camera camera = cameraAt({0, 0, 0}, {0, 0, -1});
    PassRun run(rasterPass(), device());
    run.extent({1, 1}).scene(scene).camera(camera).list("environment_maps", maps).execute();
    EXPECT_EQ(run.output<vec3>("color").front(), vec3(4.0f, 3.0f, 2.0f));
}

TEST_F(Raster, NeedsADeviceThatRasterises) {
    const Scene scene = mirrorWall();
    const Camera camera = cameraAt({0, 0, 0}, {0, 0, -1});
    PassRun run(rasterPass());
    run.extent({1, 1}).scene(scene).camera(camera);
    EXPECT_THROW(run.execute(), DeviceError);
}

} // namespace
} // namespace hone

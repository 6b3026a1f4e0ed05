// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/brute/brute_backend.h"
#include "hone/tests/support/each_build.h"
#include "hone/tests/support/scene_builder.h"

#include "hone/core/device/host_kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace hone {
namespace {

constexpr uvec2 kExtent{128, 96};

Material mirror(uint flags = 0) {
    Material material = test::plainMaterial(kMaterialMirror | flags);
    material.f0 = vec3(1.0f);
    return material;
}

struct CameraRays : HostKernel {
    using HostKernel::HostKernel;
#include "hone/core/scene/camera.glsl.h"
};

/// What the camera sees, by a reference tracer.
std::vector<Hit> seen(const Scene& scene, const Camera& camera) {
    const Arguments no_arguments;
    CameraRays pixels(no_arguments, nullptr);
    std::vector<Ray> rays;
    for (uint pixel = 0; pixel < kExtent.x * kExtent.y; ++pixel)
        rays.push_back(pixels.cameraRay(camera, kExtent, pixels.pixelCenter(pixel, kExtent)));
    std::vector<Hit> hits(rays.size());
    const std::unique_ptr<TraceBackend> brute = makeBruteBackend();
    brute->build(scene);
    brute->closest(rays, hits, Coherence::kCoherent, {});
    return hits;
}

std::vector<float> occlusionOf(const Scene& scene, const CameraDesc& from, uint steps = 12) {
    PassRun run = EachBuild::pass(screenOcclusionPass());
    const Camera camera = makeCamera(from);
    run.extent(kExtent).scene(scene).camera(camera).plane("gbuffer", seen(scene, camera));
    run.param("rays", 128u).param("steps", steps).execute();
    return run.output<float>("occlusion");
}

/// A floor and a wall 3 high that stands 4 beside the origin.
Scene floorAndWall(const Material& material, bool one_object) {
    test::SceneBuilder builder;
    const uint id = builder.addMaterial(material);
    const vec3 floor[] = {{-2, 0, -2}, {4, 0, -2}, {4, 0, 2}, {-2, 0, 2}};
    const vec3 wall[] = {{4, 0, -60}, {4, 0, 60}, {4, 3, 60}, {4, 3, -60}};
    const uvec3 quad[] = {{0, 1, 2}, {0, 2, 3}};
    if (one_object) {
        std::vector<vec3> all(std::begin(floor), std::end(floor));
        all.insert(all.end(), std::begin(wall), std::end(wall));
        const uvec3 both[] = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
        builder.add(all, both, id);
    } else {
        builder.add(floor, quad, id);
        builder.add(wall, quad, id);
    }
    return builder.finish();
}

/// On the side away from the wall, so that all of it is seen; the origin is the middle pixel.
const CameraDesc kBeside{
    .name = "", .position = {-7, 2, 0}, .target = {0, 0, 0}, .fov_y_degrees = 60};

/// The mean over a stretch of the floor through the origin, all of it as far from the wall.
float atOrigin(const std::vector<float>& occlusion) {
    constexpr uint kHalf = 8;
    const auto middle = occlusion.begin() + kExtent.y / 2 * kExtent.x + kExtent.x / 2;
    return std::accumulate(middle - kHalf, middle + kHalf, 0.0f) / (2 * kHalf);
}

class ScreenOcclusion : public EachBuild {};
HONE_ON_EACH_BUILD(ScreenOcclusion);

TEST_P(ScreenOcclusion, OfALongWallIsHalfOfOneLessTheCosineOfItsHeight) {
    // (1 - d / sqrt(d^2 + h^2)) / 2 with h = 3, d = 4: 0.1. The wall hides from the camera only a
    // little of the rays that just meet it, which takes many steps to find.
    EXPECT_NEAR(atOrigin(occlusionOf(floorAndWall(mirror(kMaterialTwoSided), true), kBeside, 96)),
                0.1f, 0.02f);
}

TEST_P(ScreenOcclusion, CountsTheOwnObjectOnly) {
    EXPECT_EQ(atOrigin(occlusionOf(floorAndWall(mirror(kMaterialTwoSided), false), kBeside)), 0.0f);
}

TEST_P(ScreenOcclusion, IsNothingForWhatIsNoMirrorOrNotSeen) {
    for (float occlusion :
         occlusionOf(floorAndWall(test::plainMaterial(kMaterialTwoSided), true), kBeside))
        EXPECT_EQ(occlusion, 0.0f);
}

TEST_P(ScreenOcclusion, DoesNotKnowWhatTheImageDoesNotShow) {
    // The same floor seen straight from above, where the wall is a line.
    const CameraDesc down{.name = "",
                          .position = {0, 3, 0},
                          .target = {0, 0, 0},
                          .up = {0, 0, 1},
                          .fov_y_degrees = 40};
    EXPECT_EQ(atOrigin(occlusionOf(floorAndWall(mirror(kMaterialTwoSided), true), down)), 0.0f);
}

TEST_P(ScreenOcclusion, IsNothingOnAConvexObjectUpToAPixelsWidth) {
    test::SceneBuilder builder;
    const vec3 positions[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    const uvec3 triangles[] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                               {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    builder.add(positions, triangles, builder.addMaterial(mirror()));
    const std::vector<float> occlusion =
        occlusionOf(builder.finish(),
                    {.name = "", .position = {2, 3, 4}, .target = {0, 0, 0}, .fov_y_degrees = 40});
    EXPECT_LE(std::ranges::max(occlusion), 0.05f);
    EXPECT_LE(std::accumulate(occlusion.begin(), occlusion.end(), 0.0f), 0.001f * 128 * 96);
}

} // namespace
} // namespace hone

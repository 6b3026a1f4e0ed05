// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/brute/brute_backend.h"
#include "hone/passes/passes.h"
#include "hone/tests/support/run_pass.h"
#include "hone/tests/support/scene_builder.h"

#include <gtest/gtest.h>

#include <vector>

namespace hone {
namespace {

Material mirror() {
    Material material = test::plainMaterial(kMaterialMirror);
    material.f0 = vec3(1.0f);
    return material;
}

std::vector<float> occlusionOf(const Scene& scene, uint rays) {
    TraceBackendRegistry registry;
    registry.add("brute", "the reference", [](const Devices&) { return makeBruteBackend(); });
    PassRun run(selfOcclusionPass());
    run.scene(scene).tracers(registry).param("rays", rays).execute();
    return run.output<float>("occlusion");
}

/// A floor vertex at the origin looking up, and a wall 3 high and 4 away, endless to both sides.
Scene floorAndWall(const Material& material, bool one_object) {
    test::SceneBuilder builder;
    const uint id = builder.addMaterial(material);
    const vec3 floor[] = {{0, 0, 0}, {-1, 0, 0}, {-1, 0, -1}};
    const vec3 wall[] = {{4, 0, -4000}, {4, 0, 4000}, {4, 3, 4000}, {4, 3, -4000}};
    if (one_object) {
        std::vector<vec3> all(std::begin(floor), std::end(floor));
        all.insert(all.end(), std::begin(wall), std::end(wall));
        const uvec3 triangles[] = {{0, 2, 1}, {3, 4, 5}, {3, 5, 6}};
        builder.add(all, triangles, id);
    } else {
        const uvec3 floor_triangles[] = {{0, 2, 1}};
        const uvec3 wall_triangles[] = {{0, 1, 2}, {0, 2, 3}};
        builder.add(floor, floor_triangles, id);
        builder.add(wall, wall_triangles, id);
    }
    Scene scene = builder.finish();
    for (int vertex = 0; vertex < 3; ++vertex)
        scene.normals[static_cast<std::size_t>(vertex)] = vec3(0, 1, 0);
    return scene;
}

TEST(SelfOcclusion, OfAnEndlessWallIsHalfOfOneLessTheCosineOfItsHeight) {
    // SCIENCE 9.9: (1 - d / sqrt(d^2 + h^2)) / 2 with h = 3, d = 4: 0.1. A Hammersley set of 4096
    // is far better than the 3 sigma of random rays, 0.014.
    EXPECT_NEAR(occlusionOf(floorAndWall(mirror(), true), 4096).front(), 0.1f, 0.005f);
}

TEST(SelfOcclusion, CountsTheOwnObjectOnly) {
    EXPECT_EQ(occlusionOf(floorAndWall(mirror(), false), 256).front(), 0.0f);
}

TEST(SelfOcclusion, IsNothingForWhatIsNoMirror) {
    EXPECT_EQ(occlusionOf(floorAndWall(test::plainMaterial(), true), 64).front(), 0.0f);
}

TEST(SelfOcclusion, IsNothingOnAConvexObject) {
    test::SceneBuilder builder;
    const vec3 positions[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    const uvec3 triangles[] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                               {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    builder.add(positions, triangles, builder.addMaterial(mirror()));
    for (float occlusion : occlusionOf(builder.finish(), 256))
        EXPECT_EQ(occlusion, 0.0f);
}

} // namespace
} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/host_surface.h"

#include "hone/tests/support/scene_builder.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace hone::test {
namespace {

// A triangle over x, y in [0,1] at z = 0, texture coordinates x and y; alpha 1 left, 0 right, with
// texel centres at u = 0.25 and 0.75. Placed at z = 5, twice as large.
Scene maskedTriangle() {
    SceneBuilder builder;
    const uint texels[] = {0xff'ff'ff'ffu, 0x00'ff'ff'ffu};
    Material material = plainMaterial(kMaterialMasked);
    material.base_color_texture = builder.addTexture(2, 1, texels);
    const uint mesh = builder.addMesh(std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                      std::vector<uvec3>{{0, 1, 2}}, builder.addMaterial(material),
                                      std::vector<vec2>{{0, 0}, {1, 0}, {0, 1}});
    builder.addInstance(mesh, glm::scale(glm::translate(mat4(1), vec3(0, 0, 5)), vec3(2, 2, 2)));
    return builder.finish();
}

TEST(HostSurface, PlacesVerticesInTheWorld) {
    const Scene scene = maskedTriangle();
    const HostSurface surface(scene);
    EXPECT_EQ(surface.worldPosition(scene.instances[0], 0), vec3(0, 0, 5));
    EXPECT_EQ(surface.worldPosition(scene.instances[0], 1), vec3(2, 0, 5));
    EXPECT_EQ(surface.worldPosition(scene.instances[0], 2), vec3(0, 2, 5));
}

TEST(HostSurface, FindsHolesWhereTheRayMeetsTheTriangle) {
    const Scene scene = maskedTriangle();
    const HostSurface surface(scene);
    EXPECT_TRUE(surface.isSolid({{0.9f, 0.1f, 9}, 0, {0, 0, -1}, 1e30f}, {0, 0}));  // u = 0.45
    EXPECT_FALSE(surface.isSolid({{1.1f, 0.1f, 9}, 0, {0, 0, -1}, 1e30f}, {0, 0})); // u = 0.55
    EXPECT_TRUE(surface.isSolid({{1.9f, 0.1f, 6}, 0, {-1, 0, -1}, 1e30f}, {0, 0}))
        << "the ray drifts to x = 0.9";
}

} // namespace
} // namespace hone::test

// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan/triangle_soup.h"

#include "hone/tests/support/scene_builder.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace hone::test {
namespace {

/// A triangle, one of three equal corners, one of three corners in a line, and the first again.
Scene flawed(const mat4& place) {
    SceneBuilder builder;
    const std::vector<vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}};
    const std::vector<uvec3> triangles{{0, 1, 2}, {1, 1, 1}, {0, 1, 3}, {0, 1, 2}};
    builder.addInstance(builder.addMesh(corners, triangles, builder.addMaterial(plainMaterial())),
                        place);
    return builder.finish();
}

TEST(TriangleSoup, LeavesOutTrianglesWithoutArea) {
    const Scene scene = flawed(mat4(1));
    TriangleSoup soup;
    soup.addInstance(scene, HostSurface(scene), 0);
    ASSERT_EQ(soup.names.size(), 2u);
    EXPECT_EQ(soup.names[0].primitive, 0u);
    EXPECT_EQ(soup.names[1].primitive, 3u);
    EXPECT_EQ(soup.names[1].instance, 0u);
}

TEST(TriangleSoup, PlacesTrianglesInTheWorld) {
    const Scene scene = flawed(glm::translate(mat4(1), vec3(5, 6, 7)));
    TriangleSoup soup;
    soup.addInstance(scene, HostSurface(scene), 0);
    EXPECT_EQ(soup.corners[0], (std::array{vec3(5, 6, 7), vec3(6, 6, 7), vec3(5, 7, 7)}));
}

TEST(TriangleSoup, TurnsTheTrianglesOfAMirroredInstance) {
    const Scene scene = flawed(glm::scale(mat4(1), vec3(-1, 1, 1)));
    TriangleSoup soup;
    soup.addInstance(scene, HostSurface(scene), 0);
    EXPECT_EQ(soup.corners[0], (std::array{vec3(0, 0, 0), vec3(0, 1, 0), vec3(-1, 0, 0)}));
}

TEST(TriangleSoup, KeepsAMeshInItsOwnSpace) {
    const Scene scene = flawed(glm::scale(mat4(1), vec3(-1, 1, 1)));
    TriangleSoup soup;
    soup.addMesh(scene, 0);
    ASSERT_EQ(soup.names.size(), 2u);
    EXPECT_EQ(soup.corners[0], (std::array{vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)}));
    EXPECT_EQ(soup.names[1].primitive, 3u);
    EXPECT_EQ(soup.names[1].instance, kNone);
}

} // namespace
} // namespace hone::test

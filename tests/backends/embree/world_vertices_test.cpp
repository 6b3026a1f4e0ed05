// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/embree/world_vertices.h"

#include "hone/tests/support/scene_builder.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <optional>

namespace hone::test {
namespace {

const std::vector<vec3> kCorners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

mat4 shift(float x) {
    return glm::translate(mat4(1), vec3(x, 0, 0));
}

/// A scene of meshes of one triangle each, and the places of their vertices.
class WorldVerticesTest : public testing::Test {
protected:
    uint addMesh() { return builder_.addMesh(kCorners, std::vector<uvec3>{{0, 1, 2}}, material_); }

    WorldVertices& make(std::vector<std::uint8_t> is_instanced) {
        scene_ = builder_.finish();
        surface_.emplace(scene_);
        vertices_.emplace(scene_, *surface_, is_instanced);
        return *vertices_;
    }

    SceneBuilder builder_;
    uint material_ = builder_.addMaterial(plainMaterial());
    Scene scene_;
    std::optional<HostSurface> surface_;
    std::optional<WorldVertices> vertices_;
};

TEST_F(WorldVerticesTest, AreTheScenesOwnPositionsWhereNothingIsMoved) {
    builder_.addInstance(addMesh());
    WorldVertices& vertices = make({0});
    EXPECT_EQ(vertices.place(0).data(), scene_.positions.data());
    EXPECT_EQ(vertices.bytes(), 0u);
}

TEST_F(WorldVerticesTest, AreNumberedAsTheScenesPositions) {
    addMesh();
    builder_.addInstance(addMesh(), shift(7)); // positions 3, 4, 5
    WorldVertices& vertices = make({0, 0});
    const std::span<const vec3> placed = vertices.place(0);
    ASSERT_EQ(placed.size(), 6u);
    EXPECT_EQ(placed[3], vec3(7, 0, 0));
    EXPECT_EQ(placed[4], vec3(8, 0, 0));
    EXPECT_EQ(placed[5], vec3(7, 1, 0));
    EXPECT_EQ(vertices.bytes(), 3 * sizeof(vec3));
}

TEST_F(WorldVerticesTest, OfMeshesThatShareNoPositionStandInOneArray) {
    const uint first = addMesh();
    const uint second = addMesh();
    builder_.addInstance(first, shift(1));
    builder_.addInstance(second, shift(2));
    WorldVertices& vertices = make({0, 0});
    const std::span<const vec3> a = vertices.place(0);
    const std::span<const vec3> b = vertices.place(1);
    EXPECT_EQ(a.data(), b.data());
    EXPECT_EQ(a[1], vec3(2, 0, 0));
    EXPECT_EQ(b[4], vec3(3, 0, 0));
}

TEST_F(WorldVerticesTest, OfASecondPlaceOfAMeshAreItsOwn) {
    addMesh();
    const uint mesh = addMesh();
    for (const float x : {1.0f, 2.0f, 3.0f})
        builder_.addInstance(mesh, shift(x));
    WorldVertices& vertices = make({0, 0});
    std::vector<std::span<const vec3>> placed;
    for (uint i = 0; i < 3; ++i)
        placed.push_back(vertices.place(i));
    for (uint i = 0; i < 3; ++i) {
        EXPECT_EQ(placed[i][3], vec3(1.0f + static_cast<float>(i), 0, 0));
        EXPECT_EQ(placed[i][5].y, 1.0f);
    }
    EXPECT_EQ(vertices.bytes(), 9 * sizeof(vec3));
}

TEST_F(WorldVerticesTest, FollowAnInstanceInThePlaceThatTheyHave) {
    const uint mesh = addMesh();
    builder_.addInstance(mesh, shift(1));
    builder_.addInstance(mesh, shift(2));
    WorldVertices& vertices = make({0});
    const std::span<const vec3> first = vertices.place(0);
    const std::span<const vec3> second = vertices.place(1);
    moveInstance(scene_, 1, mat4x3(shift(9)));
    EXPECT_EQ(vertices.place(1).data(), second.data());
    EXPECT_EQ(second[0], vec3(9, 0, 0));
    EXPECT_EQ(first[0], vec3(1, 0, 0));
    EXPECT_EQ(vertices.bytes(), 6 * sizeof(vec3));
}

TEST_F(WorldVerticesTest, LeaveTheScenesPositionsForGoodOnceTheyMove) {
    builder_.addInstance(addMesh());
    WorldVertices& vertices = make({0});
    EXPECT_EQ(vertices.place(0).data(), scene_.positions.data());
    moveInstance(scene_, 0, mat4x3(shift(4)));
    const std::span<const vec3> moved = vertices.place(0);
    EXPECT_NE(moved.data(), scene_.positions.data());
    EXPECT_EQ(moved[1], vec3(5, 0, 0));
    EXPECT_EQ(scene_.positions[1], vec3(1, 0, 0));
    // Embree was told where they are: back at the identity they stay there.
    moveInstance(scene_, 0, mat4x3(1));
    EXPECT_EQ(vertices.place(0).data(), moved.data());
    EXPECT_EQ(moved[1], vec3(1, 0, 0));
}

} // namespace
} // namespace hone::test

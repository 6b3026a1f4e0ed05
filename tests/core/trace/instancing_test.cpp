// SPDX-License-Identifier: Apache-2.0
#include "hone/core/trace/instancing.h"

#include "hone/tests/support/scene_builder.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace hone::test {
namespace {

using Chosen = std::vector<std::uint8_t>;

/// A mesh of `triangles` triangles, placed `copies` times.
uint addCopies(SceneBuilder& builder, uint triangles, int copies) {
    const std::vector<vec3> corners{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
    const uint mesh = builder.addMesh(corners, std::vector<uvec3>(triangles, {0, 1, 2}),
                                      builder.addMaterial(plainMaterial()));
    for (int i = 0; i < copies; ++i)
        builder.addInstance(mesh);
    return mesh;
}

TEST(ChooseInstanced, FlattensTheMeshesFirstWhoseCopiesAddLeast) {
    SceneBuilder builder;
    addCopies(builder, 9, 2); // the second copy adds 9
    addCopies(builder, 2, 3); // the others add 4
    addCopies(builder, 7, 1); // adds nothing
    const Scene scene = builder.finish();
    EXPECT_EQ(chooseInstanced(scene, 13), (Chosen{0, 0, 0}));
    EXPECT_EQ(chooseInstanced(scene, 12), (Chosen{1, 0, 0}));
    EXPECT_EQ(chooseInstanced(scene, 4), (Chosen{1, 0, 0}));
    EXPECT_EQ(chooseInstanced(scene, 3), (Chosen{1, 1, 0}));
    EXPECT_EQ(chooseInstanced(scene, 0), (Chosen{1, 1, 0}));
}

TEST(ChooseInstanced, FlattensWhatCannotBeInverted) {
    SceneBuilder builder;
    const uint mesh = addCopies(builder, 9, 2);
    builder.addInstance(mesh, glm::scale(mat4(1), vec3(1, 1, 0)));
    Scene scene = builder.finish();
    EXPECT_FALSE(isInvertible(scene.instances[2]));
    EXPECT_TRUE(isInvertible(scene.instances[0]));
    EXPECT_EQ(chooseInstanced(scene, 0), (Chosen{0}));
    moveInstance(scene, 2, mat4x3(1.0f));
    EXPECT_TRUE(isInvertible(scene.instances[2]));
    EXPECT_EQ(chooseInstanced(scene, 0), (Chosen{1}));
    moveInstance(scene, 2, mat4x3(glm::scale(mat4(1), vec3(1, 1, 0))));
    EXPECT_FALSE(isInvertible(scene.instances[2]));
    EXPECT_EQ(chooseInstanced(scene, 0), (Chosen{0}));
}

} // namespace
} // namespace hone::test

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/error.h"
#include "hone/core/scene/scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace hone {
namespace {

void expectNear(vec3 actual, vec3 expected, float tolerance = 1e-6f) {
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(actual[c], expected[c], tolerance);
}

/// A right triangle in the xy plane with material 0, which is a mirror, or 1, which is not.
Scene makeTriangles(std::initializer_list<std::pair<vec3, uint>> places) {
    Scene scene;
    scene.name = "triangles";
    scene.positions = {vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)};
    scene.normals.assign(3, vec3(0, 0, 1));
    scene.uvs.assign(3, vec2(0));
    scene.triangles = {uvec3(0, 1, 2), uvec3(0, 1, 2)};
    scene.meshes = {{0, 1, 0, 0, 0}, {1, 1, 1, 0, 0}};
    scene.materials.resize(2);
    for (Material& material : scene.materials)
        material.base_color_texture = kNone;
    scene.materials[0].flags = kMaterialMirror;
    for (const auto& [place, mesh] : places) {
        Instance instance{};
        instance.to_world = mat4x3(vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1), place);
        instance.mesh = mesh;
        scene.instances.push_back(instance);
    }
    return scene;
}

std::string finishError(Scene scene) {
    try {
        finishScene(scene);
    } catch (const SceneError& error) {
        return error.what();
    }
    ADD_FAILURE() << "finishes";
    return "";
}

TEST(MakeCamera, GivesOrthonormalRightHandedAxes) {
    const Camera camera = makeCamera({.name = "c",
                                      .position = vec3(1, 2, 3),
                                      .target = vec3(1, 2, -7),
                                      .up = vec3(0, 5, 1),
                                      .fov_y_degrees = 90,
                                      .near = 0.5f});
    expectNear(camera.forward, vec3(0, 0, -1));
    expectNear(camera.right, vec3(1, 0, 0));
    expectNear(camera.up, vec3(0, 1, 0));
    EXPECT_NEAR(camera.tan_half_fov_y, 1.0f, 1e-6f);
    EXPECT_EQ(camera.near, 0.5f);
}

TEST(MakeCamera, RefusesWhatHasNoView) {
    EXPECT_THROW((void)makeCamera({.name = "", .position = vec3(1), .target = vec3(1)}),
                 SceneError);
    EXPECT_THROW((void)makeCamera({.name = "", .target = vec3(0, -3, 0), .up = vec3(0, 1, 0)}),
                 SceneError);
    EXPECT_THROW((void)makeCamera({.name = "", .up = vec3(0)}), SceneError);
    EXPECT_THROW((void)makeCamera({.name = "", .fov_y_degrees = 180}), SceneError);
    EXPECT_THROW((void)makeCamera({.name = "", .near = 0}), SceneError);
    EXPECT_THROW((void)makeCamera({.name = "", .position = vec3(std::nanf(""))}), SceneError);
}

TEST(Scene, FindsCamerasByNameAndListsThemOtherwise) {
    Scene scene;
    scene.name = "two";
    scene.cameras = {{.name = "left"}, {.name = "right"}};
    EXPECT_EQ(scene.camera("right").name, "right");
    EXPECT_EQ(scene.camera("").name, "left");
    try {
        (void)scene.camera("top");
        FAIL();
    } catch (const SceneError& error) {
        EXPECT_STREQ(error.what(), "two has no camera \"top\"; it has left, right");
    }
}

TEST(FinishScene, TurnsNormalsByTheInverseTranspose) {
    Scene scene = makeTriangles({{vec3(0), 1}});
    scene.instances[0].to_world = mat4x3(vec3(2, 0, 0), vec3(0, 4, 0), vec3(0, 0, -1), vec3(5));
    finishScene(scene);
    const mat3& normal_matrix = scene.instances[0].normal_matrix;
    expectNear(normal_matrix[0], vec3(0.5f, 0, 0));
    expectNear(normal_matrix[1], vec3(0, 0.25f, 0));
    expectNear(normal_matrix[2], vec3(0, 0, -1));
    EXPECT_EQ(scene.instances[0].flipped, 1u);
}

TEST(FinishScene, FlattenedInstancesKeepTheNormalOfTheirPlane) {
    Scene scene = makeTriangles({{vec3(0), 1}});
    scene.instances[0].to_world = mat4x3(vec3(2, 0, 0), vec3(0, 3, 0), vec3(0, 0, 0), vec3(0));
    finishScene(scene);
    expectNear(glm::normalize(scene.instances[0].normal_matrix * vec3(0, 0, 1)), vec3(0, 0, 1));
    EXPECT_EQ(scene.instances[0].flipped, 0u);
}

TEST(FinishScene, BoundsAreThoseOfTheWorld) {
    Scene scene = makeTriangles({{vec3(0), 1}, {vec3(3, 0, -2), 1}});
    finishScene(scene);
    EXPECT_EQ(scene.bounds.low, vec3(0, 0, -2));
    EXPECT_EQ(scene.bounds.high, vec3(4, 1, 0));
}

TEST(FinishScene, PutsADefaultProbeIntoEachMirror) {
    Scene scene = makeTriangles({{vec3(0), 1}, {vec3(3, 0, 0), 0}});
    finishScene(scene);
    ASSERT_EQ(scene.probes.size(), 1u);
    expectNear(scene.probes[0].position, vec3(3.5f, 0.5f, 0));
    EXPECT_EQ(scene.probes[0].object, 1u);
    EXPECT_EQ(scene.instances[0].probe, kNone);
    EXPECT_EQ(scene.instances[1].probe, 0u);
}

TEST(FinishScene, GivesDefaultProbesToTheFourLargestMirrors) {
    Scene scene = makeTriangles({{vec3(0), 0},
                                 {vec3(10, 0, 0), 0},
                                 {vec3(20, 0, 0), 0},
                                 {vec3(30, 0, 0), 0},
                                 {vec3(40, 0, 0), 0}});
    scene.instances[0].to_world[0] *= 0.5f; // the smallest
    scene.instances[3].to_world[0] *= 2.0f; // the largest
    finishScene(scene);
    ASSERT_EQ(scene.probes.size(), 4u);
    EXPECT_EQ(scene.probes[0].object, 3u);
    EXPECT_EQ(scene.instances[0].probe, 1u); // the one at x = 10 is nearest
    EXPECT_EQ(scene.instances[4].probe, 3u);
}

TEST(FinishScene, OwnProbeWinsOverTheNearest) {
    Scene scene = makeTriangles({{vec3(0), 0}, {vec3(9, 0, 0), 0}});
    scene.probes = {{vec3(0, 0, 0), kNone}, {vec3(50, 0, 0), 0}, {vec3(8, 0, 0), kNone}};
    finishScene(scene);
    EXPECT_EQ(scene.probes.size(), 3u);
    EXPECT_EQ(scene.instances[0].probe, 1u);
    EXPECT_EQ(scene.instances[1].probe, 2u);
}

TEST(FinishScene, DefaultCameraHasEverythingInView) {
    Scene scene = makeTriangles({{vec3(-20, 3, 7), 1}, {vec3(4, 9, -12), 1}});
    finishScene(scene);
    ASSERT_EQ(scene.cameras.size(), 1u);
    const Camera camera = makeCamera(scene.camera(""));
    EXPECT_GT(camera.position.z, scene.bounds.high.z);
    EXPECT_GT(camera.position.y, scene.bounds.center().y);
    EXPECT_EQ(camera.forward.x, 0.0f);
    EXPECT_LT(camera.forward.z, 0.0f);
    for (int corner = 0; corner < 8; ++corner) {
        const vec3 point((corner & 1) != 0 ? scene.bounds.high.x : scene.bounds.low.x,
                         (corner & 2) != 0 ? scene.bounds.high.y : scene.bounds.low.y,
                         (corner & 4) != 0 ? scene.bounds.high.z : scene.bounds.low.z);
        const vec3 seen = point - camera.position;
        const float depth = glm::dot(seen, camera.forward);
        EXPECT_GT(depth, camera.near);
        EXPECT_LE(std::abs(glm::dot(seen, camera.up)), depth * camera.tan_half_fov_y);
        EXPECT_LE(std::abs(glm::dot(seen, camera.right)), depth * camera.tan_half_fov_y);
    }
}

TEST(FinishScene, AnEmptySceneHasACamera) {
    Scene scene;
    finishScene(scene);
    EXPECT_NO_THROW((void)makeCamera(scene.camera("")));
    EXPECT_TRUE(scene.bounds.empty());
}

TEST(FinishScene, VersionsAreNewAndNeverZero) {
    Scene first = makeTriangles({{vec3(0), 1}});
    Scene second = first;
    finishScene(first);
    finishScene(second);
    EXPECT_NE(first.version, 0u);
    EXPECT_NE(first.version, second.version);
    const std::uint64_t before = first.version;
    touch(first);
    EXPECT_NE(first.version, before);
    EXPECT_NE(first.version, second.version);
}

TEST(FinishScene, NamesTheIndexThatIsOutOfRange) {
    Scene corner = makeTriangles({{vec3(0), 1}});
    corner.triangles[1].y = 3;
    EXPECT_EQ(finishError(corner), "triangles: triangle 1 names position 3, but there are 3");
    Scene material = makeTriangles({{vec3(0), 1}});
    material.meshes[1].material = 2;
    EXPECT_EQ(finishError(material), "triangles: mesh 1 names material 2, but there are 2");
    Scene mesh = makeTriangles({{vec3(0), 2}});
    EXPECT_EQ(finishError(mesh), "triangles: instance 0 names mesh 2, but there are 2");
    Scene range = makeTriangles({{vec3(0), 1}});
    range.meshes[1].triangle_count = 0xffffffffu;
    EXPECT_EQ(finishError(range), "triangles: mesh 1 reaches past the 2 triangles that there are");
    Scene probe = makeTriangles({{vec3(0), 1}});
    probe.probes = {{vec3(0), 1}};
    EXPECT_EQ(finishError(probe), "triangles: probe 0 names object 1, but there are 1");
    Scene texture = makeTriangles({{vec3(0), 1}});
    texture.materials[0].base_color_texture = 0;
    EXPECT_EQ(finishError(texture), "triangles: material 0 names texture 0, but there are 0");
}

TEST(FinishScene, RefusesMeshesThatShareTriangles) {
    Scene scene = makeTriangles({{vec3(0), 1}});
    scene.meshes[1].first_triangle = 0;
    EXPECT_EQ(finishError(scene), "triangles: mesh 1 shares triangle 0 with another mesh");
}

TEST(FinishScene, RefusesTexturesWithoutTexels) {
    Scene scene = makeTriangles({{vec3(0), 1}});
    scene.textures = {{0, 2, 2, 2, 0, 0}};
    scene.texels.resize(4); // 2 x 2 and 1 x 1 need five
    EXPECT_NE(finishError(scene).find("texture 0"), std::string::npos);
    scene.texels.resize(5);
    EXPECT_NO_THROW(finishScene(scene));
}

TEST(FinishScene, RefusesWhatIsNotFinite) {
    Scene position = makeTriangles({{vec3(0), 1}});
    position.positions[2].x = std::numeric_limits<float>::infinity();
    EXPECT_EQ(finishError(position), "triangles: position 2 is not finite");
    Scene transform = makeTriangles({{vec3(std::nanf("")), 1}});
    EXPECT_EQ(finishError(transform), "triangles: instance 0: its transform is not finite");
}

} // namespace
} // namespace hone

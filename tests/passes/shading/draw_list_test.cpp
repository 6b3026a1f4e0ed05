// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/shading/draw_list.h"

#include "hone/backends/host/host_device.h"
#include "hone/tests/support/scene_builder.h"

#include <gtest/gtest.h>

#include <vector>

namespace hone {
namespace {

/// From the origin along -z, 90 degrees wide.
View ahead() {
    View view{};
    view.camera.forward = vec3(0, 0, -1);
    view.camera.right = vec3(1, 0, 0);
    view.camera.up = vec3(0, 1, 0);
    view.camera.tan_half_fov_y = 1.0f;
    view.camera.near = 0.1f;
    view.extent = {64, 64};
    return view;
}

/// A triangle around `middle` that turns counter-clockwise seen from +z.
uint addTriangle(test::SceneBuilder& builder, vec3 middle, uint flags = 0) {
    const vec3 positions[] = {middle + vec3(-0.1f, -0.1f, 0), middle + vec3(0.1f, -0.1f, 0),
                              middle + vec3(0, 0.1f, 0)};
    const uvec3 triangles[] = {{0, 1, 2}};
    return builder.addMesh(positions, triangles, builder.addMaterial(test::plainMaterial(flags)));
}

struct Listed {
    std::vector<uint> opaque, masked; ///< instances, in the order in which they are drawn
};

Listed listOf(const Scene& scene, const View& view, const Culling& culling = {}) {
    const auto device = makeHostDevice();
    WorldGeometry world;
    world.update(*device, scene);
    DrawList list;
    list.build(*device, scene, world, view, culling);
    auto instances = [&](BufferView draws) {
        std::vector<uint> result;
        for (const DrawIndexed& draw : draws.as<DrawIndexed>())
            for (uint i = 0; i < draw.index_count / 3; ++i) {
                EXPECT_EQ(draw.first_index, 3 * draw.first_instance);
                result.push_back(list.triangleIds().as<uvec2>()[draw.first_instance + i].x);
            }
        return result;
    };
    return {instances(list.opaqueDraws()), instances(list.maskedDraws())};
}

using Instances = std::vector<uint>;

TEST(DrawList, GoesFrontToBackAndLeavesOutWhatIsOutside) {
    test::SceneBuilder builder;
    for (const vec3 middle : {vec3(0, 0, -9), vec3(0, 0, -3), vec3(0, 0, 3), vec3(8, 0, -3),
                              vec3(-2.5f, 0, -3), vec3(0, 5, -4)})
        builder.addInstance(addTriangle(builder, middle));
    EXPECT_EQ(listOf(builder.finish(), ahead()).opaque, (Instances{1, 4, 0}));
}

TEST(DrawList, LeavesOutBackFacesOfSingleSidedMaterialsOnly) {
    mat4 turned(1.0f); // by 180 degrees around y
    turned[0][0] = turned[2][2] = -1;
    test::SceneBuilder builder;
    builder.addInstance(addTriangle(builder, vec3(0, 0, 3)), turned);
    builder.addInstance(addTriangle(builder, vec3(0, 0, 4), kMaterialTwoSided), turned);
    const Scene scene = builder.finish();
    EXPECT_EQ(listOf(scene, ahead()).opaque, (Instances{1}));
    EXPECT_EQ(listOf(scene, ahead(), {.back_faces = false}).opaque, (Instances{0, 1}));
}

TEST(DrawList, SeesTheFrontOfMirroredInstances) {
    // Mirrored along x a front stays a front, though it turns the other way round; mirrored along z
    // it looks away.
    mat4 along_x(1.0f), along_z(1.0f);
    along_x[0][0] = -1;
    along_z[2][2] = -1;
    test::SceneBuilder builder;
    builder.addInstance(addTriangle(builder, vec3(0, 0, -3)), along_x);
    builder.addInstance(addTriangle(builder, vec3(0, 0, 3)), along_z);
    EXPECT_EQ(listOf(builder.finish(), ahead()).opaque, (Instances{0}));
}

TEST(DrawList, LeavesOutClustersThatFaceAwayWhole) {
    test::SceneBuilder builder;
    builder.addInstance(addTriangle(builder, vec3(0, 0, -3)));
    Scene scene = builder.finish();
    // A cone that claims to face away: the cluster goes, though its triangle is a front.
    scene.clusters[0].cone_axis = vec3(0, 0, -1);
    scene.clusters[0].cone_cutoff = 0.0f;
    EXPECT_TRUE(listOf(scene, ahead()).opaque.empty());
    scene.clusters[0].cone_axis = vec3(0, 0, 1);
    EXPECT_EQ(listOf(scene, ahead()).opaque, (Instances{0}));
}

TEST(DrawList, KeepsMaskedMaterialsApartAndAnInstanceOut) {
    test::SceneBuilder builder;
    builder.addInstance(addTriangle(builder, vec3(0, 0, -2), kMaterialMasked));
    builder.addInstance(addTriangle(builder, vec3(0, 0, -3)));
    builder.addInstance(addTriangle(builder, vec3(0, 0, -4)));
    const Listed listed = listOf(builder.finish(), ahead(), {.without = 2});
    EXPECT_EQ(listed.masked, (Instances{0}));
    EXPECT_EQ(listed.opaque, (Instances{1}));
}

TEST(DrawList, CullsForABoxToo) {
    View view = ahead();
    view.camera.tan_half_fov_y = 2.0f; // metres to each side
    view.depth_range = 5.0f;
    test::SceneBuilder builder;
    for (const vec3 middle : {vec3(1.5f, 0, -4), vec3(1.5f, 0, -0.5f), vec3(2.5f, 0, -4),
                              vec3(0, 0, -6), vec3(0, 0, 1)})
        builder.addInstance(addTriangle(builder, middle));
    EXPECT_EQ(listOf(builder.finish(), view, {.back_faces = false}).opaque, (Instances{1, 0}));
}

TEST(DrawList, OfAnEmptySceneIsEmpty) {
    const Listed listed = listOf(test::SceneBuilder().finish(), ahead());
    EXPECT_TRUE(listed.opaque.empty());
    EXPECT_TRUE(listed.masked.empty());
}

} // namespace
} // namespace hone

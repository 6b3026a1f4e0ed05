// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/scene_buffers.h"

#include "hone/backends/host/host_device.h"
#include "hone/core/device/recording_device.h"
#include "hone/core/scene/scene_arrays.h"
#include "hone/tests/support/scene_builder.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>

namespace hone::test {
namespace {

Scene twoTriangles() {
    SceneBuilder builder;
    const uint mesh =
        builder.addMesh(std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                        std::vector<uvec3>{{0, 1, 2}}, builder.addMaterial(plainMaterial()));
    builder.addInstance(mesh);
    builder.addInstance(mesh, glm::translate(mat4(1), vec3(5, 0, 0)));
    return builder.finish();
}

TEST(SceneBuffers, AreTheScenesOwnBytesWhereTheDeviceCanUseThem) {
    const auto device = makeHostDevice();
    const Scene scene = twoTriangles();
    const SceneBuffers buffers(*device, scene);
    EXPECT_EQ(buffers.find("scene_positions").as<vec3>().data(), scene.positions.data());
    EXPECT_EQ(buffers.find("scene_triangles").as<uvec3>().data(), scene.triangles.data());
    EXPECT_EQ(buffers.find("scene_environment").as<Environment>().data(), &scene.environment);
    EXPECT_TRUE(buffers.copies().empty());
}

TEST(SceneBuffers, BindEachArrayUnderItsNameWithAllItsBytes) {
    const auto device = makeHostDevice();
    const Scene scene = twoTriangles();
    const SceneBuffers buffers(*device, scene);
    EXPECT_EQ(buffers.find("scene_instances").bytes, 2 * sizeof(Instance));
    EXPECT_EQ(buffers.find("scene_srgb").bytes, 256 * sizeof(float));
    std::size_t arrays = 0;
    forEachSceneArray(scene, [&](std::string_view name, auto elements) {
        ++arrays;
        if (!elements.empty()) {
            EXPECT_EQ(buffers.find(name).bytes, elements.size_bytes()) << name;
        }
    });
    EXPECT_EQ(buffers.arguments().size(), arrays);
}

TEST(SceneBuffers, GiveEmptyArraysOneZeroedElement) {
    const auto device = makeHostDevice();
    const Scene scene = twoTriangles();
    ASSERT_TRUE(scene.lights.empty());
    const SceneBuffers buffers(*device, scene);
    const std::span<Light> lights = buffers.find("scene_lights").as<Light>();
    ASSERT_EQ(lights.size(), 1u);
    EXPECT_EQ(lights[0].intensity, vec3(0));
    // Textures, texels and probes are empty, too.
    EXPECT_EQ(buffers.bytes(), sizeof(Light) + sizeof(Texture) + sizeof(uint) + sizeof(Probe));
}

TEST(SceneBuffers, CopyWhatTheDeviceCannotUseAndSayWhat) {
    RecordingDevice device; // imports nothing
    const Scene scene = twoTriangles();
    const SceneBuffers buffers(device, scene);
    EXPECT_NE(buffers.find("scene_positions").as<vec3>().data(), scene.positions.data());
    EXPECT_EQ(buffers.find("scene_positions").as<vec3>()[1], vec3(1, 0, 0));
    std::size_t bytes = 0;
    for (const MemoryCopy& copy : buffers.copies())
        bytes += copy.bytes;
    EXPECT_EQ(bytes, 3 * (12 + 12 + 8) + 12 + sizeof(Mesh) + 2 * sizeof(Instance) +
                         sizeof(Material) + 1024 + sizeof(Environment));
    EXPECT_EQ(buffers.copies()[0].what, "scene_positions");
    EXPECT_EQ(buffers.copies()[0].why, "recording cannot use memory of the host where it is");
}

TEST(SceneBuffers, FollowMovedInstances) {
    Scene scene = twoTriangles();
    RecordingDevice copying;
    const auto sharing = makeHostDevice();
    SceneBuffers copied(copying, scene);
    SceneBuffers shared(*sharing, scene);
    mat4x3 there(1);
    there[3] = vec3(0, 7, 0);
    moveInstance(scene, 1, there);
    EXPECT_EQ(shared.find("scene_instances").as<Instance>()[1].to_world[3], vec3(0, 7, 0))
        << "it is the scene's own";
    EXPECT_EQ(copied.find("scene_instances").as<Instance>()[1].to_world[3], vec3(5, 0, 0));
    for (SceneBuffers* buffers : {&copied, &shared}) {
        buffers->update(scene);
        const std::span<Instance> instances = buffers->find("scene_instances").as<Instance>();
        EXPECT_EQ(instances[0].to_world[3], vec3(0, 0, 0));
        EXPECT_EQ(instances[1].to_world[3], vec3(0, 7, 0));
    }
}

TEST(SrgbTable, HoldsTheStandardsValues) {
    const PagedVector<float>& table = srgbTable();
    ASSERT_EQ(table.size(), 256u);
    EXPECT_EQ(table[0], 0.0f);
    EXPECT_EQ(table[255], 1.0f);
    EXPECT_FLOAT_EQ(table[10], 10.0f / 255.0f / 12.92f); // 0.0392 is on the straight piece
    EXPECT_NEAR(table[188], 0.5029f, 1e-4f);             // ((0.7373 + 0.055) / 1.055)^2.4
}

} // namespace
} // namespace hone::test

// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/support/scene_builder.h"

#include <atomic>

namespace hone::test {
namespace {

uint sizeOf(const auto& items) {
    return static_cast<uint>(items.size());
}

/// A ball around all positions of the mesh; its cone cannot be culled.
Cluster wholeMesh(const Scene& scene, const Mesh& mesh) {
    vec3 low(1e30f);
    vec3 high(-1e30f);
    for (uint i = 0; i < mesh.triangle_count; ++i)
        for (int corner = 0; corner < 3; ++corner) {
            const vec3 p = scene.positions[scene.triangles[mesh.first_triangle + i][corner]];
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
    return {.first_triangle = mesh.first_triangle,
            .triangle_count = mesh.triangle_count,
            .center = 0.5f * (low + high),
            .radius = 0.5f * glm::length(high - low),
            .cone_axis = vec3(0, 1, 0),
            .cone_cutoff = 1};
}

} // namespace

Material plainMaterial(uint flags) {
    return {.base_color = vec3(1),
            .base_color_texture = kNone,
            .emission = vec3(0),
            .alpha = 1,
            .f0 = vec3(0),
            .alpha_cutoff = 0.5f,
            .flags = flags};
}

uint SceneBuilder::addTexture(uint width, uint height, std::span<const uint> texels, uint wrap) {
    scene_.textures.push_back({sizeOf(scene_.texels), width, height, 1, wrap, wrap});
    scene_.texels.insert(scene_.texels.end(), texels.begin(), texels.end());
    return sizeOf(scene_.textures) - 1;
}

uint SceneBuilder::addMaterial(const Material& material) {
    scene_.materials.push_back(material);
    scene_.material_names.push_back("material " + std::to_string(scene_.materials.size() - 1));
    return sizeOf(scene_.materials) - 1;
}

uint SceneBuilder::addMesh(std::span<const vec3> positions, std::span<const uvec3> triangles,
                           uint material, std::span<const vec2> uvs) {
    const uint base = sizeOf(scene_.positions);
    scene_.meshes.push_back({.first_triangle = sizeOf(scene_.triangles),
                             .triangle_count = sizeOf(triangles),
                             .material = material,
                             .first_cluster = 0,
                             .cluster_count = 0});
    scene_.positions.insert(scene_.positions.end(), positions.begin(), positions.end());
    scene_.uvs.insert(scene_.uvs.end(), uvs.begin(), uvs.end());
    scene_.uvs.resize(scene_.positions.size(), vec2(0));
    scene_.normals.resize(scene_.positions.size(), vec3(0));
    for (const uvec3& corners : triangles) {
        const uvec3 global = corners + base;
        scene_.triangles.push_back(global);
        const vec3 a = scene_.positions[global.x];
        const vec3 normal =
            glm::cross(scene_.positions[global.y] - a, scene_.positions[global.z] - a);
        for (int corner = 0; corner < 3; ++corner)
            scene_.normals[global[corner]] += normal;
    }
    return sizeOf(scene_.meshes) - 1;
}

uint SceneBuilder::addInstance(uint mesh, const mat4& to_world) {
    const mat3 linear(to_world);
    scene_.instances.push_back({.to_world = mat4x3(to_world),
                                .normal_matrix = glm::transpose(glm::inverse(linear)),
                                .mesh = mesh,
                                .probe = kNone,
                                .flipped = glm::determinant(linear) < 0.0f ? 1u : 0u});
    scene_.instance_names.push_back("instance " + std::to_string(scene_.instances.size() - 1));
    return sizeOf(scene_.instances) - 1;
}

uint SceneBuilder::add(std::span<const vec3> positions, std::span<const uvec3> triangles,
                       uint material, std::span<const vec2> uvs) {
    return addInstance(addMesh(positions, triangles, material, uvs));
}

Scene SceneBuilder::finish() const {
    static std::atomic<std::uint64_t> count = 0;
    Scene scene = scene_;
    for (vec3& normal : scene.normals)
        normal = glm::length(normal) > 0.0f ? glm::normalize(normal) : vec3(0, 1, 0);
    for (Mesh& mesh : scene.meshes) {
        if (mesh.triangle_count == 0)
            continue;
        mesh.first_cluster = sizeOf(scene.clusters);
        mesh.cluster_count = 1;
        scene.clusters.push_back(wholeMesh(scene, mesh));
    }
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        for (uint i = 0; i < mesh.triangle_count; ++i)
            for (int corner = 0; corner < 3; ++corner) {
                const uint vertex = scene.triangles[mesh.first_triangle + i][corner];
                const vec3 p = instance.to_world * vec4(scene.positions[vertex], 1.0f);
                scene.bounds.low = glm::min(scene.bounds.low, p);
                scene.bounds.high = glm::max(scene.bounds.high, p);
            }
    }
    if (scene.cameras.empty())
        scene.cameras.push_back({.name = "default"});
    scene.name = "test";
    scene.version = (std::uint64_t{1} << 63) + ++count; // far from those that finishScene gives
    return scene;
}

} // namespace hone::test

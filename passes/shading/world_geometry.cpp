// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/shading/world_geometry.h"

#include <algorithm>
#include <cmath>

namespace hone {
namespace {

/// The vertices that a mesh's triangles use lie in [first, end).
struct VertexRange {
    uint first = 0xffffffffu;
    uint end = 0;
};

VertexRange vertexRange(const Scene& scene, const Mesh& mesh) {
    VertexRange range;
    for (const uvec3& corners :
         std::span(scene.triangles).subspan(mesh.first_triangle, mesh.triangle_count)) {
        range.first = std::min({range.first, corners.x, corners.y, corners.z});
        range.end = std::max({range.end, corners.x + 1, corners.y + 1, corners.z + 1});
    }
    range.first = std::min(range.first, range.end);
    return range;
}

/// A length that no unit vector exceeds once transformed: the square root of a bound on the largest
/// eigenvalue of MtM (Gershgorin's circles), exact where the columns are orthogonal.
float largestScale(const mat4x3& to_world) {
    const mat3 linear(to_world);
    const mat3 squared = glm::transpose(linear) * linear;
    float largest = 0;
    for (int i = 0; i < 3; ++i)
        largest = std::max(largest, std::abs(squared[i].x) + std::abs(squared[i].y) +
                                        std::abs(squared[i].z));
    return std::sqrt(largest);
}

} // namespace

void WorldGeometry::update(Device& device, const Scene& scene) {
    if (version_ == scene.version)
        return;

    // Give each instance a stretch of world vertices.
    std::vector<VertexRange> ranges;
    for (const Mesh& mesh : scene.meshes)
        ranges.push_back(vertexRange(scene, mesh));
    uint vertices = 0;
    vertex_offsets_.clear();
    for (const Instance& instance : scene.instances) {
        const VertexRange range = ranges[instance.mesh];
        vertex_offsets_.push_back(vertices - range.first);
        vertices += range.end - range.first;
    }

    // Place the vertices and bound the clusters.
    if (positions_.bytes() < vertices * sizeof(vec3) || !positions_)
        positions_ = device.createBuffer(vertices * sizeof(vec3), "world_positions");
    const std::span<vec3> placed = positions_.as<vec3>();
    clusters_.clear();
    for (uint i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const VertexRange range = ranges[instance.mesh];
        for (uint vertex = range.first; vertex < range.end; ++vertex)
            placed[vertex + vertex_offsets_[i]] =
                instance.to_world * vec4(scene.positions[vertex], 1.0f);
        const Mesh& mesh = scene.meshes[instance.mesh];
        const float scale = largestScale(instance.to_world) * (1.0f + 1e-5f);
        for (uint k = mesh.first_cluster; k < mesh.first_cluster + mesh.cluster_count; ++k) {
            const Cluster& cluster = scene.clusters[k];
            clusters_.push_back(
                {instance.to_world * vec4(cluster.center, 1.0f), cluster.radius * scale, i, k});
        }
    }
    version_ = scene.version;
}

} // namespace hone

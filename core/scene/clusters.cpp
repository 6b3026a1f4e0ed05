// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/clusters.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <limits>

namespace hone {
namespace {

/// meshoptimizer's most: with 128 triangles the corners are hardly ever what ends a cluster.
constexpr std::size_t kClusterVertices = 255;
/// How much a narrow cone of normals counts against a small sphere, 0 to 1.
constexpr float kConeWeight = 0.5f;

/// The positions that a mesh uses, as meshoptimizer sees them: its scratch memory grows with the
/// number of vertices, so a mesh shows it its own range only.
struct MeshView {
    std::span<uvec3> triangles;
    uint first_vertex;
    std::span<const vec3> positions;
};

MeshView viewMesh(Scene& scene, const Mesh& mesh) {
    MeshView view{std::span(scene.triangles).subspan(mesh.first_triangle, mesh.triangle_count),
                  std::numeric_limits<uint>::max(),
                  {}};
    uint last = 0;
    for (const uvec3& corners : view.triangles)
        for (int corner = 0; corner < 3; ++corner) {
            view.first_vertex = std::min(view.first_vertex, corners[corner]);
            last = std::max(last, corners[corner]);
        }
    view.positions = std::span<const vec3>(scene.positions)
                         .subspan(view.first_vertex, last - view.first_vertex + 1);
    return view;
}

/// The record of one meshlet, made safe: the sphere reaches every corner (meshoptimizer leaves out
/// triangles without area, and rounds), and a cluster without any area is never culled by its cone.
Cluster boundCluster(const meshopt_Bounds& bounds, std::span<const uvec3> triangles,
                     std::span<const vec3> positions, uint first_vertex) {
    Cluster cluster{};
    cluster.triangle_count = static_cast<uint>(triangles.size());
    cluster.center = vec3(bounds.center[0], bounds.center[1], bounds.center[2]);
    cluster.cone_axis = vec3(bounds.cone_axis[0], bounds.cone_axis[1], bounds.cone_axis[2]);
    cluster.cone_cutoff = bounds.cone_cutoff;
    if (cluster.cone_axis == vec3(0.0f))
        cluster.cone_cutoff = 1.0f;
    if (bounds.radius == 0.0f)
        cluster.center = positions[triangles.front().x - first_vertex];
    float radius = bounds.radius;
    for (const uvec3& corners : triangles)
        for (int corner = 0; corner < 3; ++corner)
            radius = std::max(
                radius, glm::distance(cluster.center, positions[corners[corner] - first_vertex]));
    // A little more than the farthest corner: the culling test rounds as well.
    cluster.radius = radius * (1.0f + 1e-5f);
    return cluster;
}

class ClusterBuilder {
public:
    explicit ClusterBuilder(Scene& scene) : scene_(scene) {}

    void add(Mesh& mesh) {
        mesh.first_cluster = static_cast<uint>(scene_.clusters.size());
        mesh.cluster_count = 0;
        if (mesh.triangle_count == 0)
            return;
        const MeshView view = viewMesh(scene_, mesh);
        const std::size_t meshlet_count = cut(view);

        // Copy the triangles back in the order of the meshlets and bound each meshlet.
        uint next = 0;
        for (std::size_t i = 0; i < meshlet_count; ++i) {
            const meshopt_Meshlet& meshlet = meshlets_[i];
            const unsigned* vertices = &vertices_[meshlet.vertex_offset];
            const unsigned char* corners = &corners_[meshlet.triangle_offset];
            for (uint t = 0; t < meshlet.triangle_count; ++t)
                view.triangles[next + t] = view.first_vertex + uvec3(vertices[corners[3 * t]],
                                                                     vertices[corners[3 * t + 1]],
                                                                     vertices[corners[3 * t + 2]]);
            const meshopt_Bounds bounds = meshopt_computeMeshletBounds(
                vertices, corners, meshlet.triangle_count, &view.positions.front().x,
                view.positions.size(), sizeof(vec3));
            Cluster& cluster = scene_.clusters.emplace_back(
                boundCluster(bounds, view.triangles.subspan(next, meshlet.triangle_count),
                             view.positions, view.first_vertex));
            cluster.first_triangle = mesh.first_triangle + next;
            next += meshlet.triangle_count;
        }
        mesh.cluster_count = static_cast<uint>(meshlet_count);
    }

private:
    /// Fills the scratch arrays; returns the number of meshlets.
    std::size_t cut(const MeshView& view) {
        indices_.clear();
        for (const uvec3& corners : view.triangles)
            for (int corner = 0; corner < 3; ++corner)
                indices_.push_back(corners[corner] - view.first_vertex);
        const std::size_t most =
            meshopt_buildMeshletsBound(indices_.size(), kClusterVertices, kClusterTriangles);
        meshlets_.resize(most);
        vertices_.resize(most * kClusterVertices);
        corners_.resize(most * kClusterTriangles * 3);
        return meshopt_buildMeshlets(meshlets_.data(), vertices_.data(), corners_.data(),
                                     indices_.data(), indices_.size(), &view.positions.front().x,
                                     view.positions.size(), sizeof(vec3), kClusterVertices,
                                     kClusterTriangles, kConeWeight);
    }

    Scene& scene_;
    std::vector<unsigned> indices_;
    std::vector<meshopt_Meshlet> meshlets_;
    std::vector<unsigned> vertices_;
    std::vector<unsigned char> corners_;
};

} // namespace

void buildClusters(Scene& scene) {
    scene.clusters.clear();
    ClusterBuilder builder(scene);
    for (Mesh& mesh : scene.meshes)
        builder.add(mesh);
}

} // namespace hone

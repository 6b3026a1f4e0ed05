// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/clusters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace hone {
namespace {

constexpr uint kRings = 40;
constexpr uint kSectors = 60;

/// Appends a unit sphere, counter-clockwise from outside, as one mesh. Its poles are rings of
/// triangles without area.
void addSphere(Scene& scene, vec3 center) {
    const auto first_vertex = static_cast<uint>(scene.positions.size());
    const auto first_triangle = static_cast<uint>(scene.triangles.size());
    for (uint ring = 0; ring <= kRings; ++ring)
        for (uint sector = 0; sector <= kSectors; ++sector) {
            const double theta = std::numbers::pi * ring / kRings;
            const double phi = 2 * std::numbers::pi * sector / kSectors;
            // Exactly one point at each pole, so that the triangles there have no area at all.
            const double radius = ring == 0 || ring == kRings ? 0.0 : std::sin(theta);
            scene.positions.push_back(
                center + vec3(radius * std::cos(phi), std::cos(theta), -radius * std::sin(phi)));
        }
    auto vertex = [&](uint ring, uint sector) {
        return first_vertex + ring * (kSectors + 1) + sector;
    };
    for (uint ring = 0; ring < kRings; ++ring)
        for (uint sector = 0; sector < kSectors; ++sector) {
            scene.triangles.emplace_back(vertex(ring, sector), vertex(ring + 1, sector),
                                         vertex(ring + 1, sector + 1));
            scene.triangles.emplace_back(vertex(ring, sector), vertex(ring + 1, sector + 1),
                                         vertex(ring, sector + 1));
        }
    scene.meshes.push_back(
        {first_triangle, static_cast<uint>(scene.triangles.size()) - first_triangle, 0, 0, 0});
}

Scene makeSpheres() {
    Scene scene;
    addSphere(scene, vec3(0));
    addSphere(scene, vec3(5, 0, 0));
    return scene;
}

std::vector<std::array<uint, 3>> sorted(std::span<const uvec3> triangles) {
    std::vector<std::array<uint, 3>> result;
    for (const uvec3& t : triangles)
        result.push_back({t.x, t.y, t.z});
    std::ranges::sort(result);
    return result;
}

TEST(Clusters, KeepEachTriangleOfEachMeshOnceWithItsWinding) {
    const Scene before = makeSpheres();
    Scene scene = before;
    buildClusters(scene);
    EXPECT_NE(scene.triangles, before.triangles);
    for (const Mesh& mesh : scene.meshes) {
        const auto range = [&](const Scene& s) {
            return std::span(s.triangles).subspan(mesh.first_triangle, mesh.triangle_count);
        };
        // Equal corner for corner: the first corner stays the first.
        EXPECT_EQ(sorted(range(scene)), sorted(range(before)));
    }
}

TEST(Clusters, CoverEachMeshInOrder) {
    Scene scene = makeSpheres();
    buildClusters(scene);
    uint next_cluster = 0;
    for (const Mesh& mesh : scene.meshes) {
        EXPECT_EQ(mesh.first_cluster, next_cluster);
        uint next_triangle = mesh.first_triangle;
        for (uint i = 0; i < mesh.cluster_count; ++i) {
            const Cluster& cluster = scene.clusters[mesh.first_cluster + i];
            EXPECT_EQ(cluster.first_triangle, next_triangle);
            EXPECT_GE(cluster.triangle_count, 1u);
            EXPECT_LE(cluster.triangle_count, kClusterTriangles);
            next_triangle += cluster.triangle_count;
        }
        EXPECT_EQ(next_triangle, mesh.first_triangle + mesh.triangle_count);
        next_cluster += mesh.cluster_count;
    }
    EXPECT_EQ(scene.clusters.size(), next_cluster);
    // 9600 triangles need 75 full clusters; well-filled ones are not many more.
    EXPECT_LE(scene.clusters.size(), 120u);
}

TEST(Clusters, SpheresHoldAllCorners) {
    Scene scene = makeSpheres();
    buildClusters(scene);
    for (const Cluster& cluster : scene.clusters)
        for (uint i = 0; i < cluster.triangle_count; ++i)
            for (int corner = 0; corner < 3; ++corner) {
                const vec3 p = scene.positions[scene.triangles[cluster.first_triangle + i][corner]];
                EXPECT_LE(glm::distance(p, cluster.center), cluster.radius);
            }
}

TEST(Clusters, ConesCullOnlyWhatFacesAway) {
    Scene scene = makeSpheres();
    buildClusters(scene);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> coordinate(-8.0f, 8.0f);
    std::size_t culled = 0;
    for (int view = 0; view < 200; ++view) {
        const vec3 eye(coordinate(random), coordinate(random), coordinate(random));
        for (const Cluster& cluster : scene.clusters) {
            const vec3 to_center = cluster.center - eye;
            if (glm::dot(to_center, cluster.cone_axis) <
                cluster.cone_cutoff * glm::length(to_center) + cluster.radius)
                continue;
            ++culled;
            for (uint i = 0; i < cluster.triangle_count; ++i) {
                const uvec3 t = scene.triangles[cluster.first_triangle + i];
                const glm::dvec3 a(scene.positions[t.x]);
                const glm::dvec3 normal = glm::cross(glm::dvec3(scene.positions[t.y]) - a,
                                                     glm::dvec3(scene.positions[t.z]) - a);
                EXPECT_GE(glm::dot(normal, a - glm::dvec3(eye)), -1e-12);
            }
        }
    }
    EXPECT_GT(culled, 200u * scene.clusters.size() / 10) << "cones are of some use";
}

TEST(Clusters, TrianglesWithoutAreaAreHarmless) {
    Scene scene;
    scene.positions = {vec3(1), vec3(2), vec3(3)};
    scene.triangles = {uvec3(0, 1, 2), uvec3(0, 0, 0), uvec3(1, 1, 2)};
    scene.meshes = {{0, 3, 0, 0, 0}};
    buildClusters(scene);
    EXPECT_EQ(sorted(scene.triangles),
              (std::vector<std::array<uint, 3>>{{0, 0, 0}, {0, 1, 2}, {1, 1, 2}}));
    uint covered = 0;
    for (const Cluster& cluster : scene.clusters) {
        covered += cluster.triangle_count;
        EXPECT_TRUE(std::isfinite(cluster.radius));
        EXPECT_EQ(cluster.cone_cutoff, 1.0f) << "no cone, so it is never culled";
    }
    EXPECT_EQ(covered, 3u);
}

TEST(Clusters, AreTheSameEachTime) {
    Scene first = makeSpheres();
    Scene second = first;
    buildClusters(first);
    buildClusters(second);
    EXPECT_EQ(first.triangles, second.triangles);
}

TEST(Clusters, EmptyMeshesHaveNone) {
    Scene scene = makeSpheres();
    scene.meshes.push_back({static_cast<uint>(scene.triangles.size()), 0, 0, 9, 9});
    buildClusters(scene);
    EXPECT_EQ(scene.meshes.back().cluster_count, 0u);
}

} // namespace
} // namespace hone

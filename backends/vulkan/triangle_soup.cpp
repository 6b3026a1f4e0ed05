// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan/triangle_soup.h"

#include <glm/vec3.hpp>

#include <utility>

namespace hone {
namespace {

/// Exact: a difference of two floats of a scene's scale, and a product of two such, fit a double.
bool hasArea(const std::array<vec3, 3>& corners) {
    using glm::dvec3;
    const dvec3 a(corners[0]);
    const dvec3 normal = glm::cross(dvec3(corners[1]) - a, dvec3(corners[2]) - a);
    return glm::dot(normal, normal) > 0.0; // no NaN is
}

} // namespace

void TriangleSoup::add(std::array<vec3, 3> triangle, Hit name) {
    if (!hasArea(triangle))
        return;
    corners.push_back(triangle);
    names.push_back(name);
}

void TriangleSoup::addInstance(const Scene& scene, const HostSurface& surface, uint instance) {
    const Instance& placed = scene.instances[instance];
    const Mesh& mesh = scene.meshes[placed.mesh];
    for (uint primitive = 0; primitive < mesh.triangle_count; ++primitive) {
        const uvec3 vertices = scene.triangles[mesh.first_triangle + primitive];
        std::array<vec3, 3> triangle{surface.worldPosition(placed, vertices.x),
                                     surface.worldPosition(placed, vertices.y),
                                     surface.worldPosition(placed, vertices.z)};
        if (placed.flipped != 0)
            std::swap(triangle[1], triangle[2]);
        add(triangle, {instance, primitive});
    }
}

void TriangleSoup::addMesh(const Scene& scene, uint index) {
    const Mesh& mesh = scene.meshes[index];
    for (uint primitive = 0; primitive < mesh.triangle_count; ++primitive) {
        const uvec3 vertices = scene.triangles[mesh.first_triangle + primitive];
        add({scene.positions[vertices.x], scene.positions[vertices.y], scene.positions[vertices.z]},
            {kNone, primitive});
    }
}

} // namespace hone

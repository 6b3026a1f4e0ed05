// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/embree/world_vertices.h"

#include <algorithm>

namespace hone {
namespace {

/// What Embree reads past the last vertex: 16 bytes, in whole vertices.
constexpr std::size_t kPadding = 2;

bool isIdentity(const Instance& instance) {
    return instance.to_world == mat4x3(1.0f);
}

} // namespace

WorldVertices::WorldVertices(const Scene& scene, const HostSurface& surface,
                             std::span<const std::uint8_t> is_instanced)
    : scene_(&scene), surface_(&surface), places_(scene.instances.size()) {
    std::vector<uint> owners(scene.positions.size(), kNone);
    std::size_t end = scene.positions.size();
    for (uint index = 0; index < places_.size(); ++index) {
        const std::span<const uvec3> triangles = trianglesOf(index);
        if (triangles.empty() || is_instanced[scene.instances[index].mesh] != 0)
            continue;

        // Which positions, and does another instance use one of them already?
        uint low = kNone;
        uint high = 0;
        bool is_taken = false;
        for (const uvec3& corners : triangles)
            for (int corner = 0; corner < 3; ++corner) {
                low = std::min(low, corners[corner]);
                high = std::max(high, corners[corner]);
                is_taken |= owners[corners[corner]] != kNone;
            }
        Place& place = places_[index];
        place.count = high + std::size_t{1};
        if (is_taken) {
            // Behind all positions, so that element 0 of its array, though not its own, exists.
            place.first = end - low;
            place.own = place.count - low;
            end += place.own;
            continue;
        }
        for (const uvec3& corners : triangles)
            for (int corner = 0; corner < 3; ++corner)
                if (std::exchange(owners[corners[corner]], index) != index)
                    ++place.own;
    }
    world_ = std::make_unique_for_overwrite<vec3[]>(end + kPadding);
}

std::span<const uvec3> WorldVertices::trianglesOf(uint instance) const {
    const Mesh& mesh = scene_->meshes[scene_->instances[instance].mesh];
    return std::span(scene_->triangles).subspan(mesh.first_triangle, mesh.triangle_count);
}

std::span<const vec3> WorldVertices::place(uint index) {
    const Instance& instance = scene_->instances[index];
    Place& place = places_[index];
    if (!place.has_moved && isIdentity(instance))
        return scene_->positions;
    place.has_moved = true;
    bytes_ += sizeof(vec3) * std::exchange(place.own, 0);
    const std::span<vec3> vertices(&world_[place.first], place.count);
    for (const uvec3& corners : trianglesOf(index))
        for (int corner = 0; corner < 3; ++corner)
            vertices[corners[corner]] = surface_->worldPosition(instance, corners[corner]);
    return vertices;
}

} // namespace hone

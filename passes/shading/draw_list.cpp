// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/shading/draw_list.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

namespace hone {
namespace {

/// Triangles that one task writes and one draw draws, about.
constexpr uint kChunkTriangles = 4096;

/// Half-spaces whose intersection is the view; a point is inside where dot(normal, point) + offset
/// >= 0. Normals are unit.
struct Plane {
    vec3 normal;
    float offset;
};

std::array<Plane, 6> planes(const View& view) {
    const Camera& camera = view.camera;
    const bool is_box = view.depth_range > 0;
    const float half_height = camera.tan_half_fov_y;
    const float half_width =
        half_height * static_cast<float>(view.extent.x) / static_cast<float>(view.extent.y);
    auto through = [](vec3 point, vec3 normal) {
        normal = glm::normalize(normal);
        return Plane{normal, -glm::dot(normal, point)};
    };
    // The sides: through the eye and leaning with the field of view, or upright around the box.
    auto side = [&](vec3 axis, float half) {
        return is_box ? through(camera.position - half * axis, axis)
                      : through(camera.position, axis + half * camera.forward);
    };
    const float near = is_box ? 0.0f : camera.near;
    const float far = is_box ? view.depth_range : 1e30f;
    return {side(camera.right, half_width),
            side(-camera.right, half_width),
            side(camera.up, half_height),
            side(-camera.up, half_height),
            through(camera.position + near * camera.forward, camera.forward),
            Plane{-camera.forward, glm::dot(camera.forward, camera.position) + far}};
}

bool isOutside(const std::array<Plane, 6>& planes, vec3 center, float radius) {
    return std::ranges::any_of(planes, [&](const Plane& plane) {
        return glm::dot(plane.normal, center) + plane.offset < -radius;
    });
}

/// Whether every face of the cluster is turned away from the eye (object space). Sides of planes
/// stay what they are under any placement, mirroring ones included.
bool isTurnedAway(const Cluster& cluster, vec3 eye) {
    const vec3 to_center = cluster.center - eye;
    return cluster.cone_cutoff < 1.0f &&
           glm::dot(to_center, cluster.cone_axis) >=
               cluster.cone_cutoff * glm::length(to_center) + cluster.radius;
}

const Material& materialOf(const Scene& scene, uint instance) {
    return scene.materials[scene.meshes[scene.instances[instance].mesh].material];
}

void grow(Device& device, Buffer& buffer, std::size_t bytes, std::string_view name) {
    if (!buffer || buffer.bytes() < bytes)
        buffer = device.createBuffer(bytes + bytes / 2, name);
}

} // namespace

void DrawList::findVisible(const Scene& scene, const WorldGeometry& world, const View& view,
                           const Culling& culling) {
    eyes_.clear();
    for (const Instance& instance : scene.instances) {
        const mat3 linear(instance.to_world);
        eyes_.push_back(glm::inverse(linear) * (view.camera.position - instance.to_world[3]));
    }

    const std::array<Plane, 6> sides = planes(view);
    visible_.clear();
    const std::span<const WorldGeometry::PlacedCluster> clusters = world.clusters();
    for (uint i = 0; i < clusters.size(); ++i) {
        const WorldGeometry::PlacedCluster& placed = clusters[i];
        if (placed.instance == culling.without || isOutside(sides, placed.center, placed.radius))
            continue;
        const bool is_single_sided =
            (materialOf(scene, placed.instance).flags & kMaterialTwoSided) == 0;
        if (culling.back_faces && is_single_sided &&
            isTurnedAway(scene.clusters[placed.cluster], eyes_[placed.instance]))
            continue;
        visible_.push_back({glm::distance(placed.center, view.camera.position) - placed.radius, i});
    }

    const auto is_opaque = [&](const Visible& visible) {
        return (materialOf(scene, clusters[visible.cluster].instance).flags & kMaterialMasked) == 0;
    };
    const auto middle = std::partition(visible_.begin(), visible_.end(), is_opaque);
    opaque_ = static_cast<std::size_t>(middle - visible_.begin());
    const auto is_nearer = [](const Visible& a, const Visible& b) {
        return a.distance != b.distance ? a.distance < b.distance : a.cluster < b.cluster;
    };
    std::sort(visible_.begin(), middle, is_nearer);
    std::sort(middle, visible_.end(), is_nearer);
}

void DrawList::cutChunks(const Scene& scene, const WorldGeometry& world) {
    chunks_.clear();
    uint triangles = 0;
    for (std::size_t i = 0; i < visible_.size(); ++i) {
        if (i == opaque_)
            opaque_chunks_ = chunks_.size();
        if (i == 0 || i == opaque_ || triangles - chunks_.back().first_triangle >= kChunkTriangles)
            chunks_.push_back({i, i, triangles});
        chunks_.back().end = i + 1;
        triangles += scene.clusters[world.clusters()[visible_[i].cluster].cluster].triangle_count;
    }
    if (opaque_ == visible_.size())
        opaque_chunks_ = chunks_.size();
    capacity_needed_ = triangles;
}

uint DrawList::writeChunk(const Chunk& chunk, const Scene& scene, const WorldGeometry& world,
                          const View& view, const Culling& culling) const {
    const std::span<const vec3> positions = world.positions().as<vec3>();
    uvec3* const indices = indices_.as<uvec3>().data();
    uvec2* const ids = ids_.as<uvec2>().data();
    uint next = chunk.first_triangle;
    for (std::size_t i = chunk.begin; i < chunk.end; ++i) {
        const WorldGeometry::PlacedCluster& placed = world.clusters()[visible_[i].cluster];
        const Cluster& cluster = scene.clusters[placed.cluster];
        const Instance& instance = scene.instances[placed.instance];
        const uint first_of_mesh = scene.meshes[instance.mesh].first_triangle;
        const uint offset = world.vertexOffset(placed.instance);
        const bool both_faces = !culling.back_faces ||
                                (materialOf(scene, placed.instance).flags & kMaterialTwoSided) != 0;
        const float front = instance.flipped != 0 ? -1.0f : 1.0f;
        for (uint k = cluster.first_triangle; k < cluster.first_triangle + cluster.triangle_count;
             ++k) {
            const uvec3 corners = scene.triangles[k] + offset;
            indices[next] = corners;
            ids[next] = {placed.instance, k - first_of_mesh};
            // Which side is seen changes from triangle to triangle: no branch, keep it or not.
            const vec3 a = positions[corners.x];
            const vec3 area = glm::cross(positions[corners.y] - a, positions[corners.z] - a);
            const bool is_front = front * glm::dot(area, view.camera.position - a) > 0.0f;
            next += (both_faces | is_front) ? 1u : 0u;
        }
    }
    return next - chunk.first_triangle;
}

void DrawList::build(Device& device, const Scene& scene, const WorldGeometry& world,
                     const View& view, const Culling& culling) {
    findVisible(scene, world, view, culling);
    cutChunks(scene, world);

    grow(device, indices_, capacity_needed_ * sizeof(uvec3), "draw_list_indices");
    grow(device, ids_, capacity_needed_ * sizeof(uvec2), "draw_list_ids");
    grow(device, draws_, chunks_.size() * sizeof(DrawIndexed), "draw_list_draws");
    tbb::parallel_for(std::size_t{0}, chunks_.size(), [&](std::size_t i) {
        const uint count = writeChunk(chunks_[i], scene, world, view, culling);
        draws_.as<DrawIndexed>()[i] = {.index_count = 3 * count,
                                       .first_index = 3 * chunks_[i].first_triangle,
                                       .first_instance = chunks_[i].first_triangle};
    });
}

BufferView DrawList::opaqueDraws() const {
    return draws_.view().part(0, opaque_chunks_ * sizeof(DrawIndexed));
}

BufferView DrawList::maskedDraws() const {
    const std::size_t first = opaque_chunks_ * sizeof(DrawIndexed);
    return draws_.view().part(first, (chunks_.size() - opaque_chunks_) * sizeof(DrawIndexed));
}

std::size_t DrawList::triangles() const {
    std::size_t total = 0;
    for (const DrawIndexed& draw : draws_.as<DrawIndexed>().first(chunks_.size()))
        total += draw.index_count / 3;
    return total;
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/brute/brute_backend.h"

#include "hone/core/error.h"
#include "hone/core/scene/host_surface.h"
#include "hone/core/trace/traceable.h"

#include <glm/vec3.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <optional>

namespace hone {
namespace {

using glm::dvec3;

/// A triangle in the world, as worldPosition() places it.
struct WorldTriangle {
    dvec3 a, b, c;
    Hit name;
    bool two_sided;
    bool flipped;
    bool masked;
};

/// Where a ray meets a triangle's plane inside the triangle.
struct Crossing {
    double t;
    bool front; ///< seen on the side where the corners turn counter-clockwise
};

/// The crossing by edge functions in double precision: the ray passes the triangle if it passes
/// its three edges on the same side (Pluecker coordinates; Benthin 2006, section 4.1.3). The
/// function of an edge that two triangles share is the same bits with the opposite sign, and zero
/// counts as inside, so no ray slips between neighbours.
std::optional<Crossing> cross(const dvec3& origin, const dvec3& direction,
                              const WorldTriangle& triangle) {
    const dvec3 a = triangle.a - origin;
    const dvec3 b = triangle.b - origin;
    const dvec3 c = triangle.c - origin;
    const double ab = glm::dot(direction, glm::cross(a, b));
    const double bc = glm::dot(direction, glm::cross(b, c));
    const double ca = glm::dot(direction, glm::cross(c, a));
    if (std::min({ab, bc, ca}) < 0.0 && std::max({ab, bc, ca}) > 0.0)
        return {};
    // A ray in the plane and a triangle without area both have a zero here.
    const dvec3 normal = glm::cross(triangle.b - triangle.a, triangle.c - triangle.a);
    const double slope = glm::dot(direction, normal);
    if (slope == 0.0)
        return {};
    return Crossing{glm::dot(a, normal) / slope, slope < 0.0};
}

class BruteBackend final : public TraceBackend {
public:
    TraceCaps caps() const override {
        return {.name = "brute",
                .version = "1",
                .runs_on = "host",
                .always_exact = true,
                .settles_ties = true,
                .is_reference = true};
    }

    BuildStats build(const Scene& scene, const SceneBuffers*) override {
        const auto begin = std::chrono::steady_clock::now();
        scene_ = &scene;
        surface_.emplace(scene);
        triangles_.clear();
        for (uint i = 0; i < scene.instances.size(); ++i)
            addInstance(scene, i);
        const std::chrono::duration<double, std::milli> passed =
            std::chrono::steady_clock::now() - begin;
        return {.ms = passed.count(),
                .triangles = triangles_.size(),
                .bytes = triangles_.size() * sizeof(WorldTriangle)};
    }

    BuildStats update(std::span<const uint>) override { return build(*scene_, nullptr); }

    void closest(std::span<const Ray> rays, std::span<Hit> hits, Coherence,
                 const TraceOptions&) const override {
        HONE_ASSERT(rays.size() == hits.size(), "one hit a ray");
        tbb::parallel_for(std::size_t{0}, rays.size(),
                          [&](std::size_t i) { hits[i] = closestOf(rays[i]); });
    }

    void occluded(std::span<const Ray> rays, std::span<uint> occluded, Coherence,
                  const TraceOptions&) const override {
        HONE_ASSERT(rays.size() == occluded.size(), "one answer a ray");
        tbb::parallel_for(std::size_t{0}, rays.size(),
                          [&](std::size_t i) { occluded[i] = isOccluded(rays[i]) ? 1u : 0u; });
    }

private:
    void addInstance(const Scene& scene, uint index) {
        const Instance& instance = scene.instances[index];
        const Mesh& mesh = scene.meshes[instance.mesh];
        const uint flags = scene.materials[mesh.material].flags;
        for (uint primitive = 0; primitive < mesh.triangle_count; ++primitive) {
            const uvec3 corners = scene.triangles[mesh.first_triangle + primitive];
            triangles_.push_back({.a = dvec3(surface_->worldPosition(instance, corners.x)),
                                  .b = dvec3(surface_->worldPosition(instance, corners.y)),
                                  .c = dvec3(surface_->worldPosition(instance, corners.z)),
                                  .name = {index, primitive},
                                  .two_sided = (flags & kMaterialTwoSided) != 0,
                                  .flipped = instance.flipped != 0,
                                  .masked = (flags & kMaterialMasked) != 0});
        }
    }

    /// The crossing, if it lies in the ray's range and not in a hole.
    std::optional<Crossing> meet(const Ray& ray, const WorldTriangle& triangle) const {
        std::optional<Crossing> crossing = cross(dvec3(ray.origin), dvec3(ray.direction), triangle);
        if (!crossing || !(crossing->t >= std::max(ray.tmin, 0.0f) && crossing->t <= ray.tmax))
            return {};
        if (triangle.masked && !surface_->isSolid(ray, triangle.name))
            return {};
        return crossing;
    }

    // Triangles are in the order (instance, primitive), so the first of equal t wins.
    Hit closestOf(const Ray& ray) const {
        Hit nearest{kNone, kNone};
        double nearest_t = std::numeric_limits<double>::infinity();
        if (!isTraceable(ray))
            return nearest;
        for (const WorldTriangle& triangle : triangles_) {
            const std::optional<Crossing> crossing = meet(ray, triangle);
            if (!crossing || crossing->t >= nearest_t)
                continue;
            if (!triangle.two_sided && crossing->front == triangle.flipped)
                continue;
            nearest = triangle.name;
            nearest_t = crossing->t;
        }
        return nearest;
    }

    bool isOccluded(const Ray& ray) const {
        return isTraceable(ray) && std::ranges::any_of(triangles_, [&](const WorldTriangle& it) {
                   return meet(ray, it).has_value();
               });
    }

    const Scene* scene_ = nullptr;
    std::optional<HostSurface> surface_;
    std::vector<WorldTriangle> triangles_;
};

} // namespace

std::unique_ptr<TraceBackend> makeBruteBackend() {
    return std::make_unique<BruteBackend>();
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/trace/check/crossing.h"

#include "hone/core/trace/traceable.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hone {
namespace {

using glm::dvec2, glm::dvec3, glm::dmat3, glm::dmat4x3;

/// Steps of a float, of relative size 2^-24, that a tracer may be off by.
constexpr double kRounding = 32.0 / 16777216.0;

double largest(const dvec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// The ray as a line to look along: seen that way, triangles are flat figures around the origin.
struct Line {
    explicit Line(const Ray& ray)
        : origin(ray.origin), speed(glm::length(dvec3(ray.direction))),
          along(dvec3(ray.direction) / speed), begin(std::max(ray.tmin, 0.0f)), end(ray.tmax) {
        // An axis that is not nearly parallel.
        const dvec3 other = std::abs(along.x) < 0.6 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
        right = glm::normalize(glm::cross(other, along));
        up = glm::cross(along, right);
    }
    [[nodiscard]] dvec2 project(const dvec3& from_origin) const {
        return {glm::dot(from_origin, right), glm::dot(from_origin, up)};
    }

    dvec3 origin;
    double speed; ///< length of the direction
    dvec3 along, right, up;
    double begin, end; ///< in t
};

double cross2(const dvec2& a, const dvec2& b) {
    return a.x * b.y - a.y * b.x;
}

/// From the origin to the segment.
double distanceToSegment(const dvec2& a, const dvec2& b) {
    const dvec2 edge = b - a;
    const double squared = glm::dot(edge, edge);
    const double s = squared > 0 ? std::clamp(-glm::dot(a, edge) / squared, 0.0, 1.0) : 0.0;
    return glm::length(a + s * edge);
}

/// A triangle as the line sees it.
struct Figure {
    explicit Figure(const std::array<dvec2, 3>& corners) {
        const double ab = cross2(corners[0], corners[1]);
        const double bc = cross2(corners[1], corners[2]);
        const double ca = cross2(corners[2], corners[0]);
        is_inside = std::min({ab, bc, ca}) > 0 || std::max({ab, bc, ca}) < 0;
        double_area = std::abs(ab + bc + ca);
        for (std::size_t i = 0; i < 3; ++i) {
            const dvec2 &a = corners[i], &b = corners[(i + 1) % 3];
            nearest_edge = std::min(nearest_edge, distanceToSegment(a, b));
            longest_edge = std::max(longest_edge, glm::length(b - a));
        }
    }
    bool is_inside = false; ///< the line passes it
    double double_area = 0;
    double nearest_edge = HUGE_VAL; ///< from the line
    double longest_edge = 0;
};

/// Whether the corners all lie more than `slack` to one side of the line.
bool isBeside(const std::array<dvec2, 3>& c, double slack) {
    return std::min({c[0].x, c[1].x, c[2].x}) > slack ||
           std::max({c[0].x, c[1].x, c[2].x}) < -slack ||
           std::min({c[0].y, c[1].y, c[2].y}) > slack ||
           std::max({c[0].y, c[1].y, c[2].y}) < -slack;
}

/// The largest of the numbers that a point's place in the world is the sum of.
double termsOf(const dmat4x3& to_world, const dvec3& point) {
    dvec3 terms = glm::abs(to_world[3]);
    for (int column = 0; column < 3; ++column)
        terms += glm::abs(to_world[column] * point[column]);
    return largest(terms);
}

dmat3 absolute(const dmat3& m) {
    return {glm::abs(m[0]), glm::abs(m[1]), glm::abs(m[2])};
}

/// The largest of the numbers that `point` is the sum of once a tracer has taken it to an
/// instance's own space and back: more than its own where a matrix shears or turns what it scales.
double detourOf(const dmat4x3& to_world, const dvec3& point) {
    const dmat3 linear(to_world);
    const dvec3 terms = glm::abs(point) + glm::abs(to_world[3]);
    const double detour = largest(absolute(linear) * (absolute(glm::inverse(linear)) * terms));
    return std::isfinite(detour) ? detour : 0.0; // a flattened instance has no way back
}

class CrossingSearch {
public:
    CrossingSearch(const Scene& scene, const HostSurface& surface, const Ray& ray)
        : scene_(scene), surface_(surface), ray_(ray), line_(ray) {}

    std::vector<Crossing> run() {
        for (uint i = 0; i < scene_.instances.size(); ++i)
            searchInstance(i);
        return std::move(found_);
    }

private:
    void searchInstance(uint index) {
        const Instance& instance = scene_.instances[index];
        const Mesh& mesh = scene_.meshes[instance.mesh];
        const dmat4x3 to_world(instance.to_world);
        double squared_stretch = 0; // Frobenius norm: no direction is stretched more
        for (int column = 0; column < 3; ++column)
            squared_stretch += glm::dot(to_world[column], to_world[column]);
        const double stretch = std::sqrt(squared_stretch);
        const double detour = detourOf(to_world, line_.origin);
        for (uint c = mesh.first_cluster; c < mesh.first_cluster + mesh.cluster_count; ++c) {
            const Cluster& cluster = scene_.clusters[c];
            const dvec3 center = to_world * glm::dvec4(cluster.center, 1);
            // A little more than rounding can take, of the corners and of the ball itself.
            const double radius = cluster.radius * stretch;
            const double size =
                termsOf(to_world, cluster.center) + radius + largest(line_.origin) + detour;
            const double slack = 1e-5 * size;
            if (!passesBall(center, radius + slack))
                continue;
            for (uint i = 0; i < cluster.triangle_count; ++i)
                meet({index, cluster.first_triangle + i - mesh.first_triangle}, instance, mesh,
                     detour, slack);
        }
    }

    [[nodiscard]] bool passesBall(const dvec3& center, double radius) const {
        const dvec3 offset = center - line_.origin;
        const double depth = glm::dot(offset, line_.along);
        return glm::length(line_.project(offset)) <= radius &&
               depth + radius >= line_.begin * line_.speed &&
               depth - radius <= line_.end * line_.speed;
    }

    /// How far rounding may move the ray against the triangle, in metres. `detour`: of its
    /// instance.
    [[nodiscard]] double roundingAt(const dmat4x3& to_world, const uvec3& corners,
                                    double detour) const {
        double size = std::max(largest(line_.origin), detour);
        for (int corner = 0; corner < 3; ++corner)
            size = std::max(size, termsOf(to_world, dvec3(scene_.positions[corners[corner]])));
        return kRounding * size;
    }

    /// `slack`: more than roundingAt() gives.
    void meet(Hit hit, const Instance& instance, const Mesh& mesh, double detour, double slack) {
        const uvec3 corners = scene_.triangles[mesh.first_triangle + hit.primitive];
        std::array<dvec3, 3> at; // from the ray's origin
        std::array<dvec2, 3> seen;
        for (int i = 0; i < 3; ++i) {
            at[i] = dvec3(surface_.worldPosition(instance, corners[i])) - line_.origin;
            seen[i] = line_.project(at[i]);
        }
        if (isBeside(seen, slack))
            return;
        const dvec3 normal = glm::cross(at[1] - at[0], at[2] - at[0]);
        if (normal == dvec3(0))
            return;

        // Does the ray pass the triangle?
        const double rounding = roundingAt(dmat4x3(instance.to_world), corners, detour);
        const Figure figure(seen);
        if (!figure.is_inside && figure.nearest_edge > rounding)
            return;
        Crossing crossing{.hit = hit};
        if (figure.nearest_edge <= rounding)
            crossing.border = Border::kEdge;
        if (figure.double_area <= 2 * rounding * figure.longest_edge)
            crossing.border = Border::kGrazing;

        // Which face does it see?
        const bool turns_counter_clockwise = glm::dot(line_.along, normal) < 0;
        const bool is_front = turns_counter_clockwise != (instance.flipped != 0);
        const uint flags = scene_.materials[mesh.material].flags;
        crossing.is_seen =
            is_front || (flags & kMaterialTwoSided) != 0 || crossing.border == Border::kGrazing;

        placeOnRay(crossing, at, normal, rounding);
        if (!limitToRange(crossing))
            return;
        if ((flags & kMaterialMasked) != 0 && !limitToMask(crossing, rounding))
            return;
        found_.push_back(crossing);
    }

    /// Where the ray meets the plane, inside the corners' depths: a slanted plane is met anywhere
    /// between them if the ray is moved by rounding.
    void placeOnRay(Crossing& crossing, const std::array<dvec3, 3>& at, const dvec3& normal,
                    double rounding) const {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (const dvec3& corner : at) {
            low = std::min(low, glm::dot(corner, line_.along));
            high = std::max(high, glm::dot(corner, line_.along));
        }
        const double slope = glm::dot(line_.along, normal) / glm::length(normal);
        double depth = 0.5 * (low + high);
        double error = 0.5 * (high - low);
        if (slope != 0) {
            depth = std::clamp(glm::dot(at[0], normal) / glm::dot(line_.along, normal), low, high);
            error = std::min(high - low, rounding / std::abs(slope));
        }
        crossing.t = depth / line_.speed;
        crossing.t_error = (error + rounding) / line_.speed;
    }

    [[nodiscard]] bool limitToRange(Crossing& crossing) const {
        const double low = crossing.t - crossing.t_error, high = crossing.t + crossing.t_error;
        if (high < line_.begin || low > line_.end)
            return false;
        if (crossing.border == Border::kNone && (low < line_.begin || high > line_.end))
            crossing.border = Border::kRange;
        return true;
    }

    /// Asks the routine that every tracer asks, for the ray and for eight around it.
    [[nodiscard]] bool limitToMask(Crossing& crossing, double rounding) const {
        constexpr int kAround = 8;
        int solid = surface_.isSolid(ray_, crossing.hit) ? 1 : 0;
        for (int i = 0; i < kAround; ++i) {
            const double angle = 2 * 3.14159265358979 * i / kAround;
            Ray moved = ray_;
            moved.origin = vec3(line_.origin + rounding * (std::cos(angle) * line_.right +
                                                           std::sin(angle) * line_.up));
            solid += surface_.isSolid(moved, crossing.hit) ? 1 : 0;
        }
        if (solid == 0)
            return false;
        if (solid <= kAround && crossing.border == Border::kNone)
            crossing.border = Border::kMask;
        return true;
    }

    const Scene& scene_;
    const HostSurface& surface_;
    const Ray& ray_;
    Line line_;
    std::vector<Crossing> found_;
};

} // namespace

std::vector<Crossing> findCrossings(const Scene& scene, const HostSurface& surface,
                                    const Ray& ray) {
    if (!isTraceable(ray))
        return {};
    return CrossingSearch(scene, surface, ray).run();
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
//
// A trace backend of one's own, out of hone's tree: triangles are sorted into halves along the
// widest axis, again and again; rays are tested against boxes around the halves first. To use it:
//     cmake -S . -B build -DCMAKE_PREFIX_PATH=/where/hone/is/installed && cmake --build build
//     hone render sir --plugin build/libcustom.so --set backend=custom -o out
//     hone selftest --backends custom --plugin build/libcustom.so
//
// A folder named in HONE_PLUGIN_PATH saves the --plugin. hone_plugin.h says what must be answered.
#include <hone_plugin.hpp>

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

using glm::dvec3;
constexpr std::size_t kLeaf = 4; // triangles that are not worth another box

struct Triangle {
    dvec3 a, b, c;
    hone_hit name;
    bool two_sided, flipped;
};

struct Box {
    dvec3 low{INFINITY}, high{-INFINITY};
};

/// A ray on its way: its range ends where the nearest hit so far is.
struct Traveller {
    const hone_ray& ray;
    bool any; // any hit will do: the first one ends the way
    dvec3 origin{ray.origin[0], ray.origin[1], ray.origin[2]};
    dvec3 direction{ray.direction[0], ray.direction[1], ray.direction[2]};
    double tmin = std::max(ray.tmin, 0.0f), tmax = ray.tmax;
    hone_hit nearest = hone::plugin::kMiss;

    bool meets(const Box& box) const {
        const dvec3 inverse = 1.0 / direction;
        const dvec3 low = (box.low - origin) * inverse, high = (box.high - origin) * inverse;
        const auto turned = glm::lessThan(inverse, dvec3(0));
        const dvec3 near = glm::mix(low, high, turned), far = glm::mix(high, low, turned);
        // 0 * infinity is NaN, which min and max pass over. The factor is more than was rounded.
        return std::max({tmin, near.x, near.y, near.z}) <=
               std::min({tmax, far.x, far.y, far.z}) * (1 + 1e-12);
    }
};

class MedianSplit {
public:
    explicit MedianSplit(hone::plugin::Host host) : host_(host) {}

    void build(const hone_scene& scene) {
        scene_ = &scene;
        triangles_.clear();
        for (uint32_t i = 0; i < scene.instance_count; ++i) {
            const bool flipped = scene.instances[i].flipped != 0;
            const hone_mesh& mesh = scene.meshes[scene.instances[i].mesh];
            const bool two_sided = scene.materials[mesh.material].flags & HONE_MATERIAL_TWO_SIDED;
            for (uint32_t k = 0; k < mesh.triangle_count; ++k) {
                const auto corner = [&](int number) {
                    const uint32_t vertex = scene.triangles[mesh.first_triangle + k][number];
                    const auto [x, y, z] = host_.worldPosition(scene, i, vertex);
                    return dvec3(x, y, z);
                };
                triangles_.push_back({corner(0), corner(1), corner(2), {i, k}, two_sided, flipped});
            }
        }
        boxes_.clear();
        split(0, 0, triangles_.size());
    }

    hone_hit closest(const hone_ray& ray) const { return find(ray, false); }
    bool occluded(const hone_ray& ray) const { return find(ray, true).instance != HONE_NONE; }

private:
    /// Sorts the triangles from begin to end. The halves of node n are nodes 2n + 1 and 2n + 2.
    void split(std::size_t node, std::size_t begin, std::size_t end) {
        Box box;
        for (std::size_t i = begin; i < end; ++i)
            for (const dvec3& corner : {triangles_[i].a, triangles_[i].b, triangles_[i].c})
                box = {glm::min(box.low, corner), glm::max(box.high, corner)};
        boxes_.resize(std::max(boxes_.size(), node + 1));
        boxes_[node] = box;
        const std::size_t middle = (begin + end) / 2;
        if (end - begin <= kLeaf)
            return;
        const dvec3 size = box.high - box.low;
        const int axis = size.x >= std::max(size.y, size.z) ? 0 : size.y >= size.z ? 1 : 2;
        const auto center = [=](const Triangle& t) { return t.a[axis] + t.b[axis] + t.c[axis]; };
        Triangle* all = triangles_.data();
        std::ranges::nth_element(all + begin, all + middle, all + end, {}, center);
        split(2 * node + 1, begin, middle);
        split(2 * node + 2, middle, end);
    }

    hone_hit find(const hone_ray& ray, bool any) const {
        Traveller traveller{ray, any};
        walk(0, 0, triangles_.size(), traveller);
        return traveller.nearest;
    }

    void walk(std::size_t node, std::size_t begin, std::size_t end, Traveller& traveller) const {
        if (!traveller.meets(boxes_[node]))
            return;
        if (end - begin > kLeaf) {
            walk(2 * node + 1, begin, (begin + end) / 2, traveller);
            walk(2 * node + 2, (begin + end) / 2, end, traveller);
            return;
        }
        for (std::size_t i = begin; i < end; ++i)
            meet(triangles_[i], traveller);
    }

    void meet(const Triangle& triangle, Traveller& traveller) const {
        const dvec3 a = triangle.a - traveller.origin, b = triangle.b - traveller.origin,
                    c = triangle.c - traveller.origin, direction = traveller.direction;
        // On which side of each edge the ray passes: neighbours get the same bits, so no cracks.
        const double sides[] = {dot(direction, cross(a, b)), dot(direction, cross(b, c)),
                                dot(direction, cross(c, a))};
        if (std::ranges::min(sides) < 0 && std::ranges::max(sides) > 0)
            return;
        const dvec3 normal = cross(triangle.b - triangle.a, triangle.c - triangle.a);
        const double slope = dot(direction, normal), t = dot(a, normal) / slope;
        const bool is_hidden = !triangle.two_sided && (slope < 0) == triangle.flipped;
        if (!(t >= traveller.tmin && t < traveller.tmax) || // also where t is NaN
            (is_hidden && !traveller.any) || !host_.isSolid(*scene_, traveller.ray, triangle.name))
            return;
        traveller.tmax = traveller.any ? -1 : t;
        traveller.nearest = triangle.name;
    }

    hone::plugin::Host host_;
    const hone_scene* scene_ = nullptr;
    std::vector<Triangle> triangles_;
    std::vector<Box> boxes_;
};

} // namespace

HONE_TRACE_PLUGIN(MedianSplit, {.name = "custom",
                                .version = "1.0",
                                .license = "Apache-2.0",
                                .doc = "Halves of halves: the example of a plug-in.",
                                .flags = HONE_TRACE_ALWAYS_EXACT})

// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/bvh/bvh_scene.h"

#include "hone/core/error.h"
#include "hone/core/trace/instancing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hone {
namespace {

using glm::dvec3, glm::dmat3;

/// Triangles of a leaf at most; what is best is up to the builder's cost model.
constexpr uint kLeafSize = 4;
/// Links of eight octants are numbered in 32 bits.
constexpr std::size_t kMaxNodes = std::size_t{1} << 28;

Bounds boundsOf(const BvhTriangle& triangle) {
    Bounds bounds;
    for (const vec3& corner : {triangle.a, triangle.b, triangle.c})
        bounds.add(corner);
    return bounds;
}

Bounds join(const Bounds& a, const Bounds& b) {
    return {glm::min(a.low, b.low), glm::max(a.high, b.high)};
}

float greatestCoordinate(const Bounds& bounds) {
    if (bounds.empty())
        return 0.0f;
    const vec3 far = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
    return std::max({far.x, far.y, far.z});
}

/// Whether a triangle can be hit: it has an area, and coordinates that rays reach. Differences of
/// floats and their products are exact in double precision, or nearly.
bool canBeHit(const BvhTriangle& triangle) {
    for (const vec3& corner : {triangle.a, triangle.b, triangle.c})
        for (int axis = 0; axis < 3; ++axis)
            if (!(std::fabs(corner[axis]) < 1e18f)) // nor is NaN
                return false;
    const dvec3 a(triangle.a);
    return glm::cross(dvec3(triangle.b) - a, dvec3(triangle.c) - a) != dvec3(0.0);
}

} // namespace

BvhScene::BvhScene(const Scene& scene, const BvhBuilder& builder, std::size_t flatten_triangles)
    : scene_(&scene), surface_(scene) {
    const std::vector<std::uint8_t> is_instanced = chooseInstanced(scene, flatten_triangles);

    // Collect the world's triangles, and the instances whose meshes get a tree of their own.
    std::vector<BvhTriangle> flat;
    std::vector<uint> placed_meshes; // by instances_
    for (uint index = 0; index < scene.instances.size(); ++index) {
        const Instance& instance = scene.instances[index];
        const Mesh& mesh = scene.meshes[instance.mesh];
        if (mesh.triangle_count == 0)
            continue;
        is_masked_ |= (scene.materials[mesh.material].flags & kMaterialMasked) != 0;
        if (is_instanced[instance.mesh] != 0) {
            instances_.push_back({.to_object = {}, .instance = index, .root = 0, .extent = 0});
            placed_meshes.push_back(instance.mesh);
            continue;
        }
        for (uint primitive = 0; primitive < mesh.triangle_count; ++primitive)
            flat.push_back(makeTriangle(&instance, index, mesh, primitive));
    }
    triangle_count_ = flat.size();
    const Bvh flat_tree = buildTriangles(flat, builder);

    // A tree for each instanced mesh. The world's comes first in the arrays, but needs their boxes.
    struct MeshTree {
        uint mesh;
        Bvh tree;
        std::vector<BvhTriangle> triangles;
        uint root = 0;
    };
    std::vector<MeshTree> mesh_trees;
    std::vector<uint> tree_of(scene.meshes.size(), kNone);
    std::vector<Bounds> boxes;
    for (std::size_t i = 0; i < instances_.size(); ++i) {
        uint& number = tree_of[placed_meshes[i]];
        if (number == kNone) {
            number = static_cast<uint>(mesh_trees.size());
            MeshTree& made = mesh_trees.emplace_back();
            made.mesh = placed_meshes[i];
            const Mesh& mesh = scene.meshes[made.mesh];
            for (uint primitive = 0; primitive < mesh.triangle_count; ++primitive)
                made.triangles.push_back(makeTriangle(nullptr, kNone, mesh, primitive));
            triangle_count_ += made.triangles.size();
            made.tree = buildTriangles(made.triangles, builder);
        }
        const Bounds& object_bounds = mesh_trees[number].tree.nodes.front().bounds;
        instances_[i].extent = greatestCoordinate(object_bounds);
        boxes.push_back(placeInstance(instances_[i], object_bounds));
    }
    const Bvh placed_tree = builder({.boxes = boxes, .triangles = {}, .leaf_size = 1});

    // Lay out the arrays.
    appendWorld(flat_tree, flat, placed_tree);
    for (MeshTree& made : mesh_trees) {
        made.root = static_cast<uint>(nodes_.size());
        append(made.tree, made.triangles);
        roots_.push_back(made.root);
        made = {.mesh = made.mesh, .tree = {}, .triangles = {}, .root = made.root};
    }
    for (std::size_t i = 0; i < instances_.size(); ++i)
        instances_[i].root = mesh_trees[tree_of[placed_meshes[i]]].root;
    link();
}

BvhTriangle BvhScene::makeTriangle(const Instance* placed, uint instance, const Mesh& mesh,
                                   uint primitive) const {
    const uint material = scene_->materials[mesh.material].flags;
    BvhTriangle triangle{};
    triangle.instance = instance;
    triangle.primitive = primitive;
    triangle.flags = ((material & kMaterialTwoSided) != 0 ? kBvhTwoSided : 0) |
                     ((material & kMaterialMasked) != 0 ? kBvhMasked : 0);
    placeTriangle(placed, mesh, triangle);
    return triangle;
}

void BvhScene::placeTriangle(const Instance* placed, const Mesh& mesh,
                             BvhTriangle& triangle) const {
    const uvec3 corners = scene_->triangles[mesh.first_triangle + triangle.primitive];
    const auto place = [&](uint position) {
        return placed != nullptr ? surface_.worldPosition(*placed, position)
                                 : scene_->positions[position];
    };
    triangle.a = place(corners.x);
    triangle.b = place(corners.y);
    triangle.c = place(corners.z);
    if (!canBeHit(triangle)) {
        if (!(glm::length(triangle.a) < 1e18f))
            triangle.a = vec3(0.0f);
        triangle.b = triangle.c = triangle.a;
    }
    // In a mesh's own space fronts turn counter-clockwise even if the instance is flipped.
    triangle.flags &= ~kBvhFlipped;
    if (placed != nullptr && placed->flipped != 0)
        triangle.flags |= kBvhFlipped;
}

Bvh BvhScene::buildTriangles(std::span<const BvhTriangle> triangles, const BvhBuilder& builder) {
    std::vector<Bounds> boxes;
    std::vector<std::array<vec3, 3>> corners;
    boxes.reserve(triangles.size());
    corners.reserve(triangles.size());
    for (const BvhTriangle& triangle : triangles) {
        boxes.push_back(boundsOf(triangle));
        corners.push_back({triangle.a, triangle.b, triangle.c});
    }
    return builder({.boxes = boxes, .triangles = corners, .leaf_size = kLeafSize});
}

Bounds BvhScene::placeInstance(BvhInstance& placed, const Bounds& object_bounds) const {
    const mat4x3& to_world = scene_->instances[placed.instance].to_world;
    const dmat3 linear(to_world);
    const dmat3 inverse = glm::inverse(linear);
    const dvec3 offset(to_world[3]);
    placed.to_object = mat4x3(mat3(inverse));
    placed.to_object[3] = vec3(inverse * -offset);

    Bounds bounds;
    for (uint corner = 0; corner < 8; ++corner) {
        const dvec3 at((corner & 1) != 0 ? object_bounds.high.x : object_bounds.low.x,
                       (corner & 2) != 0 ? object_bounds.high.y : object_bounds.low.y,
                       (corner & 4) != 0 ? object_bounds.high.z : object_bounds.low.z);
        bounds.add(vec3(linear * at + offset));
    }
    return bounds;
}

void BvhScene::append(const Bvh& tree, std::span<const BvhTriangle> triangles) {
    const auto first_node = static_cast<uint>(nodes_.size());
    const auto first_triangle = static_cast<uint>(triangles_.size());
    for (const Bvh::Node& node : tree.nodes) {
        bounds_.push_back(node.bounds);
        nodes_.push_back(node.count == 0
                             ? BvhNode{{}, first_node + node.link, {}, node.axis}
                             : BvhNode{{}, first_triangle + node.link, {}, kBvhLeaf + node.count});
    }
    for (const uint primitive : tree.order)
        triangles_.push_back(triangles[primitive]);
}

void BvhScene::appendWorld(const Bvh& flat, std::span<const BvhTriangle> triangles,
                           const Bvh& placed) {
    if (!flat.nodes.empty() || !placed.nodes.empty())
        roots_.push_back(0);
    // Where there are both kinds, a root above the two trees.
    if (!flat.nodes.empty() && !placed.nodes.empty()) {
        const auto right = static_cast<uint>(1 + flat.nodes.size());
        nodes_.push_back({{}, right, {}, 0});
        bounds_.push_back(join(flat.nodes.front().bounds, placed.nodes.front().bounds));
    }
    append(flat, triangles);
    world_triangles_ = static_cast<uint>(triangles_.size());
    const auto first_node = static_cast<uint>(nodes_.size());
    for (const Bvh::Node& node : placed.nodes) {
        HONE_ASSERT(node.count <= 1, "a builder must heed leaf_size");
        bounds_.push_back(node.bounds);
        nodes_.push_back(node.count == 0 ? BvhNode{{}, first_node + node.link, {}, node.axis}
                                         : BvhNode{{}, placed.order[node.link], {}, kBvhInstanced});
    }
    world_nodes_ = static_cast<uint>(nodes_.size());
}

void BvhScene::link() {
    if (nodes_.size() > kMaxNodes)
        throw DeviceError("a BVH of " + std::to_string(nodes_.size()) +
                          " nodes is too large; at most " + std::to_string(kMaxNodes) +
                          " can be linked");
    for (uint index = 0; index < nodes_.size(); ++index)
        writeBox(index);
    skips_.resize(8 * nodes_.size());
    for (uint octant = 0; octant < 8; ++octant) {
        const std::span<uint> skips(skips_.data() + octant * nodes_.size(), nodes_.size());
        for (const uint root : roots_)
            skips[root] = root < world_nodes_ ? kNone : kBvhLeave;
        // Children come after their parents.
        for (uint index = 0; index < nodes_.size(); ++index) {
            const BvhNode& node = nodes_[index];
            if (node.info >= kBvhLeaf)
                continue;
            const bool is_left_nearer = (octant >> node.info & 1u) == 0;
            const uint nearer = is_left_nearer ? index + 1 : node.link;
            const uint farther = is_left_nearer ? node.link : index + 1;
            skips[nearer] = farther;
            skips[farther] = skips[index];
        }
    }
}

void BvhScene::writeBox(uint index) {
    const Bounds& bounds = bounds_[index];
    BvhNode& node = nodes_[index];
    node.center = 0.5f * bounds.low + 0.5f * bounds.high;
    // What rounding took is given back.
    constexpr float kUp = 1.000001f;
    node.half_size = kUp * glm::max(bounds.high - node.center, node.center - bounds.low);
}

bool BvhScene::update(std::span<const uint> moved) {
    std::vector<std::uint8_t> is_moved(scene_->instances.size(), 0);
    for (const uint instance : moved)
        is_moved[instance] = 1;
    for (const BvhInstance& placed : instances_)
        if (is_moved[placed.instance] != 0 && !isInvertible(scene_->instances[placed.instance]))
            return false;
    for (uint i = 0; i < world_triangles_; ++i) {
        BvhTriangle& triangle = triangles_[i];
        if (is_moved[triangle.instance] == 0)
            continue;
        const Instance& instance = scene_->instances[triangle.instance];
        placeTriangle(&instance, scene_->meshes[instance.mesh], triangle);
    }

    // Boxes from the leaves up: children come after their parents. A leaf whose triangles stayed
    // keeps its box, which may be cut.
    for (uint index = world_nodes_; index-- > 0;) {
        const BvhNode& node = nodes_[index];
        Bounds& bounds = bounds_[index];
        if (node.info < kBvhLeaf) {
            bounds = join(bounds_[index + 1], bounds_[node.link]);
        } else if (node.info == kBvhInstanced) {
            BvhInstance& placed = instances_[node.link];
            if (is_moved[placed.instance] != 0)
                bounds = placeInstance(placed, bounds_[placed.root]);
        } else {
            const std::span<const BvhTriangle> triangles(triangles_.data() + node.link,
                                                         node.info - kBvhLeaf);
            if (std::ranges::any_of(triangles, [&](const BvhTriangle& triangle) {
                    return is_moved[triangle.instance] != 0;
                })) {
                bounds = {};
                for (const BvhTriangle& triangle : triangles)
                    bounds = join(bounds, hone::boundsOf(triangle));
            }
        }
        writeBox(index);
    }
    return true;
}

float BvhScene::extent() const {
    return world_nodes_ > 0 ? greatestCoordinate(bounds_.front()) : 0.0f;
}

} // namespace hone

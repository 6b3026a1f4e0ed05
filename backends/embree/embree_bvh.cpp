// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/embree/embree_bvh.h"

#include "hone/backends/embree/embree_tree.h"
#include "hone/core/error.h"

#include <algorithm>
#include <new>

namespace hone {
namespace {

/// A node as Embree makes it, in its allocator's memory.
struct BuiltNode {
    Bounds bounds;          ///< known once flatten() comes by: parents say their children's
    BuiltNode* children[2]; ///< both null in a leaf
    Bounds child_bounds[2];
    uint* primitives; ///< of a leaf
    uint count;
};

struct BvhOwner {
    explicit BvhOwner(RTCDevice device) : handle(rtcNewBVH(device)) {}
    ~BvhOwner() { rtcReleaseBVH(handle); }
    BvhOwner(const BvhOwner&) = delete;
    RTCBVH handle;
};

Bounds toBounds(const RTCBounds& bounds) {
    return {{bounds.lower_x, bounds.lower_y, bounds.lower_z},
            {bounds.upper_x, bounds.upper_y, bounds.upper_z}};
}

void store(const Bounds& bounds, RTCBounds& target) {
    target.lower_x = bounds.low.x;
    target.lower_y = bounds.low.y;
    target.lower_z = bounds.low.z;
    target.upper_x = bounds.high.x;
    target.upper_y = bounds.high.y;
    target.upper_z = bounds.high.z;
}

void grow(Bounds& bounds, vec3 low, vec3 high) {
    bounds.low = glm::min(bounds.low, low);
    bounds.high = glm::max(bounds.high, high);
}

/// The two parts of `box` that a plane leaves of the triangle in it. Rounded outwards: each point
/// of the triangle inside the box is in one of them. Builders ask this for every plane that they
/// consider: it is half of what a tree costs.
std::pair<Bounds, Bounds> cut(const std::array<vec3, 3>& triangle, const Bounds& box, int axis,
                              float position) {
    Bounds lower, upper;
    vec3 from = triangle[2];
    for (const vec3& to : triangle) {
        const float begin = from[axis];
        const float end = to[axis];
        if (end <= position)
            grow(lower, to, to);
        if (end >= position)
            grow(upper, to, to);
        if ((begin < position && position < end) || (end < position && position < begin)) {
            // Four units in the last place are more than these operations err.
            const vec3 point = from + (position - begin) / (end - begin) * (to - from);
            const vec3 error = (glm::abs(from) + glm::abs(to)) * (1.0f / 4194304.0f) + vec3(1e-37f);
            grow(lower, point - error, point + error);
            grow(upper, point - error, point + error);
        }
        from = to;
    }
    for (Bounds* part : {&lower, &upper}) {
        part->low = glm::max(part->low, box.low);
        part->high = glm::min(part->high, box.high);
    }
    lower.high[axis] = std::min(lower.high[axis], position);
    upper.low[axis] = std::max(upper.low[axis], position);
    return {lower, upper};
}

/// rtcBuildBVH's callbacks.
struct Callbacks {
    static void* createNode(RTCThreadLocalAllocator memory, uint, void*) {
        return new (rtcThreadLocalAlloc(memory, sizeof(BuiltNode), alignof(BuiltNode))) BuiltNode{};
    }
    static void setChildren(void* node, void** children, uint count, void*) {
        for (uint i = 0; i < count; ++i)
            static_cast<BuiltNode*>(node)->children[i] = static_cast<BuiltNode*>(children[i]);
    }
    static void setBounds(void* node, const RTCBounds** bounds, uint count, void*) {
        for (uint i = 0; i < count; ++i)
            static_cast<BuiltNode*>(node)->child_bounds[i] = toBounds(*bounds[i]);
    }
    static void* createLeaf(RTCThreadLocalAllocator memory, const RTCBuildPrimitive* primitives,
                            std::size_t count, void*) {
        auto* leaf = static_cast<BuiltNode*>(createNode(memory, 0, nullptr));
        leaf->count = static_cast<uint>(count);
        leaf->primitives =
            static_cast<uint*>(rtcThreadLocalAlloc(memory, count * sizeof(uint), alignof(uint)));
        for (std::size_t i = 0; i < count; ++i)
            leaf->primitives[i] = primitives[i].primID;
        return leaf;
    }
    static void split(const RTCBuildPrimitive* primitive, uint axis, float position,
                      RTCBounds* lower, RTCBounds* upper, void* user) {
        const auto& input = *static_cast<const BvhInput*>(user);
        const Bounds box{{primitive->lower_x, primitive->lower_y, primitive->lower_z},
                         {primitive->upper_x, primitive->upper_y, primitive->upper_z}};
        const auto [below, above] =
            cut(input.triangles[primitive->primID], box, static_cast<int>(axis), position);
        store(below, *lower);
        store(above, *upper);
    }
};

/// Lays the tree out depth first, the child whose box is lower on the left, each leaf's primitives
/// in their order.
Bvh flatten(BuiltNode* root) {
    struct Visit {
        BuiltNode* built;
        uint parent; ///< whose right child it is, or kNone
    };
    Bvh bvh;
    std::vector<Visit> stack{{root, kNone}};
    while (!stack.empty()) {
        const Visit visit = stack.back();
        stack.pop_back();
        const auto index = static_cast<uint>(bvh.nodes.size());
        if (visit.parent != kNone)
            bvh.nodes[visit.parent].link = index;
        Bvh::Node& node = bvh.nodes.emplace_back();
        BuiltNode& built = *visit.built;
        node.bounds = built.bounds;
        if (built.children[0] == nullptr) {
            node.link = static_cast<uint>(bvh.order.size());
            const std::span<uint> primitives(built.primitives, built.count);
            std::ranges::sort(primitives);
            // Both parts of a cut box may meet again in one leaf.
            const auto repeated = std::ranges::unique(primitives);
            bvh.order.insert(bvh.order.end(), primitives.begin(), repeated.begin());
            node.count = static_cast<uint>(bvh.order.size()) - node.link;
            continue;
        }
        for (int i = 0; i < 2; ++i)
            built.children[i]->bounds = built.child_bounds[i];
        const vec3 apart = built.child_bounds[1].center() - built.child_bounds[0].center();
        const vec3 size = glm::abs(apart);
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        node.axis = static_cast<uint>(axis);
        const bool is_first_lower = apart[axis] >= 0.0f;
        stack.push_back({built.children[is_first_lower ? 1 : 0], index});
        stack.push_back({built.children[is_first_lower ? 0 : 1], kNone});
    }
    return bvh;
}

} // namespace

Bvh buildEmbreeBvh(const BvhInput& input) {
    if (input.boxes.empty())
        return {};
    EmbreeDevice device;
    const BvhOwner owner(device.handle());
    const bool can_cut = !input.triangles.empty();

    // Cutting needs room: at most half as many parts again.
    std::vector<RTCBuildPrimitive> primitives(input.boxes.size());
    Bounds whole;
    for (std::size_t i = 0; i < primitives.size(); ++i) {
        const Bounds& box = input.boxes[i];
        whole.add(box.low);
        whole.add(box.high);
        primitives[i] = {box.low.x,  box.low.y,  box.low.z,  0,
                         box.high.x, box.high.y, box.high.z, static_cast<uint>(i)};
    }
    const std::size_t count = primitives.size();
    if (can_cut)
        primitives.resize(count + count / 2);

    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.byteSize = sizeof(arguments);
    arguments.buildQuality = can_cut ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM;
    arguments.maxBranchingFactor = 2;
    arguments.maxDepth = kBvhDepth / 2;
    arguments.minLeafSize = 1;
    arguments.maxLeafSize = std::min<uint>(input.leaf_size, RTC_BUILD_MAX_PRIMITIVES_PER_LEAF);
    arguments.bvh = owner.handle;
    arguments.primitives = primitives.data();
    arguments.primitiveCount = count;
    arguments.primitiveArrayCapacity = primitives.size();
    arguments.createNode = Callbacks::createNode;
    arguments.setNodeChildren = Callbacks::setChildren;
    arguments.setNodeBounds = Callbacks::setBounds;
    arguments.createLeaf = Callbacks::createLeaf;
    arguments.splitPrimitive = can_cut ? Callbacks::split : nullptr;
    arguments.userPtr = const_cast<BvhInput*>(&input);
    auto* root = static_cast<BuiltNode*>(rtcBuildBVH(&arguments));
    device.check("rtcBuildBVH");
    HONE_ASSERT(root != nullptr, "rtcBuildBVH made no tree");
    root->bounds = whole; // nobody told it
    return flatten(root);
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/scene/scene.h"

#include <array>
#include <functional>
#include <span>
#include <vector>

namespace hone {

/// What a builder makes a tree over: boxes, and the triangles in them where they may be split.
struct BvhInput {
    std::span<const Bounds> boxes; ///< none empty, all finite
    /// As many as boxes, or none: then no box may be cut.
    std::span<const std::array<vec3, 3>> triangles;
    uint leaf_size = 1; ///< primitives of a leaf at most; > 0
};

/// A bounding volume hierarchy over numbered primitives. Nodes lie depth first: an inner node's
/// left child comes next. Without primitives there are no nodes.
struct Bvh {
    struct Node {
        Bounds bounds;
        uint link = 0;  ///< inner: the right child; leaf: its first primitive, in `order`
        uint count = 0; ///< of primitives; 0 = inner
        uint axis = 0;  ///< inner: 0, 1 or 2, along which the left child is the lower
    };
    std::vector<Node> nodes;
    std::vector<uint> order; ///< of primitives; one whose box was cut is named more than once
};

/// Makes a tree. The same input gives the same tree at any number of threads, at most kBvhDepth
/// deep; each primitive is in a leaf, and each point of it that lies in its box is in a leaf's box.
/// Throws OutOfMemory, DeviceError.
using BvhBuilder = std::function<Bvh(const BvhInput&)>;

inline constexpr uint kBvhDepth = 96;

/// The expected cost of a ray that meets the tree's box, in box tests and triangle tests of equal
/// price (MacDonald and Booth 1990, the surface area heuristic).
[[nodiscard]] float sahCost(const Bvh& bvh);

/// Half the surface of a box; 0 for an empty one.
[[nodiscard]] float halfArea(const Bounds& bounds);

} // namespace hone

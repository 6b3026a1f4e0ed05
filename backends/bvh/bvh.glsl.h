// SPDX-License-Identifier: Apache-2.0
//
// A bounding volume hierarchy as its traversal reads it: scalar layout, the same bytes in C++ and
// GLSL. All trees of a scene lie in one array of nodes: the world's tree first, then a tree for
// each instanced mesh in the mesh's own space.
#ifndef HONE_BVH_GLSL_H
#define HONE_BVH_GLSL_H

#ifdef __cplusplus
#include "hone/core/math.h"
namespace hone {
#define HONE_RECORD_CONST inline constexpr
#else
#define HONE_RECORD_CONST const
#endif

/// Nodes lie depth first: an inner node's left child comes next. Where the traversal goes on after
/// a node's subtree stands apart (skip links), one list for each octant of directions.
struct BvhNode {
    vec3 center;    ///< of its box
    uint link;      ///< inner: the right child; leaf: its first triangle, or a BvhInstance
    vec3 half_size; ///< of its box
    uint info; ///< inner: the axis (0, 1, 2) that orders its children, the left one being lower
};

HONE_RECORD_CONST uint kBvhLeaf = 0x80000000u;      ///< in info, plus the number of triangles
HONE_RECORD_CONST uint kBvhInstanced = 0xffffffffu; ///< info of a leaf that holds an instance

// In place of a node: what comes after the last one of an instanced mesh's tree. The world's ends
// with kNone.
HONE_RECORD_CONST uint kBvhLeave = 0xfffffffeu;

HONE_RECORD_CONST uint kBvhTwoSided = 1u;
HONE_RECORD_CONST uint kBvhFlipped = 2u; ///< its front turns clockwise
HONE_RECORD_CONST uint kBvhMasked = 4u;

/// A triangle in its tree's space. One without area has three equal corners.
struct BvhTriangle {
    vec3 a;
    uint instance; ///< kNone in the tree of an instanced mesh
    vec3 b;
    uint primitive;
    vec3 c;
    uint flags;
};

/// An instanced mesh placed in the world.
struct BvhInstance {
    mat4x3 to_object; ///< world to the mesh's space
    uint instance;
    uint root;    ///< of the mesh's tree
    float extent; ///< the greatest coordinate in the mesh's tree, without sign
};

/// Where the traversal of a ray stands between two dispatches; its best hit is among the answers.
struct BvhState {
    uint node;     ///< the next to visit; kNone: all is done
    uint instance; ///< the leaf of the world's tree that holds the node's tree; kNone: the world's
    float t;       ///< of the best hit
};

#ifdef __cplusplus
static_assert(sizeof(BvhNode) == 32 && sizeof(BvhTriangle) == 48 && sizeof(BvhInstance) == 60 &&
              sizeof(BvhState) == 12);
} // namespace hone
#endif
#undef HONE_RECORD_CONST
#endif

// SPDX-License-Identifier: Apache-2.0
//
// What shaders that trace rays are told: scalar layout, the same bytes in C++ and GLSL.
#ifndef HONE_VULKAN_TREE_GLSL_H
#define HONE_VULKAN_TREE_GLSL_H

#ifdef __cplusplus
#include "hone/core/math.h"
namespace hone {
#endif

/// An instance of the top-level structure: how its triangles are called. tree_triangles holds a
/// Hit for each triangle of the bottom-level structures, geometry by geometry.
struct TreePlace {
    uint instance;     ///< that all its triangles belong to; kNone: each names its own
    uint first;        ///< in tree_triangles, of geometry 0
    uint first_second; ///< of geometry 1, if there is one
};

struct TraceParams {
    uvec2 tree;        ///< address of the top-level structure, low word first
    uint first_ray;    ///< in the bound rays
    uint first_answer; ///< in words of the bound answers
    uint is_occluded;  ///< 1: answers are 1 or 0, any hit ends a ray; 0: answers are closest hits
};

#ifdef __cplusplus
static_assert(sizeof(TreePlace) == 12 && sizeof(TraceParams) == 20);
} // namespace hone
#endif
#endif

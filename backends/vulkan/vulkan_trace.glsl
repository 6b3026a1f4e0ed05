// SPDX-License-Identifier: Apache-2.0
//
// What the shaders that trace rays share: what they read and write, which rays can hit anything,
// what a triangle of the tree is called.
#include "hone/core/device/kernel.glsl.h"
#include "hone/core/scene/scene.glsl.h"
#include "hone/core/trace/ray.glsl.h"
#include "hone/core/scene/texture.glsl.h"
#include "hone/core/scene/surface.glsl.h"
#include "hone/backends/vulkan/vulkan_tree.glsl.h"

HONE_PARAMS(TraceParams)
HONE_READ(Ray, rays)
HONE_WRITE(uint, answers)
HONE_READ(TreePlace, tree_places)
HONE_READ(Hit, tree_triangles)

const Hit kMiss = Hit(kNone, kNone);

/// A float's size as an integer, in the same order: NaN is larger than every number, whatever a
/// compiler assumes of it.
uint magnitude(float value) {
    return floatBitsToUint(value) & 0x7fffffffu;
}

bool isBelowLimit(vec3 v) {
    uint limit = floatBitsToUint(1e18f);
    return magnitude(v.x) < limit && magnitude(v.y) < limit && magnitude(v.z) < limit;
}

/// isTraceable() of traceable.h: a driver may do anything with the others.
bool isTraceable(Ray ray) {
    uint infinite = 0x7f800000u;
    bool moves = (magnitude(ray.direction.x) | magnitude(ray.direction.y) |
                  magnitude(ray.direction.z)) != 0u;
    return isBelowLimit(ray.origin) && isBelowLimit(ray.direction) && moves &&
           magnitude(ray.tmin) <= infinite && magnitude(ray.tmax) <= infinite &&
           ray.tmin <= ray.tmax && ray.tmax >= 0.0f;
}

/// Closest hits do not see back faces of single-sided triangles, which their instance lets cull.
uint rayFlags() {
    return params.is_occluded != 0u ? gl_RayFlagsTerminateOnFirstHitEXT
                                    : gl_RayFlagsCullBackFacingTrianglesEXT;
}

float rayBegin(Ray ray) {
    return clamp(ray.tmin, 0.0f, 3e38f);
}

float rayEnd(Ray ray) {
    return min(ray.tmax, 3e38f);
}

Hit hitOf(uint place_index, uint geometry, uint primitive) {
    TreePlace place = tree_places[place_index];
    Hit hit = tree_triangles[(geometry == 0u ? place.first : place.first_second) + primitive];
    if (place.instance != kNone)
        hit.instance = place.instance;
    return hit;
}

void writeAnswer(uint index, Hit hit) {
    if (params.is_occluded != 0u) {
        answers[params.first_answer + index] = hit.instance != kNone ? 1u : 0u;
    } else {
        answers[params.first_answer + 2u * index] = hit.instance;
        answers[params.first_answer + 2u * index + 1u] = hit.primitive;
    }
}

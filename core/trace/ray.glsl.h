// SPDX-License-Identifier: Apache-2.0
//
// Rays and hits as kernels write them and tracers read them: scalar layout, the same bytes in C++
// and GLSL.
#ifndef HONE_RAY_GLSL_H
#define HONE_RAY_GLSL_H

#ifdef __cplusplus
#include "hone/core/math.h"
namespace hone {
#endif

/// Seen are hits with tmin <= t <= tmax at origin + t * direction, never behind the origin (a
/// negative tmin counts as 0). A hit within rounding of tmin or tmax may be seen or not. The
/// direction need not be unit. A ray hits nothing if a number of its origin or direction is not
/// finite or reaches 1e18, if its direction is zero, tmin > tmax, or either is NaN.
struct Ray {
    vec3 origin;
    float tmin;
    vec3 direction;
    float tmax;
};

/// What a ray or a pixel sees: a triangle, counted inside its instance's mesh. Both are kNone for
/// nothing. Where on the triangle is never stored: everyone recomputes it from the ray
/// (surface.glsl.h).
struct Hit {
    uint instance;
    uint primitive;
};

#ifdef __cplusplus
static_assert(sizeof(Ray) == 32 && sizeof(Hit) == 8);
} // namespace hone
#endif
#endif

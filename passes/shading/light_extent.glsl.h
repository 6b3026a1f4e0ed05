// SPDX-License-Identifier: Apache-2.0
//
// The extent of a light: where its points are. Trace samples them, shadow maps are drawn from some,
// and metrics ask which part of them is hidden; what light they send is directLight()'s matter.
// Kernel source: included flat by shading.glsl.h; needs no buffers.

#include "hone/core/trace/disc.glsl.h"

HONE_CONST float kPi = 3.14159265f;

/// Whether a light is more than a point (directional: more than a direction), so that its shadows
/// are soft.
bool hasExtent(Light light) {
    if (light.kind == kLightRectangle || light.kind == kLightDisc)
        return true;
    bool has_radius = light.kind == kLightSphere || light.kind == kLightDirectional;
    return has_radius && light.radius > 0.0f;
}

/// Two axes along which a light extends: its points are
///     center + x * half_u + y * half_v
/// with (x, y) in [-1,1]^2, where it is round in the unit disc.
struct LightExtent {
    vec3 half_u;
    vec3 half_v;
    bool is_round;
};

/// A unit vector across `direction`.
vec3 across(vec3 direction) {
    vec3 axis = abs(direction.y) < 0.99f ? vec3(0.0f, 1.0f, 0.0f) : vec3(1.0f, 0.0f, 0.0f);
    return normalize(cross(direction, axis));
}

/// The extent that `position` sees. A sphere is the disc through its centre that faces the
/// position (its silhouette is wider by (radius / distance)^2 / 2 of itself). Of a directional
/// light, whose points are directions, the extent is around -light.direction. Both axes are zero
/// for lights without extent.
LightExtent lightExtent(Light light, vec3 position) {
    LightExtent result;
    result.half_u = light.half_u;
    result.half_v = light.half_v;
    result.is_round = light.kind != kLightRectangle;
    if (light.kind == kLightRectangle || light.kind == kLightDisc)
        return result;
    result.half_u = vec3(0.0f);
    result.half_v = vec3(0.0f);
    if (!hasExtent(light))
        return result;
    vec3 toward = light.direction;
    if (light.kind == kLightSphere) {
        vec3 to_light = light.position - position;
        float away = length(to_light);
        toward = away > 0.0f ? to_light / away : vec3(0.0f, 1.0f, 0.0f);
    }
    vec3 right = across(toward);
    result.half_u = light.radius * right;
    result.half_v = light.radius * cross(right, toward);
    return result;
}

/// The point of a light at `square` in [-1,1]^2: equal areas of the square are equal areas of the
/// light. Directional: the direction towards it, not unit.
vec3 pointOfLight(Light light, vec3 position, vec2 square) {
    LightExtent extent = lightExtent(light, position);
    vec2 at = extent.is_round ? discFromSquare(square) : square;
    vec3 center = light.kind == kLightDirectional ? -light.direction : light.position;
    return center + at.x * extent.half_u + at.y * extent.half_v;
}

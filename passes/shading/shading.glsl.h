// SPDX-License-Identifier: Apache-2.0
//
// From a surface to radiance: what raster, environment_probe and trace share, so that pixels which
// no effect touches are the same bits in all of them. Radiance of a surface is, in this order of
// sums,
//
//     albedo * ambient + emission + sum over lights of (directLight * visibility) + mirror weight *
//     reflected
//
// and the three differ only in where visibility and reflected come from.
// Kernel source: included flat, once, inside a kernel, after surface.glsl.h.

HONE_READ(Light, scene_lights)
HONE_READ(Environment, scene_environment)

#include "hone/passes/shading/light_extent.glsl.h"

/// What a ray sees that hits nothing. `direction` need not be unit.
vec3 environmentRadiance(vec3 direction) {
    Environment environment = scene_environment[0];
    float height = direction.y / length(direction);
    vec3 end = height >= 0.0f ? environment.zenith : environment.ground;
    return mix(environment.horizon, end, sqrt(abs(height)));
}

/// The part of a surface's light that no visibility touches.
vec3 unshadowedRadiance(Surface surface, vec3 albedo) {
    return albedo * scene_environment[0].ambient + scene_materials[surface.material].emission;
}

/// Where the ray to a light goes: a unit direction and the distance (1e30 for directional lights).
struct LightSample {
    vec3 direction;
    float distance;
};

LightSample lightFrom(Light light, vec3 position, vec3 point) {
    LightSample result;
    if (light.kind == kLightDirectional) {
        result.direction = -light.direction;
        result.distance = 1e30f;
        return result;
    }
    vec3 to_light = point - position;
    result.distance = length(to_light);
    result.direction = result.distance > 0.0f ? to_light / result.distance : -light.direction;
    return result;
}

/// Light that arrives from the light's centre and leaves diffusely, if nothing is between
/// (center_shading, Guennebaud et al. 2006: an area light is a point at its centre times the
/// visible fraction).
vec3 directLight(Light light, Surface surface, vec3 albedo) {
    LightSample to_light = lightFrom(light, surface.position, light.position);
    float cosine = dot(surface.normal, to_light.direction);
    // A light below the true surface cannot light it, whatever the interpolated normal says.
    if (cosine <= 0.0f || dot(surface.geometric_normal, to_light.direction) <= 0.0f)
        return vec3(0.0f);
    vec3 irradiance = light.intensity * cosine;
    if (light.kind != kLightDirectional) {
        if (light.range > 0.0f && to_light.distance > light.range)
            return vec3(0.0f);
        irradiance /= to_light.distance * to_light.distance;
    }
    float emitted = -dot(light.direction, to_light.direction);
    if (light.kind == kLightRectangle) {
        float area = 4.0f * length(cross(light.half_u, light.half_v));
        irradiance *= area * max(emitted, 0.0f);
    }
    if (light.kind == kLightDisc) {
        float area = kPi * length(cross(light.half_u, light.half_v));
        irradiance *= area * max(emitted, 0.0f);
    }
    if (light.kind == kLightSphere)
        irradiance *= kPi * light.radius * light.radius;
    if (light.kind == kLightSpot) {
        float spot =
            clamp((emitted - light.cos_outer) / max(light.cos_inner - light.cos_outer, 1e-4f), 0.0f,
                  1.0f);
        irradiance *= spot * spot;
    }
    return albedo * irradiance * (1.0f / kPi);
}

/// Weight of the mirror reflection: Schlick's approximation (1994). Zero where the material is no
/// mirror.
vec3 mirrorWeight(Material material, vec3 normal, vec3 unit_direction) {
    if ((material.flags & kMaterialMirror) == 0u)
        return vec3(0.0f);
    float grazing = 1.0f - clamp(-dot(normal, unit_direction), 0.0f, 1.0f);
    float squared = grazing * grazing;
    return material.f0 + (vec3(1.0f) - material.f0) * (squared * squared * grazing);
}

/// What is left for diffuse light once the mirror has its share at normal incidence.
vec3 diffuseAlbedo(Material material, vec3 base_color) {
    return (material.flags & kMaterialMirror) == 0u ? base_color
                                                    : base_color * (vec3(1.0f) - material.f0);
}

/// The mirrored direction, kept on the geometric side that the ray came from.
vec3 reflectedDirection(Surface surface, vec3 unit_direction) {
    vec3 direction = reflect(unit_direction, surface.normal);
    float below = dot(direction, surface.geometric_normal);
    if (below <= 0.0f)
        direction += (0.001f - below) * surface.geometric_normal;
    return normalize(direction);
}

/// A start that the surface itself does not block: moved off along the geometric normal by a part
/// of its distance from the world's origin and from where it was seen, as float positions are that
/// coarse.
vec3 offsetOrigin(Surface surface, vec3 seen_from) {
    vec3 p = abs(surface.position);
    float size = max(max(p.x, max(p.y, p.z)), distance(surface.position, seen_from));
    return surface.position + (1e-5f * size + 1e-5f) * surface.geometric_normal;
}

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/texture.glsl.h"

#include "hone/core/scene/surface.glsl.h"

#include "hone/core/scene/camera.glsl.h"
#include "hone/core/trace/random.glsl.h"

#include "hone/passes/shading/shading.glsl.h"

#include "hone/passes/trace/path.glsl.h"

struct Params {
    uint path_count; ///< of this wave: shadow rays of one light are together
    uint light_count;
    uint bounce;
    uint reflects; ///< 0: mirrors end here
    float tan_half_fov_y;
    uint height; ///< of the image in pixels
    uint seed_low;
    uint seed_high;
};
HONE_PARAMS(Params)
HONE_READ(Path, paths)
HONE_READ(Ray, rays)
HONE_READ(Hit, hits)
HONE_WRITE(Sample, samples)
HONE_WRITE(Ray, shadow_rays)
HONE_WRITE(vec3, light_radiance) // by light and path: what arrives if nothing is between
HONE_WRITE(Ray, next_rays)
HONE_WRITE(Path, next_paths)
HONE_WRITE(uint, next_flags) // number of shadow rays; kGoesOn

HONE_CONST uint kGoesOn = 0x80000000u;

/// Where the shadow ray of this sample ends: the light's centre, or a random point of its extent.
/// Directional: the direction towards it.
vec3 lightPoint(Light light, uint light_index, vec3 position, Path path) {
    if (!hasExtent(light))
        return light.kind == kLightDirectional ? -light.direction : light.position;
    uvec4 random =
        pcg4d(uvec4(path.pixel, path.sample_number,
                    (params.bounce << 16u | light_index) ^ params.seed_high, params.seed_low));
    return pointOfLight(light, position,
                        vec2(2.0f * unitFloat(random.x) - 1.0f, 2.0f * unitFloat(random.y) - 1.0f));
}

/// From the surface to just before the light, so that a lamp's own geometry does not block it.
Ray shadowRay(Light light, vec3 origin, vec3 point) {
    Ray ray;
    ray.origin = origin;
    ray.tmin = 0.0f;
    ray.direction = point - origin;
    ray.tmax = 0.9999f;
    if (light.kind == kLightDirectional) {
        ray.direction = point;
        ray.tmax = 1e30f;
    }
    return ray;
}

/// Hits nothing, by its range.
Ray noRay() {
    Ray ray;
    ray.origin = vec3(0.0f);
    ray.tmin = 1.0f;
    ray.direction = vec3(0.0f, 0.0f, 1.0f);
    ray.tmax = 0.0f;
    return ray;
}

/// Adds what needs no visibility and asks for the rest. The order of sums is that of
/// shading.glsl.h; lights follow in trace_resolve, the mirror in the next bounce.
void kernel(uint index) {
    Path path = paths[index];
    Ray ray = rays[path.ray];
    Hit hit = hits[path.ray];
    Sample result;
    result.pixel = path.pixel;
    result.radiance = params.bounce == 0u ? vec3(0.0f) : samples[path.slot].radiance;
    next_flags[index] = 0u;
    if (hit.instance == kNone) {
        result.radiance += path.throughput * environmentRadiance(ray.direction);
        samples[path.slot] = result;
        for (uint i = 0u; i < params.light_count; ++i) {
            shadow_rays[i * params.path_count + index] = noRay();
            light_radiance[i * params.path_count + index] = vec3(0.0f);
        }
        return;
    }

    Surface surface = surfaceAt(ray, hit);
    Material material = scene_materials[surface.material];
    float traveled = path.traveled + surface.t;
    float footprint = traveled * 2.0f * params.tan_half_fov_y / float(params.height);
    vec3 albedo = diffuseAlbedo(material, vec3(baseColor(surface, ray.direction, footprint)));
    result.radiance += path.throughput * unshadowedRadiance(surface, albedo);
    samples[path.slot] = result;

    vec3 origin = offsetOrigin(surface, ray.origin);
    uint flags = 0u;
    for (uint i = 0u; i < params.light_count; ++i) {
        Light light = scene_lights[i];
        vec3 radiance = path.throughput * directLight(light, surface, albedo);
        bool asks = radiance.x + radiance.y + radiance.z > 0.0f && light.shadowless == 0u;
        uint slot = i * params.path_count + index;
        light_radiance[slot] = radiance;
        shadow_rays[slot] =
            asks ? shadowRay(light, origin, lightPoint(light, i, surface.position, path)) : noRay();
        flags += asks ? 1u : 0u;
    }

    vec3 unit_direction = normalize(ray.direction);
    vec3 weight = mirrorWeight(material, surface.normal, unit_direction);
    if (params.reflects != 0u && weight.x + weight.y + weight.z > 0.0f) {
        Ray next_ray;
        next_ray.origin = origin;
        next_ray.tmin = 0.0f;
        next_ray.direction = reflectedDirection(surface, unit_direction);
        next_ray.tmax = 1e30f;
        next_rays[index] = next_ray;
        path.throughput *= weight;
        path.traveled = traveled;
        next_paths[index] = path;
        flags |= kGoesOn;
    }
    next_flags[index] = flags;
}

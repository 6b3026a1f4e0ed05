// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/texture.glsl.h"

#include "hone/core/scene/surface.glsl.h"

#include "hone/passes/shading/shading.glsl.h"

#include "hone/passes/shading/cube.glsl.h"

#include "hone/passes/shading/shadow_map.glsl.h"

#include "hone/passes/shading/raster_radiance.glsl.h"

HONE_READ(Probe, scene_probes)

struct Params {
    uint probe;
    uint size;
    float near;
};
HONE_PARAMS(Params)
HONE_READ(Hit, hits)
HONE_WRITE(vec4, maps)

/// One texel of a probe's six faces: radiance and distance of what was drawn there.
void kernel(uint index) {
    uint texels = params.size * params.size;
    uint face = index / texels;
    uint texel = index % texels;
    Ray ray;
    ray.origin = scene_probes[params.probe].position;
    ray.direction = cubeDirection(
        face, vec2(float(texel % params.size) + 0.5f, float(texel / params.size) + 0.5f),
        params.size);
    ray.tmin = params.near;
    ray.tmax = 1e30f;
    uint target = 1u + params.probe * 6u * texels + index;
    Hit hit = hits[index];
    if (hit.instance == kNone) {
        maps[target] = vec4(environmentRadiance(ray.direction), 1e30f);
        return;
    }
    Surface surface = surfaceAt(ray, hit);
    Material material = scene_materials[surface.material];
    vec3 base = vec3(baseColor(surface, ray.direction, surface.t * 2.0f / float(params.size)));
    vec3 radiance = rasterRadiance(surface, diffuseAlbedo(material, base));
    vec3 unit_direction = normalize(ray.direction);
    vec3 weight = mirrorWeight(material, surface.normal, unit_direction);
    if (weight.x + weight.y + weight.z > 0.0f)
        radiance += weight * environmentRadiance(reflectedDirection(surface, unit_direction));
    maps[target] = vec4(radiance, surface.t * length(ray.direction));
}

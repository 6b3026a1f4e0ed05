// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/texture.glsl.h"

#include "hone/core/scene/surface.glsl.h"

#include "hone/core/scene/camera.glsl.h"

#include "hone/passes/shading/shading.glsl.h"

#include "hone/passes/shading/cube.glsl.h"

#include "hone/passes/shading/shadow_map.glsl.h"

#include "hone/passes/shading/environment_map.glsl.h"

#include "hone/passes/shading/raster_radiance.glsl.h"

struct Params {
    Camera camera;
    uvec2 extent;
};
HONE_PARAMS(Params)
HONE_READ(Hit, gbuffer)
HONE_WRITE(float, depth)
HONE_WRITE(vec3, color)

/// What the object's probe saw along the direction; the sky where it has none.
vec3 reflectedRadiance(uint probe, vec3 direction) {
    if (probe == kNone || float(probe) >= environment_maps[0].y)
        return environmentRadiance(direction);
    return vec3(environmentMap(probe, direction));
}

void kernel(uint index) {
    Ray ray = cameraRay(params.camera, params.extent, pixelCenter(index, params.extent));
    Hit hit = gbuffer[index];
    if (hit.instance == kNone) {
        depth[index] = 0.0f;
        color[index] = environmentRadiance(ray.direction);
        return;
    }
    Surface surface = surfaceAt(ray, hit);
    Material material = scene_materials[surface.material];
    float footprint = surface.t * 2.0f * params.camera.tan_half_fov_y / float(params.extent.y);
    vec3 base = vec3(baseColor(surface, ray.direction, footprint));
    vec3 radiance = rasterRadiance(surface, diffuseAlbedo(material, base));
    vec3 unit_direction = normalize(ray.direction);
    vec3 weight = mirrorWeight(material, surface.normal, unit_direction);
    if (weight.x + weight.y + weight.z > 0.0f)
        radiance += weight * reflectedRadiance(scene_instances[hit.instance].probe,
                                               reflectedDirection(surface, unit_direction));
    depth[index] = surface.t;
    color[index] = radiance;
}

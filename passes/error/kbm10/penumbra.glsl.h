// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/texture.glsl.h"

#include "hone/core/scene/surface.glsl.h"

#include "hone/core/scene/camera.glsl.h"

#include "hone/passes/shading/shading.glsl.h"

#include "hone/passes/shading/cube.glsl.h"

#include "hone/passes/shading/shadow_map.glsl.h"

struct Params {
    Camera camera;
    uvec2 extent;
    uint include_umbra;
};
HONE_PARAMS(Params)
HONE_READ(Hit, gbuffer)
HONE_WRITE(uint, penumbra)

/// Whether the shadow tests of a light disagree: those of all its points, each over 3 x 3 texels,
/// so that an edge of the map counts even where there is only one point.
bool isPenumbra(uint light_index, Surface surface) {
    bool any_seen = false;
    bool any_hidden = false;
    uint points = shadowPoints(scene_lights[light_index]);
    for (uint k = 0u; k < points; ++k) {
        ShadowLookup lookup = shadowReceiver(light_index, k, surface);
        int column = int(floor(lookup.position.x));
        int row = int(floor(lookup.position.y));
        for (int i = 0; i < 9; ++i) {
            bool is_seen = shadowTest(lookup, column + i % 3 - 1, row + i / 3 - 1) == 1u;
            any_seen = any_seen || is_seen;
            any_hidden = any_hidden || !is_seen;
            if (any_hidden && (any_seen || params.include_umbra == 1u))
                return true;
        }
    }
    return false;
}

/// 0: no light shines here, or nothing is; 1: lit or dark, for certain; 2: penumbra.
void kernel(uint index) {
    penumbra[index] = 0u;
    Hit hit = gbuffer[index];
    if (hit.instance == kNone)
        return;
    Ray ray = cameraRay(params.camera, params.extent, pixelCenter(index, params.extent));
    Surface surface = surfaceAt(ray, hit);
    // Textures are taken as white: what matters is whether light can make any difference.
    Material material = scene_materials[surface.material];
    vec3 albedo = diffuseAlbedo(material, material.base_color);
    uint found = 0u;
    uint light_count = uint(scene_lights.length());
    for (uint i = 0u; i < light_count && found < 2u; ++i) {
        if (scene_lights[i].shadowless == 1u)
            continue;
        vec3 direct = directLight(scene_lights[i], surface, albedo);
        if (direct.x + direct.y + direct.z > 0.0f)
            found = isPenumbra(i, surface) ? 2u : 1u;
    }
    penumbra[index] = found;
}

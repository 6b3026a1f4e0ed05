// SPDX-License-Identifier: Apache-2.0
//
// What the rasteriser makes of shading.glsl.h: hard shadows from shadow maps. Without maps
// (shadow_maps[0] = 0) everything is lit, and so it is by lights without shadows. Kernel source:
// included flat, once, inside a kernel, after shadow_map.glsl.h.

/// Radiance of a surface without its mirror's reflection.
vec3 rasterRadiance(Surface surface, vec3 albedo) {
    vec3 radiance = unshadowedRadiance(surface, albedo);
    bool has_maps = shadow_maps[0] > 0.0f;
    uint light_count = uint(scene_lights.length());
    for (uint i = 0u; i < light_count; ++i) {
        vec3 direct = directLight(scene_lights[i], surface, albedo);
        if (direct.x + direct.y + direct.z == 0.0f)
            continue;
        bool is_tested = has_maps && scene_lights[i].shadowless == 0u;
        radiance += direct * (is_tested ? shadowMapVisibility(i, 0u, surface) : 1.0f);
    }
    return radiance;
}

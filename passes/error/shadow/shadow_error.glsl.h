// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/texture.glsl.h"

#include "hone/core/scene/surface.glsl.h"

#include "hone/core/scene/camera.glsl.h"

#include "hone/passes/shading/shading.glsl.h"

#include "hone/passes/shading/cube.glsl.h"

#include "hone/passes/shading/shadow_map.glsl.h"

#include "hone/passes/shading/shadow_range.glsl.h"

#include "hone/passes/error/shadow/light_cone.glsl.h"

#include "hone/passes/error/shadow/light_mask.glsl.h"

struct Params {
    Camera camera;
    uvec2 extent;
    float near;
    uint iterations;
    uint certified;
    uint retest;
    uint detail; ///< 0: no mask
};
HONE_PARAMS(Params)
HONE_READ(Hit, gbuffer)
HONE_WRITE(vec2, error)

#include "hone/passes/error/shadow/map_search.glsl.h"

#include "hone/passes/error/shadow/hide_cells.glsl.h"

/// Of a light without extent: shadow tests of the four nearest texels, by how near they are.
float filteredShadow(ShadowLookup lookup) {
    float x = lookup.position.x - 0.5f;
    float y = lookup.position.y - 0.5f;
    float column = floor(x);
    float row = floor(y);
    float lit = 0.0f;
    for (int i = 0; i < 4; ++i) {
        float right = (i & 1) == 0 ? 1.0f - (x - column) : x - column;
        float below = i < 2 ? 1.0f - (y - row) : y - row;
        lit +=
            right * below * float(shadowTest(lookup, int(column) + (i & 1), int(row) + (i >> 1)));
    }
    return lit;
}

/// What a light that is less than wholly seen, or wholly hidden, may add or lack.
struct ShadowEstimate {
    float drawn;   ///< what the raster image shows: 1 lit, 0 in shadow
    float visible; ///< the share of the light that is seen, a guess where not certain
    bool is_certain;
};

/// Whether a position in texels is inside a face, and farther than the cone's margin from its end.
bool isFarFromBorder(vec2 position) {
    float most = shadow_maps[0] - 2.0f;
    return position.x > 2.0f && position.y > 2.0f && position.x < most && position.y < most;
}

ShadowEstimate estimateShadow(uint light_index, Surface surface) {
    Light light = scene_lights[light_index];
    vec3 position = surface.position;
    vec3 normal = surface.geometric_normal;
    vec3 direction = position - light.position;
    LightExtent extent = lightExtent(light, position);
    uint own_face = shadowFace(light, 0u, position);
    uint first_face = rangeFirstFace(light_index);
    uint faces = rangeFaces(light);
    ShadowLookup own = shadowLookup(light_index, 0u, own_face, position, normal);
    ShadowEstimate result;
    result.drawn = shadowMapVisibility(light_index, 0u, surface);
    result.visible = 1.0f;
    result.is_certain = false;

    // Where part of the light is below the horizon, the surface itself hides it.
    float height =
        light.kind == kLightDirectional ? -dot(normal, light.direction) : -dot(normal, direction);
    float dip = abs(dot(normal, extent.half_u)) + abs(dot(normal, extent.half_v));
    bool is_cut = height <= dip && hasExtent(light);

    // Certain is what nothing hides on any face, or one surface on the surface's own.
    bool is_clear = result.drawn > 0.0f && !is_cut;
    if (is_cut && params.detail == 0u)
        return result;
    MaskFrame frame;
    if (params.detail > 0u) {
        clearMask();
        frame = maskFrame(light, extent, own_face, own);
    }
    // All segments to a point are one, which is in another face's margin near the border only.
    uint searched = !hasExtent(light) && isFarFromBorder(own.position) ? 1u : faces;
    for (uint i = 0u; i < searched; ++i) {
        uint face = (own_face + i) % faces;
        float depth = own.is_box ? own.depth : cubeCoordinates(face, direction).z;
        vec2 of_face = rangeOfFace(first_face + face);
        if (of_face.x >= max(depth, of_face.y))
            continue; // all segments stay in front of what it holds
        if (depth <= of_face.y) {
            is_clear = false; // no cone: something is within the light's own reach
            continue;
        }
        ShadowLookup tip = own;
        if (face != own_face)
            tip = shadowLookup(light_index, 0u, face, position, normal);
        LightCone cone = lightCone(light, extent, face, tip);
        uint ranges_first = rangeLevelsFirst(first_face + face);
        SearchedArea area = searchFace(cone, ranges_first, of_face.x, face == own_face);
        bool is_hidden = result.drawn == 0.0f && hidesAll(cone, ranges_first, area);
        if (!is_hidden && hidesNothing(cone, ranges_first, area))
            continue;
        if (is_hidden || (hasExtent(light) && hidesAll(cone, ranges_first, area))) {
            result.visible = 0.0f;
            result.is_certain = result.drawn == 0.0f && !is_cut;
            return result;
        }
        if (params.detail == 0u)
            return result;
        is_clear = false;
        if (hasExtent(light))
            hideCells(cone, maskView(light, frame, face, cone.tip), ranges_first, area);
    }
    result.is_certain = is_clear;
    if (is_clear || params.detail == 0u)
        return result;

    if (!hasExtent(light)) {
        result.visible = filteredShadow(own);
        return result;
    }
    if (is_cut)
        hideBelow(height, dot(normal, frame.half_u), dot(normal, frame.half_v));
    result.visible = visibleShare(frame, extent.is_round);
    return result;
}

HONE_FLAT void kernel(uint index) {
    error[index] = vec2(0.0f);
    Hit hit = gbuffer[index];
    if (hit.instance == kNone)
        return;
    Ray ray = cameraRay(params.camera, params.extent, pixelCenter(index, params.extent));
    Surface surface = surfaceAt(ray, hit);
    Material material = scene_materials[surface.material];
    vec3 base = material.base_color;
    if (params.detail > 0u) {
        float footprint = surface.t * 2.0f * params.camera.tan_half_fov_y / float(params.extent.y);
        base = vec3(baseColor(surface, ray.direction, footprint));
    }
    vec3 albedo = diffuseAlbedo(material, base);
    vec2 found = vec2(0.0f);
    uint light_count = uint(scene_lights.length());
    for (uint i = 0u; i < light_count; ++i) {
        if (scene_lights[i].shadowless != 0u)
            continue;
        vec3 direct = directLight(scene_lights[i], surface, albedo);
        float unshadowed = max(direct.x, max(direct.y, direct.z));
        if (unshadowed <= 0.0f)
            continue;
        ShadowEstimate shadow = estimateShadow(i, surface);
        if (shadow.is_certain)
            continue;
        if (params.detail == 0u) {
            found = vec2(1.0f); // 1 - prod(1 - E)
            break;
        }
        // What is unclear is never quite certain: half a cell of the mask.
        float share = max(abs(shadow.visible - shadow.drawn), 0.5f / 256.0f);
        found += unshadowed * vec2(share, max(shadow.drawn, 1.0f - shadow.drawn));
    }
    bool is_finite = !isnan(found.x) && !isinf(found.y);
    error[index] = is_finite ? found : vec2(1.0f);
}

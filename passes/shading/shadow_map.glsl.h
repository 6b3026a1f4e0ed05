// SPDX-License-Identifier: Apache-2.0
//
// Looking up the hard shadow maps that pass shadow_map makes. The record describes itself:
//
//     shadow_maps[0] size of a face in texels   [1] points per light that has an extent
//     shadow_maps[2..4] centre of the scene     [5] its radius     [6], [7] unused
//
// then, for each light in order and each of its points (the centre, then four around it; one where
// the light has no extent, none where nothing blocks it), six faces of size x size linear depths
// along the face's axis, 1e30 where nothing is. Directional lights use one orthographic face
// looking along the light, covering the scene's sphere, and leave five empty. Kernel source:
// included flat, once, inside a kernel, after cube.glsl.h and shading.glsl.h.

HONE_READ(float, shadow_maps)

HONE_CONST uint kShadowHeader = 8u;
HONE_CONST float kShadowOffset = 0.5f; // texels, where the light grazes

/// Maps of a light.
uint shadowPoints(Light light) {
    if (light.shadowless != 0u)
        return 0u;
    return hasExtent(light) ? uint(shadow_maps[1]) : 1u;
}

/// The sides to which a light's points k = 1..4 lie: corners of a square.
vec2 shadowCorner(uint k) {
    return vec2(((k - 1u) & 1u) == 0u ? -1.0f : 1.0f, k < 3u ? -1.0f : 1.0f);
}

/// A light's k-th point: 0 the centre; 1..4 the corners of a rectangle, points between them on the
/// rim of a disc, the corners of a tetrahedron in a sphere, which no side hides.
vec3 lightPoint(Light light, uint k) {
    if (k == 0u || light.kind == kLightDirectional)
        return light.position;
    vec2 corner = shadowCorner(k);
    if (light.kind == kLightSphere)
        return light.position +
               light.radius * 0.57735027f * vec3(corner.x, corner.y, corner.x * corner.y);
    return pointOfLight(light, light.position, corner);
}

/// Where a directional light's k-th point sends its light: a unit direction.
vec3 lightDirection(Light light, uint k) {
    if (k == 0u)
        return light.direction;
    return -normalize(pointOfLight(light, light.position, shadowCorner(k)));
}

/// Index of the first texel of a light's map for its point k.
uint shadowMapFirst(uint light_index, uint k) {
    uint maps = k;
    for (uint i = 0u; i < light_index; ++i)
        maps += shadowPoints(scene_lights[i]);
    uint size = uint(shadow_maps[0]);
    return kShadowHeader + maps * 6u * size * size;
}

/// A surface in a shadow map: where its point falls, and how the depth of its plane changes from
/// texel to texel.
struct ShadowLookup {
    uint first; ///< first texel of the face
    vec2 position;
    float depth; ///< along the face's axis
    float texel; ///< a texel's width in the world at that depth
    bool is_box; ///< orthographic
    float plane; ///< depth; perspective: 1 / depth, which is what is linear in the map
    vec2 slope;  ///< how that changes over the surface's plane, by column and row
};

/// On the face of a cube that `direction` falls on, or another that it is in front of; of
/// directional lights on their only face, 0.
ShadowLookup shadowLookup(uint light_index, uint k, uint face, vec3 position, vec3 normal) {
    Light light = scene_lights[light_index];
    uint size = uint(shadow_maps[0]);
    ShadowLookup result;
    result.first = shadowMapFirst(light_index, k) + face * size * size;
    result.is_box = light.kind == kLightDirectional;
    if (result.is_box) {
        vec3 center = vec3(shadow_maps[2], shadow_maps[3], shadow_maps[4]);
        float radius = shadow_maps[5];
        vec3 along = lightDirection(light, k);
        vec3 right = across(along);
        vec3 up = cross(right, along);
        vec3 from_center = position - center;
        result.depth = dot(from_center, along) + radius;
        result.position = vec2((0.5f + 0.5f * dot(from_center, right) / radius) * float(size),
                               (0.5f - 0.5f * dot(from_center, up) / radius) * float(size));
        result.texel = 2.0f * radius / float(size);
        result.plane = result.depth;
        result.slope =
            vec2(-dot(normal, right), dot(normal, up)) * (result.texel / dot(normal, along));
        return result;
    }
    vec3 direction = position - lightPoint(light, k);
    vec3 coordinates = cubeCoordinates(face, direction);
    vec3 leaning = cubeCoordinates(face, normal);
    result.depth = coordinates.z;
    result.position = cubePosition(coordinates, size);
    result.texel = 2.0f * result.depth / float(size);
    result.plane = 1.0f / result.depth;
    result.slope = vec2(leaning.x, -leaning.y) * (2.0f / (float(size) * dot(normal, direction)));
    return result;
}

/// The face of the map of a light's point k that a position falls on.
uint shadowFace(Light light, uint k, vec3 position) {
    return light.kind == kLightDirectional ? 0u : cubeFace(position - lightPoint(light, k));
}

/// Whether the texel at (column, row) is before the surface's plane by more than `bias`, in metres
/// along the face's axis. Outside the face counts as its border. The plane is taken to the texel's
/// centre, so a slanted surface does not shadow itself.
bool shadowBlocks(ShadowLookup lookup, int column, int row, float bias) {
    int size = int(shadow_maps[0]);
    int x = clamp(column, 0, size - 1);
    int y = clamp(row, 0, size - 1);
    float plane = lookup.plane + lookup.slope.x * (float(x) + 0.5f - lookup.position.x) +
                  lookup.slope.y * (float(y) + 0.5f - lookup.position.y);
    float lit_to = shadow_maps[lookup.first + uint(y) * uint(size) + uint(x)] + bias;
    // Where the light grazes the plane, it runs away from one texel to the next.
    if (lit_to >= lookup.depth + 16.0f * lookup.texel)
        return false;
    return lookup.is_box ? plane > lit_to : plane * lit_to < 1.0f;
}

/// 1 if the texel leaves the surface lit there, else 0. Little is left to a bias that would let
/// light through.
uint shadowTest(ShadowLookup lookup, int column, int row) {
    float bias = 0.25f * lookup.texel + 1e-4f * lookup.depth;
    return shadowBlocks(lookup, column, row, bias) ? 0u : 1u;
}

/// A surface's position as the map of the light's point k shall see it, moved off by up to half a
/// texel where the light grazes it: beside it, a curved surface rises above its plane.
vec3 shadowPosition(uint light_index, uint k, Surface surface) {
    Light light = scene_lights[light_index];
    vec3 point = lightPoint(light, k);
    LightSample to_light = lightFrom(light, surface.position, point);
    float cosine = clamp(dot(surface.geometric_normal, to_light.direction), 0.0f, 1.0f);
    vec3 away = abs(surface.position - point);
    float texel =
        2.0f / shadow_maps[0] *
        (light.kind == kLightDirectional ? shadow_maps[5] : max(away.x, max(away.y, away.z)));
    float offset = kShadowOffset * sqrt(1.0f - cosine * cosine) * texel;
    return surface.position + offset * surface.geometric_normal;
}

ShadowLookup shadowReceiver(uint light_index, uint k, Surface surface) {
    vec3 position = shadowPosition(light_index, k, surface);
    uint face = shadowFace(scene_lights[light_index], k, position);
    return shadowLookup(light_index, k, face, position, surface.geometric_normal);
}

/// What the nearest texel says: 1 lit, 0 in shadow.
uint shadowTestNearest(ShadowLookup lookup) {
    return shadowTest(lookup, int(floor(lookup.position.x)), int(floor(lookup.position.y)));
}

/// The hard shadow seen from the light's point k: 1 lit, 0 in shadow.
float shadowMapVisibility(uint light_index, uint k, Surface surface) {
    return float(shadowTestNearest(shadowReceiver(light_index, k, surface)));
}

// SPDX-License-Identifier: Apache-2.0
//
// The segments from a surface to all of a light, as a face of the map of the light's centre sees
// them. In the face's plane and its nearness (1 / depth; directional: -depth) segments are straight
// and planes are planes; so they fill a pyramid with its tip at the surface that grows with
// nearness. Kernel source: included flat, once, inside a kernel, after shadow_map.glsl.h.

struct LightCone {
    ShadowLookup tip;
    float nearness; ///< of the tip
    float reach;    ///< how far the light itself comes, along the face's axis
    vec2 low;       ///< texels to each side, by nearness: a box around the light
    vec2 high;
};

/// Texels around the segments that count: a triangle between texels' centres is in none of them,
/// and the nearest texel is half of one away.
HONE_CONST float kConeMargin = 1.5f;

float nearnessOf(ShadowLookup lookup, float depth) {
    return lookup.is_box ? -depth : 1.0f / depth;
}

float depthOf(ShadowLookup lookup, float nearness) {
    return lookup.is_box ? -nearness : 1.0f / nearness;
}

/// Nearness of the tip's plane at a position in texels.
float planeNearness(ShadowLookup lookup, vec2 position) {
    float plane = lookup.plane + dot(lookup.slope, position - lookup.position);
    return lookup.is_box ? -plane : plane;
}

/// By nearness, how far the segment to the light's point `off` from its centre (by the face's
/// right, up, forward) moves in the face.
vec2 coneSlope(ShadowLookup tip, vec3 off, bool is_exact) {
    float size = shadow_maps[0];
    if (tip.is_box)
        return vec2(off.x, -off.y) / tip.texel;
    vec2 at = vec2(2.0f * tip.position.x / size - 1.0f, 1.0f - 2.0f * tip.position.y / size);
    float leaning = is_exact ? tip.depth / (tip.depth - off.z) : 1.0f;
    return 0.5f * size * leaning * vec2(off.x - at.x * off.z, at.y * off.z - off.y);
}

/// A vector by the face's right, up and forward.
vec3 onFace(Light light, uint face, vec3 vector) {
    if (light.kind != kLightDirectional)
        return cubeCoordinates(face, vector);
    vec3 right = across(light.direction);
    return vec3(dot(vector, right), dot(vector, cross(right, light.direction)), 0.0f);
}

/// The tip must be farther along the face's axis than the light reaches.
LightCone lightCone(Light light, LightExtent extent, uint face, ShadowLookup tip) {
    LightCone cone;
    cone.tip = tip;
    cone.nearness = nearnessOf(tip, tip.depth);
    vec3 u = onFace(light, face, extent.half_u);
    vec3 v = onFace(light, face, extent.half_v);
    cone.reach = tip.is_box ? -1e30f : abs(u.z) + abs(v.z);
    cone.low = vec2(0.0f);
    cone.high = vec2(0.0f);
    for (int i = 0; i < 4; ++i) {
        vec3 corner = ((i & 1) == 0 ? -1.0f : 1.0f) * u + (i < 2 ? -1.0f : 1.0f) * v;
        vec2 slope = coneSlope(tip, corner, true);
        cone.low = min(cone.low, slope);
        cone.high = max(cone.high, slope);
    }
    return cone;
}

/// A rectangle of a face in texels.
struct Area {
    vec2 low;
    vec2 high;
};

/// What the segments cross from the tip to a nearness (Guennebaud et al. 2006, section 3.2), and
/// the margin.
Area coneArea(LightCone cone, float nearness) {
    float way = max(nearness - cone.nearness, 0.0f);
    Area area;
    area.low = cone.tip.position + way * cone.low - vec2(kConeMargin);
    area.high = cone.tip.position + way * cone.high + vec2(kConeMargin);
    return area;
}

bool overlap(Area a, Area b) {
    return a.low.x <= b.high.x && a.low.y <= b.high.y && b.low.x <= a.high.x && b.low.y <= a.high.y;
}

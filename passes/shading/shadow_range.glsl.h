// SPDX-License-Identifier: Apache-2.0
//
// How near and how far the depths of a shadow map are in any rectangle of a face: what pass
// shadow_range makes of the map of each light's centre. The finest cells are squares of 2 x 2
// texels. The record describes itself:
//
//     shadow_ranges[0]     cells along a face's edge; the coarsest level
//     shadow_ranges[1]     kRangeHsm or kRangeNbuffer; ranges a face
//     shadow_ranges[2]     faces of all lights; 0
//     shadow_ranges[3..15] of each level its first range in a face, and blocks along its edge
//
// then, for each light in order that has a map and each of its faces (six; directional: one), what
// the face holds at all: the least depth, and how far the light itself reaches along the face's
// axis, both as bits of floats; then all those faces' levels. A range is the bits of the least
// depth, with the sign set where the depths break off somewhere, and those of the greatest. A block
// of level l is 2^l x 2^l cells; blocks of hsm tile the face, those of nbuffer begin at every cell.
// Kernel source: included flat, once, inside a kernel, after shading.glsl.h.

HONE_READ(uvec2, shadow_ranges)

HONE_CONST uint kRangeHeader = 16u;
HONE_CONST uint kRangeFirstLevel = 3u;
HONE_CONST uint kRangeHsm = 0u;
HONE_CONST uint kRangeNbuffer = 1u;

uint rangeFaces(Light light) {
    if (light.shadowless != 0u)
        return 0u;
    return light.kind == kLightDirectional ? 1u : 6u;
}

/// Number of a light's first face.
uint rangeFirstFace(uint light_index) {
    uint faces = 0u;
    for (uint i = 0u; i < light_index; ++i)
        faces += rangeFaces(scene_lights[i]);
    return faces;
}

/// Least depth of a face, and reach of its light.
vec2 rangeOfFace(uint face) {
    uvec2 bits = shadow_ranges[kRangeHeader + face];
    return vec2(uintBitsToFloat(bits.x), uintBitsToFloat(bits.y));
}

/// Where the levels of a face begin.
uint rangeLevelsFirst(uint face) {
    return kRangeHeader + shadow_ranges[2].x + face * shadow_ranges[1].y;
}

/// The depths of an area: from nearest to farthest; broken: not the depths of one surface.
struct DepthRange {
    float nearest;
    float farthest;
    bool is_broken;
};

DepthRange depthRange(uvec2 bits) {
    DepthRange result;
    result.nearest = uintBitsToFloat(bits.x & 0x7fffffffu);
    result.farthest = uintBitsToFloat(bits.y);
    result.is_broken = (bits.x & 0x80000000u) != 0u;
    return result;
}

/// Depths are positive: their bits are ordered as they are.
uvec2 unitedRange(uvec2 a, uvec2 b) {
    uint nearest = min(a.x & 0x7fffffffu, b.x & 0x7fffffffu);
    return uvec2(nearest | ((a.x | b.x) & 0x80000000u), max(a.y, b.y));
}

/// The range of the block of `level` that begins at `cell`, a multiple of its size.
DepthRange blockRange(uint first, uint level, uvec2 cell) {
    uvec2 of_level = shadow_ranges[kRangeFirstLevel + level];
    uvec2 at = cell;
    if (shadow_ranges[1].x == kRangeHsm)
        at = uvec2(cell.x >> level, cell.y >> level);
    return depthRange(shadow_ranges[first + of_level.x + at.y * of_level.y + at.x]);
}

/// The range of all cells from low to high, both included. hsm: of the blocks that hold them, at
/// most most_blocks + 1 along an edge. nbuffer: exactly theirs, from four blocks that overlap where
/// the area is nearly square (Decoret, N-Buffers for efficient depth map query, 2005), from rows of
/// them where it is long.
DepthRange areaRange(uint first, uvec2 low, uvec2 high, uint most_blocks) {
    uint level = 0u;
    uvec2 united = uvec2(0x7f7fffffu, 0u);
    if (shadow_ranges[1].x == kRangeHsm) {
        while ((high.x >> level) - (low.x >> level) > most_blocks ||
               (high.y >> level) - (low.y >> level) > most_blocks)
            ++level;
        uvec2 of_level = shadow_ranges[kRangeFirstLevel + level];
        for (uint y = low.y >> level; y <= high.y >> level; ++y)
            for (uint x = low.x >> level; x <= high.x >> level; ++x)
                united =
                    unitedRange(united, shadow_ranges[first + of_level.x + y * of_level.y + x]);
        return depthRange(united);
    }
    uint edge = min(high.x - low.x, high.y - low.y) + 1u;
    while (level < shadow_ranges[0].y && (2u << level) <= edge)
        ++level;
    uvec2 of_level = shadow_ranges[kRangeFirstLevel + level];
    uint step_size = 1u << level;
    for (uint y = low.y; y <= high.y; y += step_size)
        for (uint x = low.x; x <= high.x; x += step_size) {
            uint row = min(y, high.y + 1u - step_size);
            uint column = min(x, high.x + 1u - step_size);
            united =
                unitedRange(united, shadow_ranges[first + of_level.x + row * of_level.y + column]);
        }
    return depthRange(united);
}

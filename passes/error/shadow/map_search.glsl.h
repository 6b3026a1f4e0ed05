// SPDX-License-Identifier: Apache-2.0
//
// What a face of the map says about the segments from a surface to a light: that nothing in it is
// in the way of any (lit), that one surface is across all of them (umbra), or neither. Kernel
// source: included flat, once, inside a kernel, after light_mask.glsl.h and the kernel's params.

/// Of a depth: what is that near to the surface's plane is the surface.
HONE_CONST float kBias = 2e-5f;

HONE_CONST uint kMostBlocks = 256u; ///< looked at below one
HONE_CONST uint kRetestBlocks = 8u; ///< along an area's edge, where four blocks were too wide

/// The texels of a block of cells.
Area blockArea(uint level, uvec2 cell) {
    Area area;
    area.low = vec2(float(2u * cell.x), float(2u * cell.y));
    area.high = area.low + vec2(float(2u << level));
    return area;
}

Area texelArea(uint x, uint y) {
    Area area;
    area.low = vec2(float(x), float(y));
    area.high = area.low + vec2(1.0f);
    return area;
}

/// Texels of a face that the segments may cross before something could block them.
struct SearchedArea {
    bool is_free;   ///< none: nothing is before the surface there
    bool is_inside; ///< all segments are in this face
    uvec2 low;
    uvec2 high;
    DepthRange range; ///< of the blocks that hold them
};

uvec2 firstCell(SearchedArea area) {
    return uvec2(area.low.x >> 1u, area.low.y >> 1u);
}

uvec2 lastCell(SearchedArea area) {
    return uvec2(area.high.x >> 1u, area.high.y >> 1u);
}

/// Least and greatest nearness of the tip's plane over a square area.
vec2 planeRange(LightCone cone, Area area) {
    float middle = planeNearness(cone.tip, 0.5f * (area.low + area.high));
    float spread =
        0.5f * (abs(cone.tip.slope.x) + abs(cone.tip.slope.y)) * (area.high.x - area.low.x);
    return vec2(middle - spread, middle + spread);
}

/// Whether a texel is between the cone's tip and the light, above the tip's plane.
bool isBlocker(LightCone cone, uint x, uint y, float nearness) {
    Area center;
    center.low = vec2(float(x) + 0.5f, float(y) + 0.5f);
    center.high = center.low;
    return overlap(center, coneArea(cone, nearness)) &&
           shadowBlocks(cone.tip, int(x), int(y), kBias * cone.tip.depth);
}

float texelNearness(LightCone cone, uint x, uint y) {
    uint size = uint(shadow_maps[0]);
    return nearnessOf(cone.tip, shadow_maps[cone.tip.first + y * size + x]);
}

/// Whether any of 4 x 4 texels is a blocker. Has no branches, so that compilers do all at once.
bool windowBlocks(LightCone cone, uvec2 first) {
    uint size = uint(shadow_maps[0]);
    float bias = kBias * cone.tip.depth;
    float behind = cone.tip.depth + 16.0f * cone.tip.texel;
    vec2 at = cone.tip.position;
    float box = cone.tip.is_box ? 1.0f : 0.0f; // chooses by product
    float cube = 1.0f - box;
    uint found = 0u;
    for (uint i = 0u; i < 16u; ++i) {
        uint x = min(first.x + (i & 3u), size - 1u);
        uint y = min(first.y + (i >> 2u), size - 1u);
        float center_x = float(x) + 0.5f;
        float center_y = float(y) + 0.5f;
        float depth = shadow_maps[cone.tip.first + y * size + x];
        float way = max(cube * (1.0f / depth) - box * depth - cone.nearness, 0.0f);
        uint is_across = uint(center_x >= at.x + way * cone.low.x - kConeMargin) &
                         uint(center_x <= at.x + way * cone.high.x + kConeMargin) &
                         uint(center_y >= at.y + way * cone.low.y - kConeMargin) &
                         uint(center_y <= at.y + way * cone.high.y + kConeMargin);
        float plane = cone.tip.plane + cone.tip.slope.x * (center_x - at.x) +
                      cone.tip.slope.y * (center_y - at.y);
        float lit_to = depth + bias;
        float left = box * (lit_to - plane) + cube * (plane * lit_to - 1.0f);
        found |= is_across & uint(lit_to < behind) & uint(left < 0.0f);
    }
    return found != 0u;
}

/// Looks at a block and, where that decides nothing, at its quarters, to windows of texels: whether
/// anything blocks segments of the cone. Ends where blocks are as small as what the mask resolves,
/// as seen there.
bool retestBlock(LightCone cone, uint ranges_first, uint start_level, uvec2 start_cell) {
    uint cells = shadow_ranges[0].x;
    uint stack[48];
    stack[0] = start_level << 28u | start_cell.y << 14u | start_cell.x;
    uint count = 1u;
    for (uint looked = 0u; count > 0u; ++looked) {
        if (looked == kMostBlocks)
            return true;
        uint top = stack[--count];
        uint level = top >> 28u;
        uvec2 cell = uvec2(top & 0x3fffu, top >> 14u & 0x3fffu);
        float nearness = nearnessOf(cone.tip, blockRange(ranges_first, level, cell).nearest);
        Area area = blockArea(level, cell);
        Area section = coneArea(cone, nearness);
        if (!overlap(area, section) || nearness <= planeRange(cone, area).x)
            continue;
        float wide = min(section.high.x - section.low.x, section.high.y - section.low.y) -
                     2.0f * kConeMargin;
        if (float(kMaskEdge) * (area.high.x - area.low.x) <= wide)
            return true;
        if (level <= 1u) {
            if (windowBlocks(cone, uvec2(2u * cell.x, 2u * cell.y)))
                return true;
            continue;
        }
        uint step_size = 1u << (level - 1u);
        for (uint i = 0u; i < 4u; ++i) {
            uvec2 quarter = uvec2(cell.x + (i & 1u) * step_size, cell.y + (i >> 1u) * step_size);
            if (quarter.x < cells && quarter.y < cells)
                stack[count++] = (level - 1u) << 28u | quarter.y << 14u | quarter.x;
        }
    }
    return false;
}

/// The level at which an area spans at most `most` blocks more than one along each edge.
uint levelOf(uvec2 low, uvec2 high, uint most) {
    uint level = 0u;
    while (level < shadow_ranges[0].y && ((high.x >> level) - (low.x >> level) > most ||
                                          (high.y >> level) - (low.y >> level) > most))
        ++level;
    return level;
}

/// Whether the texel that the cone's tip is in blocks the segment to the light's centre.
bool isTipHidden(LightCone cone) {
    float most = shadow_maps[0] - 1.0f;
    if (cone.tip.position.x < 0.0f || cone.tip.position.y < 0.0f || cone.tip.position.x > most ||
        cone.tip.position.y > most)
        return false;
    uint x = uint(cone.tip.position.x);
    uint y = uint(cone.tip.position.y);
    return isBlocker(cone, x, y, texelNearness(cone, x, y));
}

/// Whether anything in the area blocks segments of the cone: asked of the texels where one window
/// holds them, else of the few blocks that do. Where the light's centre is hidden neither is asked.
bool retestArea(LightCone cone, uint ranges_first, SearchedArea area) {
    if (area.high.x - area.low.x < 4u && area.high.y - area.low.y < 4u)
        return windowBlocks(cone, area.low);
    if (isTipHidden(cone))
        return true;
    uvec2 low = firstCell(area);
    uvec2 high = lastCell(area);
    uint level = levelOf(low, high, 1u);
    for (uint y = low.y >> level; y <= high.y >> level; ++y)
        for (uint x = low.x >> level; x <= high.x >> level; ++x)
            if (retestBlock(cone, ranges_first, level, uvec2(x << level, y << level)))
                return true;
    return false;
}

/// Whether what is in an area hides all of the light (umbra). Certified: it is one surface, which
/// each segment must cross, for it begins behind and ends before it.
bool isAcross(LightCone cone, DepthRange range) {
    // What the map's texels cannot tell from the surface hides nothing for certain.
    float bias = kConeMargin * cone.tip.texel + 1e-4f * cone.tip.depth;
    if (range.farthest >= cone.tip.depth - bias)
        return false;
    return params.certified == 0u || (!range.is_broken && range.nearest > cone.reach);
}

/// The search of Guennebaud et al. (2006, section 3.2) on one face: depths of the area that the
/// segments cross say up to where they are free, which makes the area smaller, and so on.
SearchedArea searchFace(LightCone cone, uint ranges_first, float nearest, bool is_own) {
    float size = shadow_maps[0];
    float lit_from = nearnessOf(cone.tip, cone.tip.depth - kBias * cone.tip.depth);
    float start = params.near > 0.0f ? params.near : nearest;
    Area area = coneArea(cone, nearnessOf(cone.tip, start));
    SearchedArea found;
    for (uint i = 0u; true; ++i) {
        found.is_free =
            area.high.x < 0.0f || area.high.y < 0.0f || area.low.x >= size || area.low.y >= size;
        if (found.is_free)
            return found;
        found.is_inside = is_own && area.low.x >= 0.0f && area.low.y >= 0.0f &&
                          area.high.x < size && area.high.y < size;
        vec2 from = clamp(area.low, vec2(0.0f), vec2(size - 1.0f));
        vec2 to = clamp(area.high, vec2(0.0f), vec2(size - 1.0f));
        found.low = uvec2(uint(from.x), uint(from.y));
        found.high = uvec2(uint(to.x), uint(to.y));
        found.range = areaRange(ranges_first, firstCell(found), lastCell(found), 1u);
        float most = nearnessOf(cone.tip, max(found.range.nearest, params.near));
        found.is_free = most <= lit_from;
        if (found.is_free)
            return found;
        Area next = coneArea(cone, most);
        if (i == params.iterations || next.high.x - next.low.x >= area.high.x - area.low.x)
            return found;
        area = next;
    }
    return found;
}

/// Whether the area hides all of the light.
bool hidesAll(LightCone cone, uint ranges_first, SearchedArea area) {
    if (area.is_free || !area.is_inside)
        return false;
    if (isAcross(cone, area.range))
        return true;
    // What nbuffer said was exact already.
    return params.retest != 0u && shadow_ranges[1].x == kRangeHsm &&
           isAcross(cone, areaRange(ranges_first, firstCell(area), lastCell(area), kRetestBlocks));
}

/// Whether the area hides nothing of the light.
bool hidesNothing(LightCone cone, uint ranges_first, SearchedArea area) {
    return area.is_free || (params.retest != 0u && !retestArea(cone, ranges_first, area));
}

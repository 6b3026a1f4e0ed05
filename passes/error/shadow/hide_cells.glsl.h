// SPDX-License-Identifier: Apache-2.0
//
// Which cells of the light's mask the map hides. Kernel source: included flat, once, inside a
// kernel, after map_search.glsl.h.

/// Hides what a block hides: where it is not wholly above the tip's plane, or not of one surface,
/// as its middle does.
void hideBlock(LightCone cone, MaskView view, uint ranges_first, uint level, uvec2 cell) {
    DepthRange range = blockRange(ranges_first, level, cell);
    float most = nearnessOf(cone.tip, range.nearest);
    Area area = blockArea(level, cell);
    vec2 plane = planeRange(cone, area);
    if (most <= plane.x || !overlap(area, coneArea(cone, most)))
        return;
    float least = nearnessOf(cone.tip, range.farthest);
    float nearness = 0.5f * (most + least);
    if (least <= plane.y || range.is_broken) {
        uint edge = uint(shadow_maps[0]) - 1u;
        uint x = min(2u * cell.x + (1u << level), edge);
        uint y = min(2u * cell.y + (1u << level), edge);
        if (!shadowBlocks(cone.tip, int(x), int(y), kBias * cone.tip.depth))
            return;
        nearness = texelNearness(cone, x, y);
    }
    hideArea(cone, view, area, nearness);
}

/// Hides what the area hides of the light, in blocks. Around the tip, where the segments are close
/// together, blocks get smaller, down to texels.
void hideCells(LightCone cone, MaskView view, uint ranges_first, SearchedArea area) {
    uvec2 low = firstCell(area);
    uvec2 high = lastCell(area);
    uint edge = uint(shadow_maps[0]) - 1u;
    vec2 tip = clamp(0.5f * cone.tip.position, vec2(0.0f), vec2(float(shadow_ranges[0].x - 1u)));
    uvec2 around = uvec2(uint(tip.x), uint(tip.y));
    uint reach = params.detail / 8u; // of smaller blocks, in blocks
    for (uint level = levelOf(low, high, params.detail); level > 0u; --level) {
        uvec2 inner = uvec2(around.x >> level, around.y >> level);
        for (uint y = low.y >> level; y <= high.y >> level; ++y)
            for (uint x = low.x >> level; x <= high.x >> level; ++x)
                if (x + reach < inner.x || x > inner.x + reach || y + reach < inner.y ||
                    y > inner.y + reach)
                    hideBlock(cone, view, ranges_first, level, uvec2(x << level, y << level));
        uvec2 from =
            uvec2((max(inner.x, reach) - reach) << level, (max(inner.y, reach) - reach) << level);
        uvec2 to =
            uvec2(((inner.x + reach + 1u) << level) - 1u, ((inner.y + reach + 1u) << level) - 1u);
        low = max(low, from);
        high = min(high, to);
        if (low.x > high.x || low.y > high.y)
            return;
    }
    uvec2 last = uvec2(min(2u * high.x + 1u, edge), min(2u * high.y + 1u, edge));
    for (uint y = 2u * low.y; y <= last.y; ++y)
        for (uint x = 2u * low.x; x <= last.x; ++x) {
            float nearness = texelNearness(cone, x, y);
            if (isBlocker(cone, x, y, nearness))
                hideArea(cone, view, texelArea(x, y), nearness);
        }
}

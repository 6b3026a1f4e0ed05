// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/texture.glsl.h"

#include "hone/core/scene/surface.glsl.h"

#include "hone/passes/shading/shading.glsl.h"

#include "hone/passes/shading/cube.glsl.h"

#include "hone/passes/shading/shadow_map.glsl.h"

struct Params {
    uint light;
    uint first;       ///< range of the light's first face
    uint face_ranges; ///< from face to face
    uint cells;       ///< along a face's edge
};
HONE_PARAMS(Params)
HONE_WRITE(uvec2, ranges)

/// Depth of a texel. What is behind a light that shines to one side is as far as can be: no light
/// passes there, and lamps hang under ceilings.
float depthAt(Light light, uint face, int column, int row) {
    uint size = uint(shadow_maps[0]);
    uint x = uint(clamp(column, 0, int(size) - 1));
    uint y = uint(clamp(row, 0, int(size) - 1));
    bool is_flat = light.kind == kLightRectangle || light.kind == kLightDisc;
    vec2 center = vec2(float(x) + 0.5f, float(y) + 0.5f);
    if (is_flat && dot(cubeDirection(face, center, size), light.direction) <= 0.0f)
        return 1e30f;
    return shadow_maps[shadowMapFirst(params.light, 0u) + face * size * size + y * size + x];
}

/// What is linear in the map over a plane.
float nearness(Light light, float depth) {
    return light.kind == kLightDirectional ? -depth : 1.0f / depth;
}

/// Whether depth breaks off between the second and the third of four texels in a row. A surface
/// goes on as it did on one side or does on the other, or between that where it bends; more than a
/// texel's width in depth besides is a gap.
bool breaksOff(Light light, float a, float b, float c, float d) {
    float wide = light.kind == kLightDirectional ? shadow_maps[5] : 1.0f / max(b, c);
    float gap = 2.0f * wide / shadow_maps[0];
    float before = nearness(light, b) - nearness(light, a);
    float here = nearness(light, c) - nearness(light, b);
    float after = nearness(light, d) - nearness(light, c);
    return here < min(before, after) - gap || here > max(before, after) + gap;
}

/// The range of 2 x 2 texels; breaks towards the next cells to the right and below are theirs.
void kernel(uint index) {
    Light light = scene_lights[params.light];
    uint cells = params.cells * params.cells;
    uint face = index / cells;
    uint cell = index % cells;
    int column = 2 * int(cell % params.cells);
    int row = 2 * int(cell / params.cells);
    float nearest = 1e30f;
    float farthest = 0.0f;
    bool is_broken = false;
    for (int i = 0; i < 2; ++i) {
        float along_row[5];
        float along_column[5];
        for (int k = 0; k < 5; ++k) {
            along_row[k] = depthAt(light, face, column + k - 1, row + i);
            along_column[k] = depthAt(light, face, column + i, row + k - 1);
        }
        for (int k = 1; k < 3; ++k) {
            nearest = min(nearest, along_row[k]);
            farthest = max(farthest, along_row[k]);
            is_broken = is_broken ||
                        breaksOff(light, along_row[k - 1], along_row[k], along_row[k + 1],
                                  along_row[k + 2]) ||
                        breaksOff(light, along_column[k - 1], along_column[k], along_column[k + 1],
                                  along_column[k + 2]);
        }
    }
    uint bits = floatBitsToUint(nearest) | (is_broken ? 0x80000000u : 0u);
    ranges[params.first + face * params.face_ranges + cell] =
        uvec2(bits, floatBitsToUint(farthest));
}

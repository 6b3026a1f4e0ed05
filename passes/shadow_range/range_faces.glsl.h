// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/texture.glsl.h"

#include "hone/core/scene/surface.glsl.h"

#include "hone/passes/shading/shading.glsl.h"

#include "hone/passes/shading/cube.glsl.h"

#include "hone/passes/shading/shadow_range.glsl.h"

struct Params {
    uint light;
    uint first_face;
};
HONE_PARAMS(Params)
HONE_WRITE(uvec2, ranges)

/// How far the light's own points are along a face's axis.
float lightReach(Light light, uint face) {
    vec3 forward = cubeForward(face);
    if (light.kind == kLightRectangle || light.kind == kLightDisc)
        return abs(dot(light.half_u, forward)) + abs(dot(light.half_v, forward));
    return light.kind == kLightSphere ? light.radius : 0.0f;
}

/// What a face holds at all, from its coarsest level.
void kernel(uint index) {
    uint face = params.first_face + index;
    uint top = shadow_ranges[0].y;
    uint cells = shadow_ranges[0].x;
    uint first = rangeLevelsFirst(face);
    float nearest = 1e30f;
    for (uint y = 0u; y < cells; y += 1u << top)
        for (uint x = 0u; x < cells; x += 1u << top)
            nearest = min(nearest, blockRange(first, top, uvec2(x, y)).nearest);
    ranges[kRangeHeader + face] = uvec2(
        floatBitsToUint(nearest), floatBitsToUint(lightReach(scene_lights[params.light], index)));
}

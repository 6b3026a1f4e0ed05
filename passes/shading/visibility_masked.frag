// SPDX-License-Identifier: Apache-2.0
//
// Writes which triangle of the draw list is seen, through the holes of masked materials.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "hone/passes/shading/masked.glsl"

layout(location = 0) out uvec2 hit;

void main() {
    hit = uvec2(solidTriangle(), 0u);
}

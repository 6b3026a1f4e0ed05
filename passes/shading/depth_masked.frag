// SPDX-License-Identifier: Apache-2.0
//
// Depth only, through the holes of masked materials.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "hone/passes/shading/masked.glsl"

void main() {
    solidTriangle();
}

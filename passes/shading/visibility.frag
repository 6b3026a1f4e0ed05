// SPDX-License-Identifier: Apache-2.0
//
// Writes which triangle of the draw list is seen. Its name is looked up once a pixel afterwards
// (resolve_hits): a lookup here, once a fragment, takes software devices a third of the pass.
#version 460
#extension GL_GOOGLE_include_directive : require

layout(location = 0) flat in uint first_triangle;
layout(location = 0) out uvec2 hit;

void main() {
    hit = uvec2(first_triangle + uint(gl_PrimitiveID), 0u);
}

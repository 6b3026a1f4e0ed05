#version 460
#extension GL_EXT_scalar_block_layout : require
// SPDX-License-Identifier: Apache-2.0

// Declared before what the vertex stage reads as well: both stages number their buffers from 0.
layout(scalar) readonly buffer labels_buffer { uint labels[]; };
layout(scalar) readonly buffer positions_buffer { vec3 positions[]; };

layout(location = 0) flat in uint instance;
layout(location = 0) out uvec2 hit;

void main() {
    // positions[0].z is 0 or more in every test; reading it shares the vertex stage's binding.
    uint zero = positions[0].z < 0.0 ? 1u : 0u;
    hit = uvec2(labels[instance] + zero, uint(gl_PrimitiveID));
}

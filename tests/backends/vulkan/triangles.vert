#version 460
#extension GL_EXT_scalar_block_layout : require
// SPDX-License-Identifier: Apache-2.0

layout(push_constant, scalar) uniform Params { vec2 move; };
layout(scalar) readonly buffer positions_buffer { vec3 positions[]; };

layout(location = 0) flat out uint instance;

void main() {
    gl_Position = vec4(positions[gl_VertexIndex], 1.0);
    gl_Position.xy += move;
    instance = gl_InstanceIndex;
}

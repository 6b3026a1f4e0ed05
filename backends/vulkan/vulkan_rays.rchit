// SPDX-License-Identifier: Apache-2.0
//
// The closest hit, or the one that ended an occlusion ray.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_ray_tracing : require
#include "hone/backends/vulkan/vulkan_trace.glsl"

layout(location = 0) rayPayloadInEXT Hit seen;

void main() {
    seen = hitOf(uint(gl_InstanceID), uint(gl_GeometryIndexEXT), uint(gl_PrimitiveID));
}

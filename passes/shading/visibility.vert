// SPDX-License-Identifier: Apache-2.0
//
// World position to clip space, along the axes that cameraRay() uses: what covers a pixel's centre
// is what the pixel's ray meets. Depth is reversed: 1 at the near plane, 0 at infinity (or at the
// end of an orthographic box).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "hone/core/device/kernel.glsl.h"
#include "hone/core/scene/scene.glsl.h"
#include "hone/passes/shading/view.glsl.h"

layout(push_constant, scalar) uniform Push {
    View params;
};
HONE_READ(vec3, world_positions)

/// Number of the draw's first triangle among triangle_ids; gl_PrimitiveID counts from there.
layout(location = 0) flat out uint first_triangle;

void main() {
    Camera camera = params.camera;
    vec3 offset = world_positions[gl_VertexIndex] - camera.position;
    float aspect = float(params.extent.x) / float(params.extent.y);
    float x = dot(offset, camera.right) / (camera.tan_half_fov_y * aspect);
    float y = -dot(offset, camera.up) / camera.tan_half_fov_y;
    float depth = dot(offset, camera.forward);
    gl_Position = params.depth_range > 0.0f ? vec4(x, y, 1.0f - depth / params.depth_range, 1.0f)
                                            : vec4(x, y, camera.near, depth);
    first_triangle = uint(gl_InstanceIndex);
}

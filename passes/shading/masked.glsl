// SPDX-License-Identifier: Apache-2.0
//
// The alpha test of the fragment shaders: asks isSolid() with the very ray that the tracer would
// use, so both see the same holes.
#include "hone/core/device/kernel.glsl.h"
#include "hone/core/scene/scene.glsl.h"
#include "hone/core/trace/ray.glsl.h"
#include "hone/core/scene/texture.glsl.h"
#include "hone/core/scene/surface.glsl.h"
#include "hone/core/scene/camera.glsl.h"
#include "hone/passes/shading/view.glsl.h"

layout(push_constant, scalar) uniform Push {
    View params;
};
HONE_READ(uvec2, triangle_ids)

layout(location = 0) flat in uint first_triangle;

Ray fragmentRay() {
    Ray ray = cameraRay(params.camera, params.extent, gl_FragCoord.xy);
    if (params.depth_range > 0.0f) {
        ray.origin += ray.direction - params.camera.forward;
        ray.direction = params.camera.forward;
    }
    return ray;
}

/// The triangle of the draw list under the fragment; a hole in it discards the fragment.
uint solidTriangle() {
    uint place = first_triangle + uint(gl_PrimitiveID);
    uvec2 id = triangle_ids[place];
    Hit hit;
    hit.instance = id.x;
    hit.primitive = id.y;
    if (!isSolid(fragmentRay(), hit))
        discard;
    return place;
}

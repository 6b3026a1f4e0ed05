// SPDX-License-Identifier: Apache-2.0
//
// One ray query an invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_ray_query : require
#include "hone/backends/vulkan/vulkan_trace.glsl"

layout(local_size_x = 32) in;

Hit trace(Ray ray) {
    rayQueryEXT seen;
    rayQueryInitializeEXT(seen, accelerationStructureEXT(params.tree), rayFlags(), 0xffu,
                          ray.origin, rayBegin(ray), ray.direction, rayEnd(ray));
    // Opaque triangles are settled without us; what is asked is a mask.
    while (rayQueryProceedEXT(seen)) {
        Hit candidate = hitOf(uint(rayQueryGetIntersectionInstanceIdEXT(seen, false)),
                              uint(rayQueryGetIntersectionGeometryIndexEXT(seen, false)),
                              uint(rayQueryGetIntersectionPrimitiveIndexEXT(seen, false)));
        if (isSolid(ray, candidate))
            rayQueryConfirmIntersectionEXT(seen);
    }
    if (rayQueryGetIntersectionTypeEXT(seen, true) == gl_RayQueryCommittedIntersectionNoneEXT)
        return kMiss;
    return hitOf(uint(rayQueryGetIntersectionInstanceIdEXT(seen, true)),
                 uint(rayQueryGetIntersectionGeometryIndexEXT(seen, true)),
                 uint(rayQueryGetIntersectionPrimitiveIndexEXT(seen, true)));
}

void main() {
    uint index = gl_GlobalInvocationID.y * hone_row + gl_GlobalInvocationID.x;
    if (index >= hone_count)
        return;
    Ray ray = rays[params.first_ray + index];
    Hit hit = kMiss;
    if (isTraceable(ray))
        hit = trace(ray);
    writeAnswer(index, hit);
}

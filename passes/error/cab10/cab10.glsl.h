// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/texture.glsl.h"

#include "hone/core/scene/surface.glsl.h"

#include "hone/core/scene/camera.glsl.h"

#include "hone/passes/shading/shading.glsl.h"

struct Params {
    Camera camera;
    uvec2 extent;
    uint takes_transparent;
    float epsilon;
};
HONE_PARAMS(Params)
HONE_READ(Hit, gbuffer)
HONE_WRITE(vec2, error)

bool reflects(uint index, Hit hit) {
    Ray ray = cameraRay(params.camera, params.extent, pixelCenter(index, params.extent));
    Surface surface = surfaceAt(ray, hit);
    vec3 weight =
        mirrorWeight(scene_materials[surface.material], surface.normal, normalize(ray.direction));
    return max(weight.x, max(weight.y, weight.z)) > params.epsilon;
}

void kernel(uint index) {
    error[index] = vec2(0.0f);
    Hit hit = gbuffer[index];
    if (hit.instance == kNone)
        return;
    uint flags = materialFlags(hit);
    bool is_transparent = params.takes_transparent != 0u && (flags & kMaterialMasked) != 0u;
    if (is_transparent || ((flags & kMaterialMirror) != 0u && reflects(index, hit)))
        error[index] = vec2(1.0f);
}

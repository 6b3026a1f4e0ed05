// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/texture.glsl.h"

#include "hone/core/scene/surface.glsl.h"

#include "hone/core/scene/camera.glsl.h"

#include "hone/core/trace/random.glsl.h"

struct Params {
    Camera camera;
    uvec2 extent;
    uint rays;
    uint steps;
};
HONE_PARAMS(Params)
HONE_READ(Hit, gbuffer)
HONE_READ(float, object_size) // by instance: no two of its points are farther apart
HONE_WRITE(float, occlusion)

/// The position in pixels that shows a point in front of the camera; the inverse of cameraRay().
vec2 projected(vec3 from_camera, float depth) {
    float x = dot(from_camera, params.camera.right) / (depth * params.camera.tan_half_fov_y);
    float y = dot(from_camera, params.camera.up) / (depth * params.camera.tan_half_fov_y);
    return vec2(0.5f * (float(params.extent.x) + x * float(params.extent.y)),
                0.5f * (float(params.extent.y) - y * float(params.extent.y)));
}

/// Whether the image shows the instance in front of the point, in the point's pixel.
bool isBehind(vec3 point, uint instance) {
    vec3 from_camera = point - params.camera.position;
    float depth = dot(from_camera, params.camera.forward);
    if (depth <= params.camera.near)
        return false;
    vec2 position = projected(from_camera, depth);
    if (!(position.x >= 0.0f && position.y >= 0.0f && position.x < float(params.extent.x) &&
          position.y < float(params.extent.y)))
        return false;
    Hit hit = gbuffer[uint(position.y) * params.extent.x + uint(position.x)];
    if (hit.instance != instance)
        return false;
    // Where the pixel's triangle is on the way to the point itself, not to the pixel's centre.
    Surface front = surfaceAt(cameraRay(params.camera, params.extent, position), hit);
    float front_depth = dot(front.position - params.camera.position, params.camera.forward);
    return front_depth < depth * (1.0f - 1e-5f);
}

/// Direction `k` of the cosine-weighted hemisphere (Malley): a lattice, turned by `turn`.
vec3 hemisphereDirection(uint k, vec3 normal, vec2 turn) {
    float u = fract((float(k) + 0.5f) / float(params.rays) + turn.x);
    float v = fract(float(k) * 0.61803399f + turn.y);
    float angle = 6.2831853f * u;
    float radius = sqrt(v);
    vec3 across = abs(normal.x) > 0.9f ? vec3(0.0f, 1.0f, 0.0f) : vec3(1.0f, 0.0f, 0.0f);
    vec3 tangent = normalize(cross(normal, across));
    vec3 bitangent = cross(normal, tangent);
    return radius * cos(angle) * tangent + radius * sin(angle) * bitangent +
           sqrt(max(1.0f - v, 0.0f)) * normal;
}

/// Walks from the surface to where its object must have ended, in steps that grow with the
/// distance.
bool isCovered(Surface surface, vec3 direction, float first, float last, float jitter) {
    for (uint i = 0u; i < params.steps; ++i) {
        float t = first * pow(last / first, (float(i) + jitter) / float(params.steps));
        if (isBehind(surface.position + t * direction, surface.instance))
            return true;
    }
    return false;
}

void kernel(uint index) {
    occlusion[index] = 0.0f;
    Hit hit = gbuffer[index];
    if (hit.instance == kNone || (materialFlags(hit) & kMaterialMirror) == 0u)
        return;
    Ray ray = cameraRay(params.camera, params.extent, pixelCenter(index, params.extent));
    Surface surface = surfaceAt(ray, hit);
    // The first step is a pixel wide: nothing smaller is in the image.
    float last = object_size[hit.instance];
    float first = 2.0f * surface.t * params.camera.tan_half_fov_y / float(params.extent.y);
    if (!(last > first))
        return;
    uint covered = 0u;
    for (uint k = 0u; k < params.rays; ++k) {
        uvec4 bits = pcg4d(uvec4(index, k, 0u, 0u));
        uvec4 turn = pcg4d(uvec4(index, 0u, 1u, 0u));
        vec3 direction = hemisphereDirection(k, surface.geometric_normal,
                                             vec2(unitFloat(turn.x), unitFloat(turn.y)));
        if (isCovered(surface, direction, first, last, unitFloat(bits.x)))
            ++covered;
    }
    occlusion[index] = float(covered) / float(params.rays);
}

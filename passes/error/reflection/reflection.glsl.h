// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/texture.glsl.h"

#include "hone/core/scene/surface.glsl.h"

#include "hone/core/scene/camera.glsl.h"

#include "hone/passes/shading/shading.glsl.h"

struct Params {
    Camera camera;
    uvec2 extent;
    uint metric;
    uint orientation; ///< 0 corrected, 1 as printed, 2 accessibility
    uint covered;     ///< metric 5: 0 the share, 1 any
    uint has_screen;  ///< metric 5: whose occlusion to take
    float epsilon;
};
HONE_PARAMS(Params)
HONE_READ(Probe, scene_probes)
HONE_READ(Hit, gbuffer)
HONE_READ(float, occlusion)        // by vertex
HONE_READ(float, screen_occlusion) // by pixel
HONE_READ(float, max_distance)     // by instance: how far from its probe its error is greatest
HONE_WRITE(vec2, error)

HONE_CONST uint kReach = 0u; ///< no metric: |p - c| in metres, to find the greatest of the image

/// Metric 2: how far the surface is from where its reflection was taken. Without a probe nobody
/// knows.
float distanceError(Surface surface, uint probe) {
    if (probe == kNone)
        return 1.0f;
    float away = distance(surface.position, scene_probes[probe].position);
    if (params.metric == kReach)
        return away;
    float greatest = max_distance[surface.instance];
    return greatest > 0.0f ? min(away / greatest, 1.0f) : 0.0f;
}

/// Metric 3: -i.r is cos(2 theta), greatest where the lookup is right; turned round,
/// (1 - -i.r) / 2 = sin^2(theta).
float reflectionAngleError(vec3 incident, vec3 normal) {
    float cosine = -dot(incident, reflect(incident, normal));
    return params.orientation == 1u ? max(cosine, 0.0f) : 0.5f - 0.5f * cosine;
}

/// Metric 4: -i.n is cos(theta), greatest where the lookup is right.
float normalAngleError(vec3 incident, vec3 normal) {
    float cosine = -dot(incident, normal);
    return params.orientation == 1u ? max(cosine, 0.0f) : 1.0f - cosine;
}

/// An input that says accessibility is 1 where nothing covers.
float toOcclusion(float share) {
    return params.orientation == 2u ? 1.0f - share : share;
}

/// Metric 5: how much of the hemisphere the object itself covers, or whether it covers any.
float occlusionError(Surface surface, uint pixel) {
    float share = 0.0f;
    if (params.has_screen != 0u) {
        share = toOcclusion(screen_occlusion[pixel]);
    } else {
        Mesh mesh = scene_meshes[scene_instances[surface.instance].mesh];
        uvec3 corners = scene_triangles[mesh.first_triangle + surface.primitive];
        vec2 weights = surface.barycentrics;
        share = (1.0f - weights.x - weights.y) * toOcclusion(occlusion[corners.x]) +
                weights.x * toOcclusion(occlusion[corners.y]) +
                weights.y * toOcclusion(occlusion[corners.z]);
    }
    return params.covered == 1u && share > 0.0f ? 1.0f : share;
}

float metricError(Surface surface, vec3 incident, uint pixel) {
    if (params.metric == 1u)
        return 1.0f;
    if (params.metric == 2u || params.metric == kReach)
        return distanceError(surface, scene_instances[surface.instance].probe);
    if (params.metric == 3u)
        return reflectionAngleError(incident, surface.normal);
    if (params.metric == 4u)
        return normalAngleError(incident, surface.normal);
    return occlusionError(surface, pixel);
}

void kernel(uint index) {
    error[index] = vec2(0.0f);
    Hit hit = gbuffer[index];
    if (hit.instance == kNone || (materialFlags(hit) & kMaterialMirror) == 0u)
        return;
    Ray ray = cameraRay(params.camera, params.extent, pixelCenter(index, params.extent));
    Surface surface = surfaceAt(ray, hit);
    vec3 incident = normalize(ray.direction);
    vec3 weight = mirrorWeight(scene_materials[surface.material], surface.normal, incident);
    if (max(weight.x, max(weight.y, weight.z)) <= params.epsilon)
        return;
    float found = metricError(surface, incident, index);
    if (params.metric == kReach) {
        error[index] = vec2(found);
        return;
    }
    // What is no number is an error for certain.
    found = found >= 0.0f || found < 0.0f ? clamp(found, 0.0f, 1.0f) : 1.0f;
    error[index] = vec2(found);
}

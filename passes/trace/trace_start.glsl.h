// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/camera.glsl.h"
#include "hone/core/trace/disc.glsl.h"
#include "hone/core/trace/random.glsl.h"

#include "hone/passes/trace/path.glsl.h"

struct Params {
    Camera camera;
    uvec2 extent;
    uint first_request; ///< of this wave
    uint first_slot;
    uint seed_low;
    uint seed_high;
};
HONE_PARAMS(Params)
HONE_READ(uvec3, requests)
HONE_READ(uint, first_paths) // of each request of the wave
HONE_WRITE(Ray, rays)
HONE_WRITE(Path, paths)

/// Where on the lens a sample's ray starts. Samples of a pixel go through points of a sequence of
/// its own, so that few of them cover the lens evenly and neighbours' noise differs.
vec2 lensPoint(uint pixel, uint sample_number) {
    // Numbers that no light of no bounce has (trace_shade).
    uvec4 random = pcg4d(uvec4(pixel, kNone, kNone ^ params.seed_high, params.seed_low));
    uvec2 bits = scrambledSobol(sample_number, uvec2(random.x, random.y));
    return discFromSquare(2.0f * vec2(unitFloat(bits.x), unitFloat(bits.y)) - vec2(1.0f));
}

/// A request becomes a path for each sample. Through a pinhole they share one ray, through the
/// pixel's centre; through a lens each has its own.
void kernel(uint index) {
    uvec3 request = requests[params.first_request + index];
    vec2 center = pixelCenter(request.x, params.extent);
    bool has_lens = params.camera.lens_radius > 0.0f;
    if (!has_lens)
        rays[index] = cameraRay(params.camera, params.extent, center);
    Path path;
    path.throughput = vec3(1.0f);
    path.traveled = 0.0f;
    path.pixel = request.x;
    for (uint i = 0u; i < request.z; ++i) {
        uint path_index = first_paths[index] + i;
        path.slot = params.first_slot + path_index;
        path.sample_number = request.y + i;
        path.ray = has_lens ? path_index : index;
        if (has_lens)
            rays[path_index] = lensRay(params.camera, params.extent, center,
                                       lensPoint(request.x, path.sample_number));
        paths[path_index] = path;
    }
}

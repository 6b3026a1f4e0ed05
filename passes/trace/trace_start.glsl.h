// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/camera.glsl.h"
#include "hone/passes/trace/path.glsl.h"

struct Params {
    Camera camera;
    uvec2 extent;
    uint first_request; ///< of this wave
    uint first_slot;
};
HONE_PARAMS(Params)
HONE_READ(uvec3, requests)
HONE_READ(uint, first_paths) // of each request of the wave
HONE_WRITE(Ray, rays)
HONE_WRITE(Path, paths)

/// A request becomes one ray through its pixel's centre and a path for each sample.
void kernel(uint index) {
    uvec3 request = requests[params.first_request + index];
    rays[index] = cameraRay(params.camera, params.extent, pixelCenter(request.x, params.extent));
    Path path;
    path.throughput = vec3(1.0f);
    path.traveled = 0.0f;
    path.ray = index;
    path.pixel = request.x;
    for (uint i = 0u; i < request.z; ++i) {
        uint path_index = first_paths[index] + i;
        path.slot = params.first_slot + path_index;
        path.sample_number = request.y + i;
        paths[path_index] = path;
    }
}

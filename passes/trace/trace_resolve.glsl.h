// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/trace/path.glsl.h"

struct Params {
    uint path_count;
    uint light_count;
};
HONE_PARAMS(Params)
HONE_READ(Path, paths)
HONE_READ(uint, occluded)
HONE_READ(vec3, light_radiance)
HONE_WRITE(Sample, samples)

/// Adds the light of the lights that are seen, in their order.
void kernel(uint index) {
    uint slot = paths[index].slot;
    vec3 radiance = samples[slot].radiance;
    for (uint i = 0u; i < params.light_count; ++i)
        if (occluded[i * params.path_count + index] == 0u)
            radiance += light_radiance[i * params.path_count + index];
    samples[slot].radiance = radiance;
}

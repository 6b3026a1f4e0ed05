// SPDX-License-Identifier: Apache-2.0
//
// Whether anything is in the way of each ray.
#include "hone/backends/bvh/bvh.glsl.h"

#include "hone/core/scene/texture.glsl.h"

#include "hone/core/scene/surface.glsl.h"

#include "hone/backends/bvh/traverse.glsl.h"

HONE_WRITE(uint, occluded)

void kernel(uint index) {
    uint answer = params.first_answer + index;
    Hit best;
    best.instance = kNone;
    best.primitive = kNone;
    bool is_found = traverse(index, true, best);
    // A ray that was done before stays as it was answered.
    occluded[answer] = is_found || (params.is_resumed != 0u && occluded[answer] != 0u) ? 1u : 0u;
}

// SPDX-License-Identifier: Apache-2.0
//
// The nearest hit of each ray.
#include "hone/backends/bvh/bvh.glsl.h"

#include "hone/core/scene/texture.glsl.h"

#include "hone/core/scene/surface.glsl.h"

#include "hone/backends/bvh/traverse.glsl.h"

HONE_WRITE(Hit, hits)

void kernel(uint index) {
    uint answer = params.first_answer + index;
    Hit best;
    best.instance = kNone;
    best.primitive = kNone;
    if (params.is_resumed != 0u)
        best = hits[answer];
    traverse(index, false, best);
    hits[answer] = best;
}

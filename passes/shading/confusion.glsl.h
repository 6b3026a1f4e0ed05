// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/camera.glsl.h"

struct Params {
    Camera camera;
    uvec2 extent;
};
HONE_PARAMS(Params)
HONE_READ(float, depth)
HONE_WRITE(float, confusion)

void kernel(uint index) {
    confusion[index] = circleOfConfusion(params.camera, params.extent, depth[index]);
}

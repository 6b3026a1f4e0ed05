// SPDX-License-Identifier: Apache-2.0
//
// Where the rasteriser looks from: a camera, a cube face or a directional light's box.
#ifndef HONE_VIEW_GLSL_H
#define HONE_VIEW_GLSL_H

#ifdef __cplusplus
#include "hone/core/scene/scene.glsl.h"
namespace hone {
#endif

/// A view as the draw list culls for it and the vertex shader projects for it.
struct View {
    Camera camera; ///< orthographic: tan_half_fov_y is half the height of the box in metres
    uvec2 extent;
    float depth_range; ///< 0: perspective, infinitely deep; else orthographic: metres from
                       ///< camera.position to the end of the box
};

#ifdef __cplusplus
static_assert(sizeof(View) == 76);
} // namespace hone
#endif
#endif

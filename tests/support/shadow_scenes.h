// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/scene/scene.h"
#include "hone/tests/support/scene_builder.h"

namespace hone::test {

/// 2 x 2 at height 10 over the origin, shining down; of other kinds, that wide: a disc or sphere of
/// radius 1, a sun of which 0.1 is the tangent of half the angle.
[[nodiscard]] Light lampOf(uint kind = kLightRectangle);

/// 90 degrees of view.
[[nodiscard]] Camera cameraAt(vec3 position, vec3 forward, vec3 up);

/// Sees x and z in +-3.5 of the floor at y = 0 around `x`, from below height 4.
[[nodiscard]] Camera lookingDown(float x = 0);

/// A square of 40 x 40 around `middle`, spanned by unit vectors; white and two-sided.
void addSquare(SceneBuilder& builder, vec3 middle, vec3 u, vec3 v);

/// A half-plane x < `edge` at height 4 over a floor, and a light.
[[nodiscard]] Scene edgeOverFloor(const Light& light, float edge = 0);

/// The share of a light that the point (x, 0, z) of that floor sees: each of 200 x 200 points of
/// its square or disc is asked whether its segment passes the edge.
[[nodiscard]] float visibleBesideEdge(const Light& light, float edge, float x, float z);

} // namespace hone::test

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/scene/scene.h"

#include <functional>

namespace hone {

// Base-colour textures of the built-in scenes. All repeat without a seam unless said otherwise,
// have all mip levels, and are appended to the scene; each returns its index.

/// A texture from a function of the texel's centre in [0,1)^2, v down: linear colour and alpha, cut
/// to [0,1].
uint addTexture(Scene& scene, uvec2 extent, const std::function<vec4(vec2)>& color, uint wrap_u = 0,
                uint wrap_v = 0);

/// Weathered stone of that mean colour; `contrast` of its stains, 0 to 1.
uint addStoneTexture(Scene& scene, vec3 color, float contrast, uint seed);

/// Courses of cut blocks in running bond: `across` by `courses` blocks, mortar `joint` of a course
/// wide.
uint addMasonryTexture(Scene& scene, uint across, uint courses, float joint, vec3 block,
                       vec3 mortar, uint seed);

/// Veined marble.
uint addMarbleTexture(Scene& scene, vec3 ground, vec3 veins, uint seed);

/// A woven cloth with a border and small ornaments in a second colour.
uint addClothTexture(Scene& scene, vec3 cloth, vec3 ornament);

/// One leaf, stem at the bottom, tip at the top; alpha 0 around it. Clamped.
uint addLeafTexture(Scene& scene);

} // namespace hone

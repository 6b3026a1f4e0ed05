// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/scene/scene.h"

#include <span>
#include <vector>

namespace hone {

/// The number of mip levels down to one texel. extent: at least 1 x 1.
[[nodiscard]] uint mipLevels(uvec2 extent);

/// An image's texels with all its mip levels, one after another, in the layout of Texture. Each
/// level halves the sides, max(1, n / 2); colours are averaged in linear light, weighted by alpha,
/// so that holes lend no colour to what is around them; the base level keeps its codes. rgba: 4
/// bytes a texel, colour sRGB-encoded, alpha linear, rows top down.
[[nodiscard]] std::vector<uint> makeMipmap(uvec2 extent, std::span<const std::uint8_t> rgba);

/// Appends an image with its mip levels to scene.textures and scene.texels and returns the
/// texture's index. wrap: as of Texture.
uint appendTexture(Scene& scene, uvec2 extent, std::span<const std::uint8_t> rgba, uint wrap_u = 0,
                   uint wrap_v = 0);

} // namespace hone

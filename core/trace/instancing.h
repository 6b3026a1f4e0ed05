// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/scene/scene.h"

#include <cstdint>
#include <vector>

namespace hone {

/// Triangles that copies of meshes may add to a flat tree, all meshes together (about 100 bytes
/// each), unless a tracer is told otherwise.
inline constexpr std::size_t kFlattenTriangles = 2'000'000;

/// Whether a tracer can take rays into the instance's space: its map has an inverse within bounds.
[[nodiscard]] bool isInvertible(const Instance& instance);

/// By mesh: 1 if it gets a tree of its own in its own space, placed by instances; 0 if its copies
/// stand in the world in one flat tree, which is fastest and rounds as shading does. The meshes
/// whose copies add least are flattened as long as all of them together add at most
/// `flatten_triangles`; a mesh with an instance that has no inverse always is.
[[nodiscard]] std::vector<std::uint8_t> chooseInstanced(const Scene& scene,
                                                        std::size_t flatten_triangles);

} // namespace hone

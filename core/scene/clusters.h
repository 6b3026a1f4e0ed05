// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/scene/scene.h"

namespace hone {

/// Cuts every mesh into clusters of at most kClusterTriangles neighbouring triangles that face
/// similar ways, and reorders each mesh's triangles so that a cluster's are consecutive.
///
/// Replaces scene.clusters and the meshes' first_cluster and cluster_count; each triangle keeps its
/// corners in their order. Deterministic. Expects triangle ranges and indices that are valid and do
/// not overlap between meshes, and finite positions. The faces are those of counter-clockwise
/// winding; a cluster's sphere holds all its corners.
void buildClusters(Scene& scene);

inline constexpr std::size_t kClusterTriangles = 128;

} // namespace hone

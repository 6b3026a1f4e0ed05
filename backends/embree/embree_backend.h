// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/trace/instancing.h"
#include "hone/core/trace/trace_backend.h"

namespace hone {

struct EmbreeParams {
    /// Triangles that copies of meshes may add to the flat tree, all meshes together (about 100
    /// bytes each). Meshes beyond it, those whose copies add most, get a tree of their own and are
    /// instanced: less memory, slower.
    std::size_t flatten_triangles = kFlattenTriangles;
};

/// Embree (3 or 4, whichever it was built with) on all cores.
///
/// Closest hits of equal t are settled by (instance, primitive). Each ray of an incoherent or exact
/// list is answered as if it were alone. Coherent lists are traced in packets of 16, where a ray
/// that meets a triangle's edge within rounding may be answered differently next to other rays: of
/// closest hits on Sponza's camera rays none was, of shadow rays aimed exactly at edges 0.2 %.
///
/// Reads the scene's own triangles, and its positions where nothing is moved: of the scene nothing
/// is copied. Instances that move leave the tree that was built for one of moved things, which is
/// refitted at a small part of a build's cost; once an eighth of the scene left the built tree,
/// that is built anew without it. Throws DeviceError if the library cannot start.
[[nodiscard]] std::unique_ptr<TraceBackend> makeEmbreeBackend();
/// The same with other parameters.
[[nodiscard]] std::unique_ptr<TraceBackend> makeEmbreeBackendWith(const EmbreeParams& params);

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/scene/host_surface.h"
#include "hone/core/scene/scene.h"

#include <cstdint>
#include <vector>

namespace hone {

/// What makes it a matter of rounding whether a ray meets a triangle.
enum class Border : std::uint8_t {
    kNone,    ///< it surely does
    kEdge,    ///< it passes within rounding of an edge
    kGrazing, ///< it sees the triangle edge on, as thin as rounding: which face, too, is in doubt
    kRange,   ///< it begins or ends within rounding of the triangle
    kMask,    ///< it passes within rounding of a hole's border
};

/// A triangle that a ray meets, surely or within rounding.
struct Crossing {
    Hit hit;
    double t = 0;       ///< in lengths of the ray's direction
    double t_error = 0; ///< how far a tracer in single precision may be from t
    Border border = Border::kNone;
    bool is_seen = false; ///< by closest hits: not the back of a single-sided material
};

/// Every triangle of `scene` that `ray` meets in its range, in double precision from the corners
/// that worldPosition() gives: surely, or within what single precision may round.
///
/// Rounding moves a ray against a triangle by at most 32 steps of a float as large as the numbers
/// that go into it: the ray's origin, on its way to an instance's own space and back, and the
/// corners' products with the instance's matrix. That covers tracers that intersect in the world
/// and in an instance's own space.
///
/// Reads clusters to skip what is far, so it takes about a millisecond in ten million triangles.
[[nodiscard]] std::vector<Crossing> findCrossings(const Scene& scene, const HostSurface& surface,
                                                  const Ray& ray);

} // namespace hone

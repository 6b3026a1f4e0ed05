// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/math.h"
#include "hone/core/parallel_for.h"

#include <array>
#include <vector>

namespace hone {

/// One value a pixel, rows top down. Double, as FLIP takes the square root of differences of edges:
/// what floats round, 1e-8 where there is no edge, would be seen.
using Plane = std::vector<double>;

/// Calls body(index) for [0, count) on many threads.
template <class Body>
void forEachIndex(ParallelFor parallel_for, std::size_t count, const Body& body) {
    parallel_for(
        count, 16,
        [](void* context, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                (*static_cast<const Body*>(context))(i);
        },
        const_cast<Body*>(&body)); // called, not changed
}

/// Weights along each axis, an odd number; the middle one is the pixel's own.
struct SeparableFilter {
    std::vector<double> across, down;
};

/// The sum of its parts.
using Filter = std::vector<SeparableFilter>;

/// A plane under a filter; beyond the border lie the border's pixels. Each pixel's sum runs in the
/// same order whatever the threads do. Precondition: at least one pixel.
[[nodiscard]] Plane filtered(const Plane& plane, uvec2 extent, const Filter& filter,
                             ParallelFor parallel_for);

/// FLIP's filters (flip.h). Precondition: 1 <= pixels_per_degree <= 1000.
///
/// How the eye blurs luminance, red-green and blue-yellow: contrast sensitivities as Gaussians,
/// each sum is 1.
[[nodiscard]] std::array<Filter, 3> sensitivityFilters(double pixels_per_degree);
/// First and second derivatives of a Gaussian as wide as what the eye takes for an edge or a point,
/// along x and along y: positive weights sum to 1, negative ones to -1.
[[nodiscard]] std::array<Filter, 2> edgeFilters(double pixels_per_degree);
[[nodiscard]] std::array<Filter, 2> pointFilters(double pixels_per_degree);

} // namespace hone

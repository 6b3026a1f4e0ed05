// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/math.h"

#include <cstdint>
#include <span>
#include <vector>

namespace hone {

/// Grows the pixels of a mask, each by a radius of its own, on all cores and in time linear in the
/// number of pixels, however large the radii. The result is exact: what trying every pair of pixels
/// would find. Keeps scratch memory between calls.
class Dilation {
public:
    /// Sets grown[p] to 1 where a pixel q with radius[q] >= 0 has |p.x - q.x| <= radius[q] and
    /// |p.y - q.y| <= radius[q], else to 0. Both have a pixel each, row by row; radii below 32768.
    /// A difference array and prefix sums along both axes.
    void squares(uvec2 extent, std::span<const int> radius, std::span<std::uint8_t> grown);
    /// The same for discs: |p - q|^2 <= radius[q]^2. Squared distances less squared radii by lower
    /// envelopes of parabolas, along rows and then columns: Felzenszwalb and Huttenlocher, Distance
    /// Transforms of Sampled Functions, 2012.
    void discs(uvec2 extent, std::span<const int> radius, std::span<std::uint8_t> grown);

private:
    std::vector<int> sums_;             // squares: one more column and row than the image
    std::vector<int> by_column_;        // discs: what rows found, column after column
    std::vector<int> centers_, begins_; // of an envelope's parabolas; each row or column its part
};

} // namespace hone

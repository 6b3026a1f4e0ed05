// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/math.h"

#include <vector>

namespace hone {

/// How far each pixel is from the nearest one that is 0 in `squared`: exact and linear in the
/// number of pixels.
///
/// squared: width * height, rows top down; 0 for the set's pixels, any greater number for the
/// others. It is overwritten by the squared distance in pixels; infinity where the set is empty.
/// Felzenszwalb, Huttenlocher, Distance Transforms of Sampled Functions, 2012: lower envelopes of
/// parabolas, along columns, then along rows.
void squaredDistances(uvec2 extent, std::vector<float>& squared);

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/math.h"

namespace hone::cli {

/// A dark-to-bright scale for planes that are not colours: black, violet, red, orange, pale yellow.
/// Luminance rises evenly, so it reads in grey and for colour-blind eyes. `x` in [0,1]; NaN is
/// green. Returns display values.
[[nodiscard]] vec3 heatColor(float x);

/// A colour of its own for each number; 0 is black.
[[nodiscard]] vec3 idColor(uint id);

} // namespace hone::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/pass/pass_type.h"

namespace hone::cli {

/// bench.visibility: what the raster pass does before it shades: which triangle each pixel sees.
[[nodiscard]] PassType benchVisibilityPass();

/// bench.depth_only: the least that a rasteriser can do with the same triangles: one indexed draw
/// of all of them, back faces culled, depth only.
[[nodiscard]] PassType benchDepthOnlyPass();

/// bench.noise: errors with a little noise, so that they are all different: what sorts slowest.
[[nodiscard]] PassType benchNoisePass();

} // namespace hone::cli

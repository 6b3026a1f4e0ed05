// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/trace/bvh.h"

namespace hone {

/// A BvhBuilder on one thread: splits by the surface area heuristic in bins of the boxes' centres
/// (Wald, On fast Construction of SAH-based Bounding Volume Hierarchies, 2007), in
/// O(n log n), and cuts no box.
[[nodiscard]] Bvh buildBinnedBvh(const BvhInput& input);

} // namespace hone

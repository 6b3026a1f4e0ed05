// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/trace/bvh.h"

namespace hone {

/// A BvhBuilder on all cores: Embree's own builder of high quality, which cuts boxes of triangles
/// where that pays (Stich et al., Spatial Splits in Bounding Volume Hierarchies, 2009).
[[nodiscard]] Bvh buildEmbreeBvh(const BvhInput& input);

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/pass/pass_type.h"

namespace hone {

// Each in its folder; the manual page is the top comment of its .cpp.
[[nodiscard]] PassType accumulatePass();
[[nodiscard]] PassType blendPass();
[[nodiscard]] PassType cab10ErrorPass();
[[nodiscard]] PassType ckc03WeightPass();
[[nodiscard]] PassType combinePass();
[[nodiscard]] PassType depthOfFieldPass();
[[nodiscard]] PassType dofErrorPass();
[[nodiscard]] PassType environmentProbePass();
[[nodiscard]] PassType estimatePass();
[[nodiscard]] PassType kbm10ErrorPass();
[[nodiscard]] PassType measureErrorPass();
[[nodiscard]] PassType propagateErrorPass();
[[nodiscard]] PassType rasterPass();
[[nodiscard]] PassType reflectionErrorPass();
[[nodiscard]] PassType requestPass();
[[nodiscard]] PassType screenOcclusionPass();
[[nodiscard]] PassType selfOcclusionPass();
[[nodiscard]] PassType shadowErrorPass();
[[nodiscard]] PassType shadowMapPass();
[[nodiscard]] PassType shadowRangePass();
[[nodiscard]] PassType sortPass();
[[nodiscard]] PassType tonemapPass();
[[nodiscard]] PassType tracePass();
[[nodiscard]] PassType ypg01WeightPass();

/// Adds every pass that hone ships.
void registerPasses(PassRegistry& registry);

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/pass/pass_type.h"

namespace hone {

// Each in its folder; the manual page is the top comment of its .cpp.
[[nodiscard]] PassType environmentProbePass();
[[nodiscard]] PassType rasterPass();
[[nodiscard]] PassType reflectionErrorPass();
[[nodiscard]] PassType selfOcclusionPass();
[[nodiscard]] PassType shadowErrorPass();
[[nodiscard]] PassType shadowMapPass();

/// Adds every pass that hone ships.
void registerPasses(PassRegistry& registry);

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/passes.h"

namespace hone {

void registerPasses(PassRegistry& registry) {
    registry.add(environmentProbePass());
    registry.add(rasterPass());
    registry.add(reflectionErrorPass());
    registry.add(selfOcclusionPass());
    registry.add(shadowErrorPass());
    registry.add(shadowMapPass());
}

} // namespace hone

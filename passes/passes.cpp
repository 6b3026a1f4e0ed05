// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/passes.h"

namespace hone {

void registerPasses(PassRegistry& registry) {
    registry.add(accumulatePass());
    registry.add(blendPass());
    registry.add(cab10ErrorPass());
    registry.add(ckc03WeightPass());
    registry.add(combinePass());
    registry.add(depthOfFieldPass());
    registry.add(dofErrorPass());
    registry.add(environmentProbePass());
    registry.add(estimatePass());
    registry.add(kbm10ErrorPass());
    registry.add(measureErrorPass());
    registry.add(propagateErrorPass());
    registry.add(rasterPass());
    registry.add(reflectionErrorPass());
    registry.add(requestPass());
    registry.add(screenOcclusionPass());
    registry.add(selfOcclusionPass());
    registry.add(shadowErrorPass());
    registry.add(shadowMapPass());
    registry.add(shadowRangePass());
    registry.add(sortPass());
    registry.add(tonemapPass());
    registry.add(tracePass());
    registry.add(ypg01WeightPass());
}

} // namespace hone

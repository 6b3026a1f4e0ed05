// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/backends.h"

#include "hone/backends/brute/brute_backend.h"
#include "hone/backends/embree/embree_backend.h"

namespace hone {

void registerTraceBackends(TraceBackendRegistry& registry) {
    registry.add("embree", "Embree on all cores",
                 [](const Devices&) { return makeEmbreeBackend(); });
    registry.add("brute", "every ray against every triangle: the reference, for tiny scenes",
                 [](const Devices&) { return makeBruteBackend(); });
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/trace/trace_backend.h"

#include <memory>
#include <span>

namespace hone {

/// Embree with nothing around it: packets of 16 over one flat tree, no filter, no look at the rays.
/// The speed that EmbreeBackend is held against; no tracer, because its answers are not the ones
/// that TraceBackend promises (back faces are seen, holes of masks are solid, equal distances are
/// settled by chance).
///
/// All rays must be finite, with a direction that is not zero and 0 <= tmin <= tmax: Embree aborts
/// on some others.
class BareEmbree {
public:
    /// Builds with spatial splits, as EmbreeBackend does. Borrows nothing. Throws DeviceError.
    explicit BareEmbree(const Scene& scene);
    ~BareEmbree();
    BareEmbree(const BareEmbree&) = delete;
    BareEmbree& operator=(const BareEmbree&) = delete;

    /// hits[i] answers rays[i], on all cores. kCoherent sets Embree's flag for coherent packets.
    void closest(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence) const;
    /// occluded[i] = 1 or 0 for rays[i], on all cores.
    void occluded(std::span<const Ray> rays, std::span<uint> occluded, Coherence coherence) const;

private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

} // namespace hone

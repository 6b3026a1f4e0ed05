// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/pass/pass.h"

#include <vector>

namespace hone {

/// What a camera sees, asked of a tracer instead of a rasteriser. Keeps its lists between calls.
class CastHits {
public:
    /// Writes (instance, primitive) of each pixel of the frame to `hits`, a Hit each, kNone where
    /// nothing is. For the host at once. Rays go in tile order, as pass trace asks them.
    void cast(PassContext& context, const Camera& camera, const TraceBackend& backend,
              BufferView hits);

private:
    Buffer rays_, answers_;
};

} // namespace hone

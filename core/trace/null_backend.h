// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/trace/trace_backend.h"

namespace hone {

/// Sees nothing and is never occluded, whatever the scene, which it does not touch: what a graph
/// costs without its rays, and for tests of wiring.
[[nodiscard]] std::unique_ptr<TraceBackend> makeNullBackend();

} // namespace hone

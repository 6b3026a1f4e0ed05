// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/trace/trace_backend.h"

namespace hone {

/// The reference: every ray against every triangle, in the plainest arithmetic. For tests and tiny
/// scenes.
[[nodiscard]] std::unique_ptr<TraceBackend> makeBruteBackend();

} // namespace hone

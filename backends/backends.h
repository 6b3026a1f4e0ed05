// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/trace/trace_backend.h"

namespace hone {

/// Adds every trace backend that hone ships, in the order of preference.
void registerTraceBackends(TraceBackendRegistry& registry);

} // namespace hone

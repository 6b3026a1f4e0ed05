// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/plugin/plugin_library.h"
#include "hone/core/trace/trace_backend.h"

#include <memory>

namespace hone {

/// A trace backend of a plug-in. What its functions report becomes an exception that names the
/// plug-in: DeviceError and OutOfMemory where they say so, else PluginError; so does an exception
/// that crosses the border, and an answer that names nothing in the scene (shading would read
/// outside its arrays).
[[nodiscard]] std::unique_ptr<TraceBackend>
makePluginBackend(std::shared_ptr<const PluginLibrary> library, std::size_t index);

} // namespace hone

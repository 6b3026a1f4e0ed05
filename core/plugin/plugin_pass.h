// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/plugin/plugin_library.h"

#include <memory>

namespace hone {

/// A pass type of a plug-in as graphs use it; keeps the library. What its functions report becomes
/// an exception that names plug-in, node and type: DeviceError and OutOfMemory where they say so,
/// else PluginError; so does an exception that crosses the border, and an output that hone's passes
/// could not trust (plugin_output.h). Runs on the host.
[[nodiscard]] PassType makePluginPassType(std::shared_ptr<const PluginLibrary> library,
                                          std::size_t index);

} // namespace hone

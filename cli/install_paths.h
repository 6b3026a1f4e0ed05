// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace hone::cli {

// Where `cmake --install` put things, found from where this program stands, so that an installed
// tree may be moved.

/// The folder of hone's graphs: the source tree's where this is no installed program.
[[nodiscard]] std::filesystem::path shippedGraphs();
/// The folder that is looked into for plug-ins; empty where this is no installed program.
[[nodiscard]] std::filesystem::path installedPlugins();

} // namespace hone::cli

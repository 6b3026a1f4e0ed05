// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace hone::cli {

/// Where `cmake --install` put hone's graphs and looks for plug-ins, found from where this program
/// stands, so that an installed tree may be moved. Empty where it is no installed program.
[[nodiscard]] std::filesystem::path installedGraphs();
[[nodiscard]] std::filesystem::path installedPlugins();

} // namespace hone::cli

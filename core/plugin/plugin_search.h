// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/plugin/plugin.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace hone {

/// Where plug-ins come from, in the order in which they are loaded.
struct PluginSearch {
    /// Named by the person: each must load.
    std::vector<std::filesystem::path> files{};
    /// Searched for *.so, by name; not below. What does not load is left out, and a problem says
    /// so. Absolute; never the working directory, and never one that anybody may write to.
    std::vector<std::filesystem::path> folders{};
};

/// The folders of a variable like HONE_PLUGIN_PATH, which separates them by colons. Parts that are
/// no absolute path are left out, and a problem says so: what they name depends on where a program
/// is started.
[[nodiscard]] std::vector<std::filesystem::path>
foldersOfVariable(std::string_view name, std::string_view value,
                  std::vector<std::string>& problems);

/// Loads plug-ins and adds their passes and trace backends; a file that is met twice is loaded
/// once, and of the plug-ins, passes or backends of one name the first stays. Returns those that
/// are in use.
///
/// Throws PluginError where a named file does not load, or has the name of another. `problems`:
/// each text says which plug-in was found and left out, and why.
[[nodiscard]] std::vector<Plugin> loadPlugins(const PluginSearch& search, PassRegistry& passes,
                                              TraceBackendRegistry& backends,
                                              ParallelFor parallel_for,
                                              std::vector<std::string>& problems);

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/install_paths.h"

namespace hone::cli {
namespace {

namespace fs = std::filesystem;

/// A folder that is given relative to the one that this program is in, if it is there.
fs::path besideProgram(const char* relative) {
    std::error_code error;
    const fs::path program = fs::canonical("/proc/self/exe", error);
    if (error)
        return {};
    const fs::path folder = fs::canonical(program.parent_path() / relative, error);
    return !error && fs::is_directory(folder, error) ? folder : fs::path();
}

} // namespace

fs::path shippedGraphs() {
    const fs::path installed = besideProgram(HONE_GRAPHS_FROM_BIN);
    return installed.empty() ? fs::path(HONE_SOURCE_DIR) / "graphs" : installed;
}

fs::path installedPlugins() {
    return besideProgram(HONE_PLUGINS_FROM_BIN);
}

} // namespace hone::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace hone::cli {

/// Lays out a drawing with Graphviz' program dot. `format`: "svg", "png", "pdf". Throws OutputError
/// where the program is not installed or fails, with what it said.
[[nodiscard]] std::string runDot(const std::string& drawing, const std::string& format);

} // namespace hone::cli

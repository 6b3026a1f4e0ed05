// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/cli/commands.h"

#include <string_view>

namespace hone::cli {

/// Is this meant to be a diagnostic's code: "E0301", "e301", "W801"?
[[nodiscard]] bool looksLikeCode(std::string_view text);
/// Prints what a code means; a list of all for "". Unknown codes: the nearest ones, exit 2.
int explainCode(const std::string& code, bool json, const Console& console);

} // namespace hone::cli

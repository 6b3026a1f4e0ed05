// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/device/memory_copy.h"

#include <nlohmann/json_fwd.hpp>

#include <iosfwd>
#include <span>

namespace hone::cli {

/// An array of {what, bytes, why, cure}.
[[nodiscard]] nlohmann::ordered_json copiesAsJson(std::span<const MemoryCopy> copies);

/// Whether there are at most so many (negative: any number); if not, says which there are, why, and
/// what would avoid each.
[[nodiscard]] bool areCopiesAllowed(std::span<const MemoryCopy> copies, long long most,
                                    std::ostream& err);

} // namespace hone::cli

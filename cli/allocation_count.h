// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace hone::cli {

/// Calls of operator new in this program so far, on all threads. Linking this in replaces operator
/// new by one that counts.
[[nodiscard]] std::uint64_t allocationCount();

} // namespace hone::cli

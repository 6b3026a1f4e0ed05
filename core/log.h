// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <spdlog/logger.h>

#include <memory>

namespace hone {

/// The library's logger: silent below `warn` until the application says otherwise, writes to
/// standard error, and is registered nowhere. Levels: trace per pass and frame; debug compile
/// results and allocations; info once per device or graph; warn works, but worse, saying what would
/// cure it. Errors are exceptions, never logged.
spdlog::logger& logger();

/// Replaces the logger (an embedding application's own sink). Not thread-safe: call before anything
/// else.
void setLogger(std::unique_ptr<spdlog::logger> replacement);

} // namespace hone

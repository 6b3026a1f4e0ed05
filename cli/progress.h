// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/pass/value.h"

#include <chrono>
#include <iosfwd>

namespace hone::cli {

/// One line on a terminal that follows a refinement: share of the pixels, rays, rays a second, time
/// left. At most ten times a second; silent where standard error is no terminal.
class Progress {
public:
    Progress(std::ostream& err, bool enabled, std::uint64_t total_pixels);
    ~Progress(); ///< clears the line
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    void show(const LoopRecord& record);

private:
    std::ostream& err_;
    bool enabled_;
    bool shown_ = false;
    std::uint64_t total_pixels_;
    std::chrono::steady_clock::time_point next_;
};

/// "1.2 M", "34 k", "817".
[[nodiscard]] std::string shortNumber(double number);

} // namespace hone::cli

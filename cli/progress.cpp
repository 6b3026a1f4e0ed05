// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/progress.h"

#include <algorithm>
#include <cstdio>
#include <ostream>
#include <string>

namespace hone::cli {

std::string shortNumber(double number) {
    char text[32];
    if (number >= 1e6)
        std::snprintf(text, sizeof text, "%.1f M", number / 1e6);
    else if (number >= 1e3)
        std::snprintf(text, sizeof text, "%.1f k", number / 1e3);
    else
        std::snprintf(text, sizeof text, "%.0f", number);
    return text;
}

Progress::Progress(std::ostream& err, bool enabled, std::uint64_t total_pixels)
    : err_(err), enabled_(enabled), total_pixels_(total_pixels) {}

Progress::~Progress() {
    if (shown_)
        err_ << "\r\033[K" << std::flush;
}

void Progress::show(const LoopRecord& record) {
    const auto now = std::chrono::steady_clock::now();
    if (!enabled_ || now < next_)
        return;
    next_ = now + std::chrono::milliseconds(100);
    shown_ = true;
    const double share =
        std::min(1.0, static_cast<double>(record.pixels) /
                          static_cast<double>(std::max<std::uint64_t>(1, total_pixels_)));
    const double left_s = share > 0 ? record.ms / 1000 * (1 - share) / share : 0;
    char text[160];
    std::snprintf(
        text, sizeof text,
        "\r\033[Krefining %3.0f %% · worst error %.3g · %srays · %sray/s · %.1f s left",
        100 * share, static_cast<double>(record.worst_expect),
        (shortNumber(static_cast<double>(record.rays)) + " ").c_str(),
        (shortNumber(record.ms > 0 ? static_cast<double>(record.rays) / record.ms * 1000 : 0) + " ")
            .c_str(),
        left_s);
    err_ << text << std::flush;
}

} // namespace hone::cli

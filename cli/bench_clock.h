// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <span>
#include <vector>

namespace hone::cli {

/// Milliseconds that `work` took. Does not allocate.
template <class Work> [[nodiscard]] double elapsedMs(const Work& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
        .count();
}

/// Runs the contenders in turn, `repeats` rounds after one that does not count, so that a machine
/// that slows down slows all of them. Returns the milliseconds by contender and round.
[[nodiscard]] std::vector<std::vector<double>>
interleave(int repeats, std::span<const std::function<void()>> contenders);

/// Of the values, none of which may be NaN; 0 for none.
[[nodiscard]] double median(std::vector<double> values);

/// The median over rounds of a[round] / b[round]: what is measured side by side is compared side by
/// side.
[[nodiscard]] double medianRatio(std::span<const double> a, std::span<const double> b);

} // namespace hone::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>

namespace hone {

/// When long work shall give up: once another thread or a signal handler set a flag, or at a time.
/// Work asks between steps of some ten milliseconds, so that who waits for it has control back
/// within 250 ms.
struct Interrupt {
    using Clock = std::chrono::steady_clock;

    const std::atomic<bool>* cancel = nullptr; ///< null: nobody cancels
    Clock::time_point deadline = Clock::time_point::max();

    [[nodiscard]] bool isCancelled() const { return cancel != nullptr && cancel->load(); }
    [[nodiscard]] bool isDue() const {
        return isCancelled() || (deadline != Clock::time_point::max() && Clock::now() >= deadline);
    }
};

/// So many milliseconds after `begin`; never if 0 or more than a clock can tell.
[[nodiscard]] inline Interrupt::Clock::time_point deadlineAfter(Interrupt::Clock::time_point begin,
                                                                double ms) {
    constexpr double kCentury = 100 * 365.25 * 24 * 3600 * 1000;
    if (!(ms > 0 && ms < kCentury))
        return Interrupt::Clock::time_point::max();
    return begin + std::chrono::duration_cast<Interrupt::Clock::duration>(
                       std::chrono::duration<double, std::milli>(ms));
}

/// What a pass throws to give up because its Interrupt is due. No error: whoever set the limit
/// knows.
struct Interrupted {};

} // namespace hone

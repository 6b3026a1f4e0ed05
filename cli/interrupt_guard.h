// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <stdexcept>

namespace hone::cli {

/// Turns SIGINT and SIGTERM into a request to stop while it lives.
class InterruptGuard {
public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;
    /// 0, or the exit code of the signal that came (130, 143).
    [[nodiscard]] static int requested();
    /// Whether a signal came, for RunOptions::cancel.
    [[nodiscard]] static const std::atomic<bool>* flag();
};

/// A command that was asked to stop and has no result yet. Text: what it was about. Exit code:
/// InterruptGuard::requested() when it was thrown.
struct Interrupted : std::runtime_error {
    explicit Interrupted(const std::string& what);
    int code;
};

} // namespace hone::cli

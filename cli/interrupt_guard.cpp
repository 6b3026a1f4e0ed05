// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/interrupt_guard.h"

#include <csignal>

namespace hone::cli {
namespace {

// What a signal handler may touch.
std::atomic<int> interrupt_signal = 0;
std::atomic<bool> is_interrupted = false;
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);
using Handler = void (*)(int);
Handler previous_int = SIG_DFL;
Handler previous_term = SIG_DFL;

void remember(int signal) {
    interrupt_signal = signal;
    is_interrupted = true;
}

} // namespace

InterruptGuard::InterruptGuard() {
    interrupt_signal = 0;
    is_interrupted = false;
    previous_int = std::signal(SIGINT, remember);
    previous_term = std::signal(SIGTERM, remember);
}

InterruptGuard::~InterruptGuard() {
    std::signal(SIGINT, previous_int);
    std::signal(SIGTERM, previous_term);
}

int InterruptGuard::requested() {
    return interrupt_signal == 0 ? 0 : 128 + interrupt_signal;
}

const std::atomic<bool>* InterruptGuard::flag() {
    return &is_interrupted;
}

Interrupted::Interrupted(const std::string& what)
    : std::runtime_error(what), code(InterruptGuard::requested()) {}

} // namespace hone::cli

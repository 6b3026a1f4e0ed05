// SPDX-License-Identifier: Apache-2.0
#include "hone/core/trace/trace_task.h"

#include <algorithm>
#include <chrono>

namespace hone {
namespace {

/// The part of the list that the budget pays for.
template <class Answer>
TraceQuery<Answer> within(const TraceBudget& budget, TraceQuery<Answer> query) {
    if (budget.max_rays == 0)
        return query;
    constexpr std::size_t kGrain = TraceSlices::kGrain;
    const std::size_t left = (query.rays.size() - query.answered + kGrain - 1) / kGrain;
    const std::size_t paid = (budget.max_rays - 1) / kGrain + 1;
    const std::size_t end =
        std::min(query.rays.size(), query.answered + std::min(left, paid) * kGrain);
    query.rays = query.rays.first(end);
    query.answers = query.answers.first(end);
    return query;
}

} // namespace

TraceTask::TraceTask(const TraceBackend& backend, const ClosestQuery& query,
                     const TraceBudget& budget)
    : answered_(query.answered),
      thread_([&backend, query, budget, this] { run(backend, within(budget, query), budget); }) {}

TraceTask::TraceTask(const TraceBackend& backend, const OccludedQuery& query,
                     const TraceBudget& budget)
    : answered_(query.answered),
      thread_([&backend, query, budget, this] { run(backend, within(budget, query), budget); }) {}

TraceTask::~TraceTask() {
    cancel();
    if (thread_.joinable())
        thread_.join();
}

std::size_t TraceTask::wait() {
    if (thread_.joinable())
        thread_.join();
    if (failure_)
        std::rethrow_exception(failure_);
    return progress();
}

template <class Answer>
void TraceTask::run(const TraceBackend& backend, TraceQuery<Answer> query,
                    const TraceBudget& budget) {
    const Interrupt interrupt{&is_cancelled_,
                              deadlineAfter(Interrupt::Clock::now(), budget.max_ms)};
    TraceSlices slices;
    try {
        while (!interrupt.isDue() && slices.step(backend, query))
            answered_ = query.answered;
        answered_ = query.answered;
    } catch (...) {
        failure_ = std::current_exception();
    }
    is_done_ = true;
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/trace/trace_slices.h"

#include <atomic>
#include <cstdint>
#include <exception>
#include <thread>

namespace hone {

/// What a query may cost; zero is no limit. Looked at between slices.
struct TraceBudget {
    /// Rounded up to a multiple of TraceSlices::kGrain, so that packets are those of the whole
    /// list.
    std::uint64_t max_rays = 0;
    double max_ms = 0; ///< since the task began
};

/// A query that runs on a thread of its own, on any backend: it tells its progress and can be
/// cancelled. After cancel() or the end of its budget it is done within 250 ms (one slice; the
/// backend's own threads work on while it lasts).
///
/// Until it is done nobody else may ask the backend, read answers beyond progress(), or change rays
/// or scene. Meanwhile the devices may work on other things only if the backend runs on the host
/// (TraceCaps::runs_on, TraceMemory::kHost): a backend on a device uses its one encoder.
class TraceTask {
public:
    /// Starts at once, from query.answered on. Borrows the backend and both lists.
    TraceTask(const TraceBackend& backend, const ClosestQuery& query,
              const TraceBudget& budget = {});
    TraceTask(const TraceBackend& backend, const OccludedQuery& query,
              const TraceBudget& budget = {});
    ~TraceTask(); ///< cancels and waits
    TraceTask(const TraceTask&) = delete;
    TraceTask& operator=(const TraceTask&) = delete;

    /// How many rays are answered, from the first on: their answers may be read already.
    [[nodiscard]] std::size_t progress() const { return answered_; }
    [[nodiscard]] bool isDone() const { return is_done_; }
    void cancel() { is_cancelled_ = true; }
    /// Waits until the task is done; returns progress(). Throws what the backend threw, each time
    /// it is called.
    std::size_t wait();

private:
    template <class Answer>
    void run(const TraceBackend& backend, TraceQuery<Answer> query, const TraceBudget& budget);

    std::atomic<std::size_t> answered_;
    std::atomic<bool> is_cancelled_ = false;
    std::atomic<bool> is_done_ = false;
    std::exception_ptr failure_; ///< written before is_done_
    std::thread thread_;         ///< last: it uses the others
};

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/trace/trace_slices.h"

#include "hone/core/error.h"

#include <algorithm>
#include <chrono>
#include <type_traits>

namespace hone {
namespace {

void ask(const TraceBackend& backend, std::span<const Ray> rays, std::span<Hit> hits,
         const ClosestQuery& query) {
    backend.closest(rays, hits, query.coherence, query.options);
}

void ask(const TraceBackend& backend, std::span<const Ray> rays, std::span<uint> occluded,
         const OccludedQuery& query) {
    backend.occluded(rays, occluded, query.coherence, query.options);
}

/// The length that the next slice should have after `rays` rays took `ms`.
std::size_t nextLength(std::size_t length, std::size_t rays, double ms) {
    // The end of a list says little about a whole slice, unless it was too slow already.
    if (rays < length && ms < TraceSlices::kSliceMs)
        return length;
    constexpr double kGrowth =
        8; // a careful step, because the first rays may have been the easy ones
    const double wanted =
        static_cast<double>(rays) * std::min(kGrowth, TraceSlices::kSliceMs / std::max(ms, 1e-6));
    return std::max(static_cast<std::size_t>(wanted) / TraceSlices::kGrain, std::size_t{1}) *
           TraceSlices::kGrain;
}

} // namespace

template <class Answer>
bool TraceSlices::step(const TraceBackend& backend, TraceQuery<Answer>& query) {
    HONE_ASSERT(query.rays.size() == query.answers.size(), "one answer a ray");
    if (query.answered == query.rays.size())
        return false;
    if (&backend != backend_) {
        backend_ = &backend;
        lengths_.fill(kFirstSlice);
    }
    std::size_t& length = lengths_[2 * std::is_same_v<Answer, uint> +
                                   (query.coherence == Coherence::kCoherent ? 1u : 0u)];
    const std::size_t rays = std::min(length, query.rays.size() - query.answered);
    const auto begin = std::chrono::steady_clock::now();
    ask(backend, query.rays.subspan(query.answered, rays),
        query.answers.subspan(query.answered, rays), query);
    const std::chrono::duration<double, std::milli> passed =
        std::chrono::steady_clock::now() - begin;
    query.answered += rays;
    length = nextLength(length, rays, passed.count());
    return query.answered < query.rays.size();
}

template <class Answer>
bool TraceSlices::answer(const TraceBackend& backend, TraceQuery<Answer>& query,
                         const Interrupt& interrupt) {
    while (step(backend, query))
        if (interrupt.isDue())
            return false;
    return true;
}

template bool TraceSlices::step(const TraceBackend&, ClosestQuery&);
template bool TraceSlices::step(const TraceBackend&, OccludedQuery&);
template bool TraceSlices::answer(const TraceBackend&, ClosestQuery&, const Interrupt&);
template bool TraceSlices::answer(const TraceBackend&, OccludedQuery&, const Interrupt&);

} // namespace hone

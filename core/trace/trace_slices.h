// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/interrupt.h"
#include "hone/core/trace/trace_backend.h"

#include <array>
#include <cstddef>
#include <span>

namespace hone {

/// A list of rays and how far it is answered. Borrows both lists, of equal size.
template <class Answer> struct TraceQuery {
    std::span<const Ray> rays;
    std::span<Answer> answers;
    Coherence coherence = Coherence::kIncoherent;
    TraceOptions options{};
    std::size_t answered = 0; ///< rays [0, answered) have their answers, the others none yet
};
using ClosestQuery = TraceQuery<Hit>;
using OccludedQuery = TraceQuery<uint>; ///< 1 or 0

/// Asks trace backends for long lists slice by slice, so that the asker has control back soon, on
/// every backend and without its help.
///
/// A slice takes about kSliceMs at the rate of the last one of its kind, so fast backends get long
/// lists whole. Slices begin at multiples of kGrain, so the same rays meet in a packet: slicing
/// never changes an answer. Keeps the rates between queries; allocates nothing.
class TraceSlices {
public:
    /// A multiple of every backend's packets.
    static constexpr std::size_t kGrain = 64;
    /// Rates differ tenfold within a list, and 250 ms is too late.
    static constexpr double kSliceMs = 25;
    /// Until a backend's rate is known: short for the slowest, soon outgrown by the others.
    static constexpr std::size_t kFirstSlice = 4 * kGrain;

    /// Answers the next slice, if rays are left. Returns whether there are more.
    template <class Answer> bool step(const TraceBackend& backend, TraceQuery<Answer>& query);

    /// Takes steps, at least one, until every ray is answered or `interrupt` is due. Returns
    /// whether every ray is answered.
    template <class Answer>
    bool answer(const TraceBackend& backend, TraceQuery<Answer>& query, const Interrupt& interrupt);

private:
    const TraceBackend* backend_ = nullptr; ///< whose rates these are
    std::array<std::size_t, 4> lengths_{};  ///< rays of the next slice, by kind of query
};

} // namespace hone

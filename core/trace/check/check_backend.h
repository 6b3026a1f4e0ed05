// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/trace/check/query_kind.h"

#include <cstdint>
#include <memory>

namespace hone {

/// What checks found in queries of one kind; differences are those between the two backends.
struct CheckCounts : DifferenceCounts {
    std::uint64_t lists = 0;
    std::uint64_t rays = 0;
    std::uint64_t judged = 0; ///< answers held against the geometry
};

/// What checks found since it was made.
struct CheckReport {
    CheckCounts closest, occluded;
    std::uint64_t spoiled_rays = 0; ///< with a NaN or infinite origin or direction
};

/// A backend that answers as `first` does and makes sure that it keeps the contract of
/// TraceBackend; with `second` (may be null), also that both answer each ray alike, but for
/// rounding.
///
/// Every list: sizes match, every answer is written and possible. Of every list a few rays: the
/// answer is right by DifferenceExplainer, the same for coherent and incoherent lists with
/// TraceOptions::exact, and the same without where caps say always_exact. build(): caps say that
/// masked materials are honoured where the scene has any. The scene does not change unannounced.
///
/// Adds to `report`, which must outlive it, if that is not null. Throws CheckFailed, which names
/// the first ray that breaks a promise; what it counted is in the report by then.
[[nodiscard]] std::unique_ptr<TraceBackend> makeCheckBackend(std::unique_ptr<TraceBackend> first,
                                                             std::unique_ptr<TraceBackend> second,
                                                             CheckReport* report);

} // namespace hone

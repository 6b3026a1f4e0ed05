// SPDX-License-Identifier: Apache-2.0
//
// What parts are held against when no library has the counterpart.
#pragma once

#include "hone/cli/bench_graph.h"
#include "hone/core/math.h"

#include <cstdint>
#include <span>
#include <vector>

namespace hone::cli {

/// The bare counterpart of a streaming pass: reads so many bytes and writes so many, each once, on
/// all cores.
class StreamLoop {
public:
    explicit StreamLoop(Traffic traffic)
        : source_(traffic.read / 8, 1), target_(traffic.written / 8, 1) {}
    void run();
    [[nodiscard]] double bytes() const {
        return 8.0 * static_cast<double>(source_.size() + target_.size());
    }

private:
    std::vector<std::uint64_t> source_, target_;
};

/// std::sort of all pixels by error descending, then pixel ascending: on 64-bit keys, one thread.
class StandardSort {
public:
    /// Makes the keys of `errors`; not part of what is timed.
    void setErrors(std::span<const vec2> errors);
    /// Copies the keys and sorts the copy.
    void run();

private:
    std::vector<std::uint64_t> keys_, sorted_;
};

/// The shares of std::sort's time that bare loops need (histogram, threshold and compaction in tile
/// order; least-significant-digit radix sort over 8-byte records), both on two threads.
struct SortingShares {
    double select = 0;
    double radix = 0;
};

/// As measured for the size nearest to `size`.
[[nodiscard]] SortingShares bareSortingShares(uvec2 size);

} // namespace hone::cli

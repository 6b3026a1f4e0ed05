// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/image/tile_order.h"
#include "hone/passes/sort/radix_sort.h"

#include <tbb/enumerable_thread_specific.h>

#include <cstdint>
#include <span>
#include <vector>

namespace hone {

/// What a pass over the errors found.
struct ErrorCounts {
    std::size_t listed = 0;       ///< pixels in the order
    std::size_t error_pixels = 0; ///< bound > 0
};

/// Cuts the total order (expect descending, pixel ascending) into batches of `batch` pixels,
/// without sorting them: exact sets, each in tile order. O(pixels), the same result at any thread
/// count. Keeps its scratch memory between calls.
class Selector {
public:
    /// For more batches than this sorting is cheaper.
    static constexpr std::size_t kMaxBatches = 4096;

    /// `errors`: one a pixel of `tiles`' extent. `batch`: at least pixels / kMaxBatches. `order`:
    /// room for every pixel; filled batch after batch.
    ErrorCounts select(const TileOrder& tiles, std::span<const vec2> errors, std::size_t batch,
                       bool flagged_only, std::span<uint> order, RadixSorter& radix);

private:
    /// Bin 0 is for error 0, the most frequent value. The others cut each octave from 2^-24 up in
    /// 2048; the first and the last also hold what lies outside.
    static constexpr uint kBinShift = 12;
    static constexpr uint kFirstBin = ((127u - 24u) << (23 - kBinShift)) - 1;
    static constexpr uint kBins = 0xfffe;
    /// Marks in the plane of bins and batches; above all of both.
    static constexpr std::uint16_t kStraddles = 0xfffe;
    static constexpr std::uint16_t kSkipped = 0xffff;
    static std::uint16_t binOf(uint bits);

    /// A row of tiles: the unit of parallel work, as its pixels are consecutive and its tiles, too.
    struct Row {
        std::size_t begin = 0, end = 0; ///< pixels
        ErrorCounts counts;
        std::size_t zeros = 0;        ///< listed pixels with error 0
        std::vector<uint> straddlers; ///< pixels whose bin lies in more than one batch
    };
    struct Histogram {
        std::vector<uint> bins = std::vector<uint>(kBins);
        uint low = kBins, high = 0; ///< all others are 0
    };
    /// A bin that lies in more than one batch.
    struct Group {
        std::size_t first; ///< of its pixels among all straddlers, sorted
        std::size_t rank;  ///< of its first pixel in the total order
    };

    ErrorCounts findBins(std::span<const vec2> errors, bool flagged_only, bool is_one_batch);
    void countBins(const Row& row, Histogram& histogram) const;
    std::size_t findBatchOfBins(std::size_t batch);
    void findBatchOfPixels(std::size_t batch, std::size_t batches, std::size_t first_zero);
    void placeStraddlers(std::span<const vec2> errors, std::size_t batch, std::size_t batches,
                         RadixSorter& radix);
    void scatter(const TileOrder& tiles, std::size_t batches, std::span<uint> order);

    std::vector<Row> rows_;
    tbb::enumerable_thread_specific<Histogram> histograms_;
    std::vector<std::uint16_t> place_;        ///< by pixel: its bin, then its batch
    std::vector<std::uint16_t> batch_of_bin_; ///< or kStraddles
    std::vector<Group> groups_;
    std::vector<uint> straddlers_, sorted_;
    std::vector<uint> counts_; ///< by row and batch; then where they go in the order
};

} // namespace hone

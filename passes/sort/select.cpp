// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/sort/select.h"

#include "hone/core/error.h"
#include "hone/passes/sort/error_key.h"

#include <tbb/parallel_for.h>

namespace hone {

ErrorCounts Selector::select(const TileOrder& tiles, std::span<const vec2> errors,
                             std::size_t batch, bool flagged_only, std::span<uint> order,
                             RadixSorter& radix) {
    const std::size_t width = tiles.extent().x;
    rows_.resize(tiles.tiles().y);
    for (std::size_t row = 0; row < rows_.size(); ++row) {
        rows_[row].begin = row * TileOrder::kTile * width;
        rows_[row].end = std::min(rows_[row].begin + TileOrder::kTile * width, errors.size());
    }
    place_.resize(std::max(place_.size(), errors.size()));

    const bool is_one_batch = batch >= errors.size();
    const ErrorCounts found = findBins(errors, flagged_only, is_one_batch);
    const std::size_t batches = std::max<std::size_t>((found.listed + batch - 1) / batch, 1);
    HONE_ASSERT(batches <= kMaxBatches, std::to_string(batches));
    counts_.assign(rows_.size() * batches, 0);
    if (is_one_batch) {
        for (std::size_t row = 0; row < rows_.size(); ++row)
            counts_[row] = static_cast<uint>(rows_[row].counts.listed);
    } else {
        findBatchOfPixels(batch, batches, findBatchOfBins(batch));
        placeStraddlers(errors, batch, batches, radix);
    }
    scatter(tiles, batches, order);
    return found;
}

/// Bins grow with the error and are 0 for 0 only.
inline std::uint16_t Selector::binOf(uint bits) {
    const uint bin =
        std::clamp(bits >> kBinShift, kFirstBin + 1, kFirstBin + kBins - 1) - kFirstBin;
    return static_cast<std::uint16_t>(bits == 0 ? 0 : bin);
}

/// Writes each pixel's bin and counts how many pixels each has. One batch needs no bins: then all
/// that is listed is in bin 0.
ErrorCounts Selector::findBins(std::span<const vec2> errors, bool flagged_only, bool is_one_batch) {
    for (Histogram& histogram : histograms_) {
        for (uint bin = histogram.low; bin <= histogram.high; ++bin)
            histogram.bins[bin] = 0;
        histogram.low = kBins;
        histogram.high = 0;
    }
    groups_.clear();

    tbb::parallel_for(std::size_t{0}, rows_.size(), [&](std::size_t row_index) {
        Row& row = rows_[row_index];
        // Without branches, so that it becomes vector code.
        const uint kept = is_one_batch ? 0 : ~0u;
        const bool skips = flagged_only;
        uint errors_here = 0;
        uint zeros = 0;
        for (std::size_t pixel = row.begin; pixel < row.end; ++pixel) {
            const uint is_error = isErrorPixel(errors[pixel]) ? 1 : 0;
            const std::uint16_t bin = binOf(errorBits(errors[pixel].x) & kept);
            const bool is_skipped = skips && is_error == 0;
            errors_here += is_error;
            zeros += !is_skipped && bin == 0 ? 1 : 0;
            place_[pixel] = is_skipped ? kSkipped : bin;
        }
        row.zeros = zeros;
        row.counts = {.listed = skips ? errors_here : row.end - row.begin,
                      .error_pixels = errors_here};
        if (!is_one_batch)
            countBins(row, histograms_.local());
    });

    ErrorCounts total;
    for (const Row& row : rows_) {
        total.listed += row.counts.listed;
        total.error_pixels += row.counts.error_pixels;
    }
    return total;
}

void Selector::countBins(const Row& row, Histogram& histogram) const {
    uint* const bins = histogram.bins.data();
    uint low = histogram.low;
    uint high = histogram.high;
    for (std::size_t pixel = row.begin; pixel < row.end; ++pixel) {
        const uint bin = place_[pixel];
        if (bin == 0 || bin == kSkipped)
            continue;
        ++bins[bin];
        low = std::min(low, bin);
        high = std::max(high, bin);
    }
    histogram.low = low;
    histogram.high = high;
}

/// Goes through the bins from the greatest error down. Returns the rank of the first pixel with
/// error 0.
std::size_t Selector::findBatchOfBins(std::size_t batch) {
    uint low = kBins;
    uint high = 0;
    for (const Histogram& histogram : histograms_) {
        low = std::min(low, histogram.low);
        high = std::max(high, histogram.high);
    }
    batch_of_bin_.resize(kBins);
    std::size_t rank = 0;
    std::size_t straddling = 0;
    for (uint bin = high; bin >= low; --bin) {
        std::size_t count = 0;
        for (const Histogram& histogram : histograms_)
            count += histogram.bins[bin];
        if (count == 0)
            continue;
        const std::size_t first_batch = rank / batch;
        if (first_batch == (rank + count - 1) / batch) {
            batch_of_bin_[bin] = static_cast<std::uint16_t>(first_batch);
        } else {
            batch_of_bin_[bin] = kStraddles;
            groups_.push_back({straddling, rank});
            straddling += count;
        }
        rank += count;
    }
    straddlers_.resize(straddling);
    sorted_.resize(straddling);
    return rank;
}

/// Replaces bins by batches and counts each batch's pixels by row. Zeros are ranked as they come:
/// rows and the pixels in them are visited in the order of pixels.
void Selector::findBatchOfPixels(std::size_t batch, std::size_t batches, std::size_t first_zero) {
    std::size_t zeros_before = first_zero;
    for (Row& row : rows_)
        zeros_before += std::exchange(row.zeros, zeros_before);

    tbb::parallel_for(std::size_t{0}, rows_.size(), [&](std::size_t row_index) {
        Row& row = rows_[row_index];
        row.straddlers.clear();
        uint* const counts = counts_.data() + row_index * batches;
        std::size_t zero_batch = row.zeros / batch;
        std::size_t zero_room = batch - row.zeros % batch;
        for (std::size_t pixel = row.begin; pixel < row.end; ++pixel) {
            std::uint16_t place = place_[pixel];
            if (place == kSkipped)
                continue;
            if (place == 0) {
                place = static_cast<std::uint16_t>(zero_batch);
                if (--zero_room == 0) {
                    ++zero_batch;
                    zero_room = batch;
                }
            } else {
                place = batch_of_bin_[place];
                if (place == kStraddles) {
                    row.straddlers.push_back(static_cast<uint>(pixel));
                    continue;
                }
            }
            place_[pixel] = place;
            ++counts[place];
        }
    });
}

/// Sorts the pixels whose bin lies in more than one batch, and only those, by their full error.
void Selector::placeStraddlers(std::span<const vec2> errors, std::size_t batch, std::size_t batches,
                               RadixSorter& radix) {
    // One list, in the order of pixels, so that a stable sort breaks ties by pixel.
    std::size_t filled = 0;
    for (const Row& row : rows_) {
        std::ranges::copy(row.straddlers,
                          straddlers_.begin() + static_cast<std::ptrdiff_t>(filled));
        filled += row.straddlers.size();
    }
    const auto source = [&](std::size_t i) {
        const uint pixel = straddlers_[i];
        return KeyedPixel{descendingErrorKey(errors[pixel].x), pixel};
    };
    radix.sort(kErrorKeyBits, source, sorted_);

    // Sorted, each bin's pixels are together, and bins follow each other as their ranks do.
    tbb::parallel_for(std::size_t{0}, groups_.size(), [&](std::size_t index) {
        const Group& group = groups_[index];
        const std::size_t end =
            index + 1 < groups_.size() ? groups_[index + 1].first : sorted_.size();
        for (std::size_t i = group.first; i < end; ++i)
            place_[sorted_[i]] = static_cast<std::uint16_t>((group.rank + i - group.first) / batch);
    });
    tbb::parallel_for(std::size_t{0}, rows_.size(), [&](std::size_t row_index) {
        uint* const counts = counts_.data() + row_index * batches;
        for (uint pixel : rows_[row_index].straddlers)
            ++counts[place_[pixel]];
    });
}

/// Writes the batches one after another, the pixels of each in tile order.
void Selector::scatter(const TileOrder& tiles, std::size_t batches, std::span<uint> order) {
    uint next = 0;
    for (std::size_t batch = 0; batch < batches; ++batch)
        for (std::size_t row = 0; row < rows_.size(); ++row)
            next += std::exchange(counts_[row * batches + batch], next);

    tbb::parallel_for(std::size_t{0}, rows_.size(), [&](std::size_t row) {
        uint* const places = counts_.data() + row * batches;
        const uint first_tile = static_cast<uint>(row) * tiles.tiles().x;
        for (uint tile = first_tile; tile < first_tile + tiles.tiles().x; ++tile)
            tiles.forEachPixel(tile, [&](uint pixel) {
                const std::uint16_t batch = place_[pixel];
                if (batch != kSkipped)
                    order[places[batch]++] = pixel;
            });
    });
}

} // namespace hone

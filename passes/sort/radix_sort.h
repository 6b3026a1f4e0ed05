// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/math.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <span>
#include <vector>

namespace hone {

struct KeyedPixel {
    uint key;
    uint pixel;
};

/// Least-significant-digit radix sort on all cores: O(n), stable, the same result at any thread
/// count. Keeps its scratch memory between calls.
class RadixSorter {
public:
    /// Writes the pixels of source(0 ... order.size() - 1) to `order`, by key ascending, equal keys
    /// in the order of the source. Keys are below 2^key_bits. `source` is called from several
    /// threads and may be called more than once for an index.
    template <class Source> void sort(uint key_bits, const Source& source, std::span<uint> order) {
        const std::size_t count = order.size();
        const uint digits = (key_bits + kMaxDigitBits - 1) / kMaxDigitBits;
        const uint digit_bits = (key_bits + digits - 1) / digits;
        from_.resize(std::max(from_.size(), count));
        to_.resize(std::max(to_.size(), count));
        const auto from = [this](std::size_t i) { return from_[i]; };

        // All digits but the last move whole records; a digit that is the same everywhere is passed
        // over: the keys of yes-or-no metrics have only those.
        const uint differing = differingBits(count, source);
        const uint mask = (1u << digit_bits) - 1;
        bool is_in_source = true;
        for (uint digit = 0; digit + 1 < digits; ++digit) {
            const uint shift = digit * digit_bits;
            if ((differing >> shift & mask) == 0)
                continue;
            const auto move = [this](std::size_t place, KeyedPixel record) { to_[place] = record; };
            if (is_in_source)
                pass(count, shift, digit_bits, source, move);
            else
                pass(count, shift, digit_bits, from, move);
            std::swap(from_, to_);
            is_in_source = false;
        }
        const uint shift = (digits - 1) * digit_bits;
        const auto finish = [order](std::size_t place, KeyedPixel record) {
            order[place] = record.pixel;
        };
        if (is_in_source)
            pass(count, shift, digit_bits, source, finish);
        else
            pass(count, shift, digit_bits, from, finish);
    }

private:
    /// 256 places written to at a time: more miss the caches, fewer need more passes.
    static constexpr uint kMaxDigitBits = 8;
    static constexpr std::size_t kLeastChunk = 8192;
    using Buckets = std::array<uint, std::size_t{1} << kMaxDigitBits>;

    static std::size_t chunksOf(std::size_t count) {
        const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
        return std::clamp(count / kLeastChunk, std::size_t{1}, 4 * threads);
    }

    /// The bits in which not all keys are the same.
    template <class Source> static uint differingBits(std::size_t count, const Source& source) {
        if (count == 0)
            return 0;
        const std::size_t chunks = chunksOf(count);
        const uint first = source(0).key;
        std::atomic<uint> differing = 0;
        tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
            uint here = 0;
            for (std::size_t i = count * chunk / chunks; i < count * (chunk + 1) / chunks; ++i)
                here |= source(i).key ^ first;
            differing.fetch_or(here, std::memory_order_relaxed); // the order cannot matter
        });
        return differing;
    }

    /// One digit: counts buckets by chunk, turns counts into places, scatters.
    template <class Source, class Target>
    void pass(std::size_t count, uint shift, uint bits, const Source& source,
              const Target& target) {
        const uint mask = (1u << bits) - 1;
        const std::size_t chunks = chunksOf(count);
        const auto begin = [&](std::size_t chunk) { return count * chunk / chunks; };
        places_.resize(std::max(places_.size(), chunks));

        tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
            Buckets counts{};
            for (std::size_t i = begin(chunk); i < begin(chunk + 1); ++i)
                ++counts[(source(i).key >> shift) & mask];
            places_[chunk] = counts;
        });

        uint place = 0;
        for (std::size_t bucket = 0; bucket <= mask; ++bucket)
            for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
                const uint here = places_[chunk][bucket];
                places_[chunk][bucket] = place;
                place += here;
            }

        tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
            Buckets places = places_[chunk];
            for (std::size_t i = begin(chunk); i < begin(chunk + 1); ++i) {
                const KeyedPixel record = source(i);
                target(places[(record.key >> shift) & mask]++, record);
            }
        });
    }

    std::vector<KeyedPixel> from_;
    std::vector<KeyedPixel> to_;
    std::vector<Buckets> places_;
};

} // namespace hone

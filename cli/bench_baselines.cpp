// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/bench_baselines.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace hone::cli {
namespace {

/// Milliseconds, medians of 9 runs on two cores of an AMD EPYC with AVX-512; errors as a metric
/// gives them plus a little noise.
struct Measured {
    double pixels, select, radix, std_sort;
};
constexpr Measured kMeasured[] = {{800.0 * 600, 1.0, 3.3, 25.0},
                                  {1024.0 * 768, 1.25, 6.1, 43.1},
                                  {1920.0 * 1080, 4.2, 17.4, 127.0}};

std::span<std::uint64_t> slice(std::vector<std::uint64_t>& words, std::size_t index,
                               std::size_t slices) {
    const std::size_t begin = words.size() * index / slices;
    return std::span(words).subspan(begin, words.size() * (index + 1) / slices - begin);
}

} // namespace

void StreamLoop::run() {
    constexpr std::size_t kSlices = 64;
    tbb::parallel_for(std::size_t{0}, kSlices, [&](std::size_t index) {
        const std::span<std::uint64_t> source = slice(source_, index, kSlices);
        // The sum is written, so that no reading is optimised away.
        const std::uint64_t sum = std::accumulate(source.begin(), source.end(), std::uint64_t{0});
        std::ranges::fill(slice(target_, index, kSlices), sum);
    });
}

void StandardSort::setErrors(std::span<const vec2> errors) {
    keys_.resize(errors.size());
    for (std::size_t pixel = 0; pixel < errors.size(); ++pixel)
        keys_[pixel] = std::uint64_t{~std::bit_cast<uint>(errors[pixel].x)} << 32u | pixel;
}

void StandardSort::run() {
    sorted_ = keys_;
    std::ranges::sort(sorted_);
}

SortingShares bareSortingShares(uvec2 size) {
    const double pixels = static_cast<double>(size.x) * size.y;
    const Measured& nearest = *std::ranges::min_element(kMeasured, {}, [pixels](const Measured& m) {
        return std::abs(std::log(m.pixels / pixels));
    });
    return {nearest.select / nearest.std_sort, nearest.radix / nearest.std_sort};
}

} // namespace hone::cli

// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/bench_clock.h"

#include <algorithm>

namespace hone::cli {

std::vector<std::vector<double>> interleave(int repeats,
                                            std::span<const std::function<void()>> contenders) {
    std::vector<std::vector<double>> ms(contenders.size());
    for (int round = -1; round < repeats; ++round)
        for (std::size_t k = 0; k < contenders.size(); ++k) {
            const double passed = elapsedMs(contenders[k]);
            if (round >= 0)
                ms[k].push_back(passed);
        }
    return ms;
}

double median(std::vector<double> values) {
    if (values.empty())
        return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    if (values.size() % 2 == 1)
        return *middle;
    return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

double medianRatio(std::span<const double> a, std::span<const double> b) {
    std::vector<double> ratios;
    for (std::size_t round = 0; round < std::min(a.size(), b.size()); ++round)
        if (b[round] > 0)
            ratios.push_back(a[round] / b[round]);
    return median(std::move(ratios));
}

} // namespace hone::cli

// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/weight/ckc03/task_distance.h"

#include <tbb/parallel_for.h>

#include <cstddef>
#include <limits>

namespace hone {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// min over j of (i - j)^2 + values[j], for each i. `values` may hold infinities.
class LowerEnvelope {
public:
    explicit LowerEnvelope(std::size_t count) : values_(count), roots_(count), from_(count + 1) {}

    template <class At> void transform(const At& at) {
        const std::size_t count = values_.size();
        for (std::size_t i = 0; i < count; ++i)
            values_[i] = static_cast<double>(at(i));

        // The parabolas that are somewhere the lowest, from left to right, and where each begins.
        std::size_t parabolas = 0;
        for (std::size_t i = 0; i < count; ++i) {
            if (values_[i] == kInfinity)
                continue;
            double begin = -kInfinity;
            while (parabolas > 0 &&
                   (begin = crossing(roots_[parabolas - 1], i)) <= from_[parabolas - 1])
                --parabolas;
            roots_[parabolas] = i;
            from_[parabolas] = parabolas == 0 ? -kInfinity : begin;
            ++parabolas;
        }
        from_[parabolas] = kInfinity;

        std::size_t lowest = 0;
        for (std::size_t i = 0; parabolas > 0 && i < count; ++i) {
            while (from_[lowest + 1] < static_cast<double>(i))
                ++lowest;
            const double away = static_cast<double>(i) - static_cast<double>(roots_[lowest]);
            at(i) = static_cast<float>(away * away + values_[roots_[lowest]]);
        }
    }

private:
    /// Where the parabola rooted at `right` gets below that at `left`.
    [[nodiscard]] double crossing(std::size_t left, std::size_t right) const {
        const auto l = static_cast<double>(left), r = static_cast<double>(right);
        return ((values_[right] + r * r) - (values_[left] + l * l)) / (2 * (r - l));
    }

    std::vector<double> values_;
    std::vector<std::size_t> roots_;
    std::vector<double> from_;
};

} // namespace

void squaredDistances(uvec2 extent, std::vector<float>& squared) {
    for (float& value : squared)
        if (value > 0)
            value = std::numeric_limits<float>::infinity();
    tbb::parallel_for(0u, extent.x, [&](uint x) {
        LowerEnvelope(extent.y).transform(
            [&](std::size_t y) -> float& { return squared[y * extent.x + x]; });
    });
    tbb::parallel_for(0u, extent.y, [&](uint y) {
        LowerEnvelope(extent.x).transform(
            [&](std::size_t x) -> float& { return squared[y * std::size_t{extent.x} + x]; });
    });
}

} // namespace hone

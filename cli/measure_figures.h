// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/measure/quality.h"

#include <functional>
#include <span>

namespace hone::cli {

/// One number of a metric's quality, under the name that JSON and CSV give it.
struct MeasureFigure {
    const char* name;
    Better better;
    std::function<double(const MetricQuality&)> of;
    int threshold = -1; ///< index into kThresholds; -1: of no threshold

    /// Whether a view tells something of it. Where less than a thousandth of the pixels is above
    /// the threshold, most of them are silhouettes that rasteriser and tracer see differently
    /// (--effect none shows them), which no metric of an effect speaks of; without flagged pixels
    /// there is no precision.
    [[nodiscard]] bool isTold(const MetricQuality& quality) const;
};

/// Share of pixels with an error that can be seen, for a view to count.
inline constexpr double kJudgedShare = 0.001;

/// All of them, those of one name together.
[[nodiscard]] std::span<const MeasureFigure> measureFigures();

} // namespace hone::cli

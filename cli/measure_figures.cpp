// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/measure_figures.h"

#include <algorithm>
#include <string_view>
#include <vector>

namespace hone::cli {
namespace {

std::vector<MeasureFigure> makeFigures() {
    std::vector<MeasureFigure> all;
    for (std::size_t t = 0; t < kThresholds.size(); ++t) {
        const auto add = [&](const char* name, Better better,
                             double (*of)(const MetricQuality&, std::size_t)) {
            all.push_back({name, better, [of, t](const MetricQuality& q) { return of(q, t); },
                           static_cast<int>(t)});
        };
        add("recall", Better::kGreater,
            [](const MetricQuality& q, std::size_t at) { return q.detection[at].recall; });
        add("precision", Better::kGreater,
            [](const MetricQuality& q, std::size_t at) { return q.detection[at].precision; });
        add("flagged", Better::kLess,
            [](const MetricQuality& q, std::size_t at) { return q.detection[at].flagged; });
        add("worst_miss", Better::kLess,
            [](const MetricQuality& q, std::size_t at) { return q.detection[at].worst_miss; });
        add("missed_energy", Better::kLess,
            [](const MetricQuality& q, std::size_t at) { return q.detection[at].missed_energy; });
        add("auc_at", Better::kGreater,
            [](const MetricQuality& q, std::size_t at) { return q.auc[at]; });
        add("average_precision", Better::kGreater,
            [](const MetricQuality& q, std::size_t at) { return q.average_precision[at]; });
    }
    const auto add = [&](const char* name, Better better, double (*of)(const MetricQuality&)) {
        all.push_back({name, better, of, -1});
    };
    add("auc", Better::kGreater, [](const MetricQuality& q) { return q.auc[0]; });
    add("spearman", Better::kGreater, [](const MetricQuality& q) { return q.spearman; });
    add("gain", Better::kGreater, [](const MetricQuality& q) { return q.gain; });
    add("gain_by_rays", Better::kGreater, [](const MetricQuality& q) { return q.gain_by_rays; });
    add("auc_flagged", Better::kGreater, [](const MetricQuality& q) { return q.auc_flagged; });
    add("gain_flagged", Better::kGreater, [](const MetricQuality& q) { return q.gain_flagged; });
    add("area", Better::kLess, [](const MetricQuality& q) { return q.by_pixels.area; });
    add("area_by_rays", Better::kLess, [](const MetricQuality& q) { return q.by_rays.area; });
    add("pixels_until_10_percent", Better::kLess,
        [](const MetricQuality& q) { return q.pixels_until[0]; });
    add("pixels_until_1_percent", Better::kLess,
        [](const MetricQuality& q) { return q.pixels_until[1]; });
    add("rays_until_10_percent", Better::kLess,
        [](const MetricQuality& q) { return q.rays_until[0]; });
    add("rays_until_1_percent", Better::kLess,
        [](const MetricQuality& q) { return q.rays_until[1]; });
    add("calibration_slope", Better::kNearOne,
        [](const MetricQuality& q) { return q.calibration.slope; });
    add("calibration_offset", Better::kLess,
        [](const MetricQuality& q) { return q.calibration.offset; });
    add("calibration_error", Better::kLess,
        [](const MetricQuality& q) { return q.calibration.expected_error; });
    return all;
}

} // namespace

bool MeasureFigure::isTold(const MetricQuality& quality) const {
    const Detection& found = quality.detection[static_cast<std::size_t>(std::max(threshold, 0))];
    const std::string_view figure = name;
    return figure == "flagged" ||
           (found.positives >= kJudgedShare && (figure != "precision" || found.flagged > 0));
}

std::span<const MeasureFigure> measureFigures() {
    static const std::vector<MeasureFigure> figures = makeFigures();
    return figures;
}

} // namespace hone::cli

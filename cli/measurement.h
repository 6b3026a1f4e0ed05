// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/cli/measure_stage.h"

#include <nlohmann/json.hpp>

#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace hone::cli {

/// An order of refinement that is no metric's, to see metrics against.
struct ReferenceOrder {
    std::string name; ///< "oracle", "random", "scanline", "checkerboard"
    Convergence by_pixels, by_rays;
    double gain = 0, gain_by_rays = 0;
};

/// What was found in one view. Curves are thinned to points that are evenly far apart.
struct ViewMeasurement {
    std::string name;
    double mse = 0;                  ///< of the raster image against the truth, display units
    ByThreshold<double> positives{}; ///< share of pixels above
    ByThreshold<std::size_t> undecidable{};
    std::vector<MetricQuality> metrics; ///< by Measurement::names
    std::vector<std::size_t> repaired;
    std::vector<ReferenceOrder> orders;
    RefinedFrame frame;
};

/// How good the metrics of a graph are, view by view.
struct Measurement {
    std::string graph, scene, effect, truth;
    uvec2 size{0, 0};
    std::uint32_t truth_samples = 0;
    bool is_truth_judged = false;   ///< its noise was measured
    std::vector<std::string> names; ///< of the metrics
    std::vector<ViewMeasurement> views;
};

/// Whether enough pixels have an error that can be seen for the view to count.
[[nodiscard]] bool hasVisibleError(const ViewMeasurement& view);
/// A figure ("recall", "gain", as in the JSON) of a metric (an index into names) over the views
/// that tell something of it. `threshold`: in 255ths, for figures that have one. Throws
/// std::logic_error for a name that is none.
[[nodiscard]] OverViews overViews(const Measurement& measurement, std::size_t metric,
                                  std::string_view figure, uint threshold = 1);

/// Judges the metrics of a view.
[[nodiscard]] ViewMeasurement measureView(const JudgedView& judged, RefinedFrame frame);

/// DESIGN.md section 7; numbers that are not defined are null.
[[nodiscard]] nlohmann::ordered_json toJson(const Measurement& measurement);
/// A row a metric, view and threshold.
[[nodiscard]] std::string metricsAsCsv(const Measurement& measurement);
/// What is left of the squared error, by the share of pixels and of rays, and by milliseconds.
[[nodiscard]] std::string curvesAsCsv(const Measurement& measurement);
/// A line a metric: mean and worst view.
void printTable(const Measurement& measurement, std::ostream& out);
/// The same figures, for documents.
void printMarkdown(const Measurement& measurement, std::ostream& out);

} // namespace hone::cli

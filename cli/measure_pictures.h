// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/cli/measurement.h"
#include "hone/cli/report.h"
#include "hone/cli/svg_plot.h"

#include <string>
#include <vector>

namespace hone::cli {

/// Estimated error, real error and their difference beside each other, on the scale of heatColor
/// over the square root, so that 1/255 can be seen and 1 is brightest.
[[nodiscard]] Image8 errorStrip(uvec2 extent, std::span<const float> expect,
                                std::span<const float> error);

/// Writes what people look at: pictures of each view, and over all views how errors fall and how
/// estimates scatter.
class MeasurePictures {
public:
    /// `folder` is there and can be written to.
    explicit MeasurePictures(std::string folder) : folder_(std::move(folder)) {}
    /// Writes the strips of a view ("VIEW.METRIC.png") and adds to the scatter plots.
    void add(const JudgedView& view);
    /// Writes curves.svg, curves_by_rays.svg, METRIC.scatter.svg and, with everything in it,
    /// measure.html. Returns the paths of all files.
    [[nodiscard]] std::vector<std::string> finish(const Measurement& measurement);

private:
    std::string folder_;
    std::vector<std::string> paths_;
    std::vector<ReportPicture> first_view_;
    std::vector<std::vector<double>> scatter_; ///< by metric: counts of a PlotGrid
};

} // namespace hone::cli

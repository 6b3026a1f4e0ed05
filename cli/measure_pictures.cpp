// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/measure_pictures.h"

#include "hone/cli/color_map.h"
#include "hone/cli/outputs.h"
#include "hone/core/image/atomic_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

namespace hone::cli {
namespace {

constexpr uint kCells = 48; ///< of a scatter plot, each way, for errors up to 1
constexpr const char* kTableFigures[] = {"recall",       "precision",        "flagged",
                                         "auc",          "spearman",         "gain",
                                         "gain_by_rays", "calibration_slope"};
constexpr uint kColumns = 2 * kCells; ///< estimates go to 2: sums of metrics exceed 1

/// The mean over views of curves whose points are at the same costs; those of nothing left out.
std::vector<std::pair<double, double>>
meanCurve(const Measurement& measurement,
          const std::function<const Convergence&(const ViewMeasurement&)>& curveOf) {
    std::vector<std::pair<double, double>> mean;
    double count = 0;
    for (const ViewMeasurement& view : measurement.views) {
        const Convergence& curve = curveOf(view);
        if (!hasVisibleError(view))
            continue;
        mean.resize(curve.curve.size());
        for (std::size_t k = 0; k < mean.size(); ++k) {
            mean[k].first = curve.curve[k].cost;
            mean[k].second += curve.curve[k].left;
        }
        ++count;
    }
    for (auto& [cost, left] : mean)
        left /= count;
    return mean;
}

Plot curvesOf(const Measurement& measurement, bool by_rays) {
    Plot plot;
    plot.title = "What is left of the squared error, mean of the views";
    plot.x_label = by_rays ? "share of the rays" : "share of the pixels refined";
    plot.y_label = "MSE / MSE of the raster image";
    for (std::size_t k = 0; k < measurement.names.size(); ++k)
        plot.lines.push_back(
            {measurement.names[k],
             meanCurve(measurement, [&](const ViewMeasurement& view) -> const Convergence& {
                 return by_rays ? view.metrics[k].by_rays : view.metrics[k].by_pixels;
             })});
    const std::size_t orders = measurement.views.empty() ? 0 : measurement.views[0].orders.size();
    for (std::size_t k = 0; k < orders; ++k)
        plot.lines.push_back({measurement.views[0].orders[k].name,
                              meanCurve(measurement,
                                        [&](const ViewMeasurement& view) -> const Convergence& {
                                            return by_rays ? view.orders[k].by_rays
                                                           : view.orders[k].by_pixels;
                                        }),
                              true});
    return plot;
}

Plot scatterOf(const std::string& name, const std::vector<double>& counts) {
    // Half of the plot is enough where no estimate is above 1.
    uint columns = kCells;
    for (std::size_t cell = 0; cell < counts.size(); ++cell)
        if (cell % kColumns >= kCells && counts[cell] > 0)
            columns = kColumns;
    Plot plot;
    plot.title = name + " against the real error, pixels of all views";
    plot.x_label = "estimated error";
    plot.y_label = "real error";
    plot.x_end = columns / kCells;
    plot.grid = {columns, kCells, {}};
    for (uint row = 0; row < kCells; ++row)
        plot.grid.counts.insert(plot.grid.counts.end(),
                                counts.begin() + std::ptrdiff_t{row} * kColumns,
                                counts.begin() + std::ptrdiff_t{row} * kColumns + columns);
    plot.lines.push_back({"equal", {{0, 0}, {1, 1}}, true});
    return plot;
}

ReportTable tableOf(const Measurement& measurement) {
    ReportTable table{"Mean over the views (and the worst)", {"metric"}, {}};
    for (const char* name : kTableFigures)
        table.head.emplace_back(name);
    for (std::size_t metric = 0; metric < measurement.names.size(); ++metric) {
        std::vector<std::string>& row = table.rows.emplace_back();
        row.push_back(measurement.names[metric]);
        for (const char* name : kTableFigures) {
            const OverViews value = overViews(measurement, metric, name);
            char cell[64];
            std::snprintf(cell, sizeof cell, "%.3f (%.3f)", value.mean, value.worst);
            row.emplace_back(cell);
        }
    }
    return table;
}

} // namespace

Image8 errorStrip(uvec2 extent, std::span<const float> expect, std::span<const float> error) {
    constexpr uint kGap = 4;
    const uvec2 whole{3 * extent.x + 2 * kGap, extent.y};
    std::vector<vec3> pixels(std::size_t{whole.x} * whole.y, vec3(1));
    for (uint y = 0; y < extent.y; ++y)
        for (uint x = 0; x < extent.x; ++x) {
            const std::size_t pixel = std::size_t{y} * extent.x + x;
            const float values[] = {expect[pixel], error[pixel],
                                    std::fabs(expect[pixel] - error[pixel])};
            for (uint k = 0; k < 3; ++k)
                pixels[std::size_t{y} * whole.x + k * (extent.x + kGap) + x] =
                    heatColor(std::sqrt(values[k]));
        }
    return quantize(whole, pixels);
}

void MeasurePictures::add(const JudgedView& view) {
    scatter_.resize(view.metrics.size(), std::vector<double>(std::size_t{kColumns} * kCells));
    const bool is_first = first_view_.empty();
    for (std::size_t k = 0; k < view.metrics.size(); ++k) {
        const MetricPlanes& metric = view.metrics[k];
        const Image8 strip = errorStrip(view.truth.extent, metric.expect, view.error.max);
        paths_.push_back(folder_ + "/" + fileStem(view.name + "." + metric.name) + ".png");
        writePng(paths_.back(), strip);
        if (is_first)
            first_view_.push_back(
                {metric.name, "estimated error, real error, their difference (" + view.name + ")",
                 strip});
        // 1 itself, which many metrics say, belongs to the cells below it.
        const auto cellOf = [](float value) {
            const auto cell = static_cast<uint>(std::min(value, 1.99f) * kCells);
            return value <= 1 ? std::min(cell, kCells - 1) : cell;
        };
        for (std::size_t i = 0; i < metric.expect.size(); ++i)
            ++scatter_[k][std::size_t{cellOf(view.error.max[i])} * kColumns +
                          cellOf(metric.expect[i])];
    }
}

std::vector<std::string> MeasurePictures::finish(const Measurement& measurement) {
    Report report;
    report.title = "hone measure " + measurement.graph;
    report.summary = std::to_string(measurement.views.size()) + " views of " + measurement.scene +
                     ", effect " + measurement.effect + ", against " + measurement.truth;
    report.pictures = std::move(first_view_);
    const auto draw = [&](const std::string& file, std::string caption, const Plot& plot) {
        const std::string svg = toSvg(plot);
        paths_.push_back(folder_ + "/" + file);
        writeFileAtomically(paths_.back(), std::as_bytes(std::span(svg)));
        report.drawings.push_back({std::move(caption), svg});
    };
    draw("curves.svg", "Squared error while pixels are refined in a metric's order",
         curvesOf(measurement, false));
    draw("curves_by_rays.svg", "The same by the rays that it takes", curvesOf(measurement, true));
    for (std::size_t k = 0; k < scatter_.size(); ++k)
        draw(fileStem(measurement.names[k]) + ".scatter.svg",
             "How " + measurement.names[k] + " and the real error go together",
             scatterOf(measurement.names[k], scatter_[k]));
    report.tables.push_back(tableOf(measurement));
    const std::string html = toHtml(report);
    paths_.push_back(folder_ + "/measure.html");
    writeFileAtomically(paths_.back(), std::as_bytes(std::span(html)));
    return std::move(paths_);
}

} // namespace hone::cli

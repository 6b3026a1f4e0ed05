// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/measurement.h"

#include "hone/cli/measure_figures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numeric>
#include <sstream>
#include <stdexcept>

namespace hone::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kCurvePoints = 100;

/// A curve has a point a pixel: too much to keep for every metric and view.
void thin(Convergence& order) {
    std::vector<Convergence::Point> points;
    for (std::size_t k = 0; k <= kCurvePoints; ++k) {
        const double cost = static_cast<double>(k) / kCurvePoints;
        points.push_back({cost, order.leftAt(cost)});
    }
    order.curve = std::move(points);
}

ReferenceOrder referenceOrder(const char* name, const ViewTruth& truth,
                              std::span<const float> score, const ReferenceOrder* oracle) {
    ReferenceOrder order{name, {}, {}, 1, 1};
    order.by_pixels =
        oracle == nullptr ? convergeOracle(truth.square, {}) : converge(truth.square, score, {});
    order.by_rays = oracle == nullptr ? convergeOracle(truth.square, truth.cost)
                                      : converge(truth.square, score, truth.cost);
    if (oracle != nullptr) {
        order.gain = gain(order.by_pixels, oracle->by_pixels);
        order.gain_by_rays = gain(order.by_rays, oracle->by_rays);
    }
    return order;
}

/// The figures as one object; those of thresholds are objects by threshold.
Json figuresAsJson(const std::function<double(const MeasureFigure&)>& valueOf) {
    Json object = Json::object();
    for (const MeasureFigure& figure : measureFigures()) {
        const double value = valueOf(figure);
        if (figure.threshold < 0)
            object[figure.name] = value;
        else
            object[figure.name]
                  [std::to_string(kThresholds[static_cast<std::size_t>(figure.threshold)])] = value;
    }
    return object;
}

OverViews overAllViews(const Measurement& measurement, std::size_t metric,
                       const MeasureFigure& figure) {
    std::vector<double> values;
    for (const ViewMeasurement& view : measurement.views)
        if (figure.isTold(view.metrics[metric]))
            values.push_back(figure.of(view.metrics[metric]));
    return overViews(values, figure.better);
}

template <class T> Json byThreshold(const ByThreshold<T>& values) {
    Json object = Json::object();
    for (std::size_t t = 0; t < kThresholds.size(); ++t)
        object[std::to_string(kThresholds[t])] = values[t];
    return object;
}

Json viewAsJson(const ViewMeasurement& view, bool is_truth_judged) {
    Json orders = Json::array();
    for (const ReferenceOrder& order : view.orders)
        orders.push_back({{"name", order.name},
                          {"area", order.by_pixels.area},
                          {"area_by_rays", order.by_rays.area},
                          {"gain", order.gain},
                          {"gain_by_rays", order.gain_by_rays}});
    Json json = {{"name", view.name},
                 {"mse", view.mse},
                 {"positives", byThreshold(view.positives)},
                 {"orders", std::move(orders)}};
    if (is_truth_judged)
        json["undecidable"] = byThreshold(view.undecidable);
    if (view.frame.points.size() > 1) {
        Json points = Json::array();
        for (const RefinedFrame::Point& point : view.frame.points)
            points.push_back({{"ms", point.ms}, {"rays", point.rays}, {"mse", point.mse}});
        json["refinement"] = {{"ms", view.frame.points.back().ms},
                              {"estimate_ms", view.frame.estimate_ms},
                              {"ms_until_10_percent", view.frame.msUntil(0.1)},
                              {"ms_until_1_percent", view.frame.msUntil(0.01)},
                              {"prt_ms", view.frame.prt_ms},
                              {"points", std::move(points)}};
    }
    return json;
}

std::string quoted(const std::string& text) {
    std::string cell = "\"";
    for (const char c : text)
        cell += c == '"' ? std::string("\"\"") : std::string(1, c);
    return cell + "\"";
}

} // namespace

bool hasVisibleError(const ViewMeasurement& view) {
    return view.positives[0] >= kJudgedShare;
}

OverViews overViews(const Measurement& measurement, std::size_t metric, std::string_view name,
                    uint threshold) {
    for (const MeasureFigure& figure : measureFigures())
        if (figure.name == name &&
            (figure.threshold < 0 ||
             kThresholds[static_cast<std::size_t>(figure.threshold)] == threshold))
            return overAllViews(measurement, metric, figure);
    throw std::logic_error("measure has no figure " + std::string(name));
}

ViewMeasurement measureView(const JudgedView& judged, RefinedFrame frame) {
    const ViewTruth truth = judged.known();
    ViewMeasurement view;
    view.name = judged.name;
    view.frame = std::move(frame);
    view.mse = std::accumulate(truth.square.begin(), truth.square.end(), 0.0) /
               static_cast<double>(truth.square.size());
    for (std::size_t t = 0; t < kThresholds.size(); ++t) {
        const std::vector<bool> left_out = undecidable(truth, kThresholds[t]);
        view.undecidable[t] = static_cast<std::size_t>(std::ranges::count(left_out, true));
    }
    for (const MetricPlanes& metric : judged.metrics) {
        MetricQuality quality = judge(truth, metric.expect, metric.bound);
        for (std::size_t t = 0; t < kThresholds.size(); ++t)
            view.positives[t] = quality.detection[t].positives;
        thin(quality.by_pixels);
        thin(quality.by_rays);
        view.metrics.push_back(std::move(quality));
        view.repaired.push_back(metric.repaired);
    }
    view.orders.push_back(referenceOrder("oracle", truth, {}, nullptr));
    for (const BlindOrder& blind : blindOrders(truth.extent))
        view.orders.push_back(referenceOrder(blind.name, truth, blind.score, &view.orders.front()));
    for (ReferenceOrder& order : view.orders) {
        thin(order.by_pixels);
        thin(order.by_rays);
    }
    return view;
}

Json toJson(const Measurement& measurement) {
    Json views = Json::array(), rows = Json::array(), summary = Json::array();
    for (const ViewMeasurement& view : measurement.views)
        views.push_back(viewAsJson(view, measurement.is_truth_judged));
    for (std::size_t metric = 0; metric < measurement.names.size(); ++metric) {
        for (const ViewMeasurement& view : measurement.views) {
            Json row = {{"name", measurement.names[metric]},
                        {"effect", measurement.effect},
                        {"view", view.name}};
            row.update(figuresAsJson(
                [&](const MeasureFigure& figure) { return figure.of(view.metrics[metric]); }));
            row["repaired"] = view.repaired[metric];
            rows.push_back(std::move(row));
        }
        summary.push_back({{"name", measurement.names[metric]},
                           {"effect", measurement.effect},
                           {"mean", figuresAsJson([&](const MeasureFigure& figure) {
                                return overAllViews(measurement, metric, figure).mean;
                            })},
                           {"worst", figuresAsJson([&](const MeasureFigure& figure) {
                                return overAllViews(measurement, metric, figure).worst;
                            })}});
    }
    return {{"graph", measurement.graph},
            {"scene", measurement.scene},
            {"size", {measurement.size.x, measurement.size.y}},
            {"effect", measurement.effect},
            {"truth", {{"graph", measurement.truth}, {"samples", measurement.truth_samples}}},
            {"thresholds", kThresholds},
            {"threshold_unit", "1/255"},
            {"views", std::move(views)},
            {"metrics", std::move(rows)},
            {"summary", std::move(summary)}};
}

std::string metricsAsCsv(const Measurement& measurement) {
    std::ostringstream text;
    text << "metric,effect,view,figure,threshold,value\n";
    for (std::size_t metric = 0; metric < measurement.names.size(); ++metric)
        for (const ViewMeasurement& view : measurement.views)
            for (const MeasureFigure& figure : measureFigures()) {
                text << quoted(measurement.names[metric]) << ',' << measurement.effect << ','
                     << quoted(view.name) << ',' << figure.name << ',';
                if (figure.threshold >= 0)
                    text << kThresholds[static_cast<std::size_t>(figure.threshold)];
                text << ',' << figure.of(view.metrics[metric]) << '\n';
            }
    return text.str();
}

std::string curvesAsCsv(const Measurement& measurement) {
    std::ostringstream text;
    text << "view,order,by,cost,left\n";
    for (const ViewMeasurement& view : measurement.views) {
        const auto write = [&](const std::string& order, const char* by, const Convergence& curve) {
            for (const Convergence::Point& point : curve.curve)
                text << quoted(view.name) << ',' << quoted(order) << ',' << by << ',' << point.cost
                     << ',' << point.left << '\n';
        };
        for (std::size_t metric = 0; metric < view.metrics.size(); ++metric) {
            write(measurement.names[metric], "pixels", view.metrics[metric].by_pixels);
            write(measurement.names[metric], "rays", view.metrics[metric].by_rays);
        }
        for (const ReferenceOrder& order : view.orders) {
            write(order.name, "pixels", order.by_pixels);
            write(order.name, "rays", order.by_rays);
        }
        for (const RefinedFrame::Point& point : view.frame.points)
            text << quoted(view.name) << ",(the graph),ms," << point.ms << ','
                 << point.mse / view.frame.points.front().mse << '\n';
    }
    return text.str();
}

namespace {

/// A number of a table, `width` columns; a dash where it is not defined.
std::string cell(double value, std::size_t width) {
    if (std::isnan(value))
        return std::string(width - 1, ' ') + "–";
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.4f", value);
    const std::string text(buffer);
    return std::string(width - std::min(text.size(), width), ' ') + text;
}

} // namespace

void printTable(const Measurement& measurement, std::ostream& out) {
    const auto line = [&out](const char* pattern, auto... values) {
        char buffer[256];
        std::snprintf(buffer, sizeof buffer, pattern, values...);
        out << buffer;
    };
    std::size_t width = 12;
    for (const std::string& name : measurement.names)
        width = std::max(width, name.size());
    const int name_width = static_cast<int>(width);
    line("%zu views of %s, %u x %u, effect %s, against %s (%u samples a pixel)\n",
         measurement.views.size(), measurement.scene.c_str(), measurement.size.x,
         measurement.size.y, measurement.effect.c_str(), measurement.truth.c_str(),
         measurement.truth_samples);
    line("%-*s  %15s  %15s  %7s  %7s  %15s  %15s  %15s  %7s  %7s\n", name_width, "",
         "recall >1/255", "recall >8/255", "precis.", "flagged", "AUC >1/255", "Spearman", "gain",
         "by rays", "slope");
    line("%-*s  %7s %7s  %7s %7s  %7s  %7s  %7s %7s  %7s %7s  %7s %7s  %7s  %7s\n", name_width,
         "metric", "mean", "worst", "mean", "worst", "mean", "mean", "mean", "worst", "mean",
         "worst", "mean", "worst", "mean", "mean");
    for (std::size_t metric = 0; metric < measurement.names.size(); ++metric) {
        const auto over = [&](std::string_view figure, uint threshold = 1) {
            return overViews(measurement, metric, figure, threshold);
        };
        const OverViews recall = over("recall"), recall_at_8 = over("recall", 8), auc = over("auc"),
                        ranks = over("spearman"), gain = over("gain");
        line("%-*s ", name_width, measurement.names[metric].c_str());
        for (const OverViews& pair : {recall, recall_at_8})
            out << cell(pair.mean, 8) << cell(pair.worst, 8) << " ";
        out << cell(over("precision").mean, 8) << " " << cell(over("flagged").mean, 8) << " ";
        for (const OverViews& pair : {auc, ranks, gain})
            out << cell(pair.mean, 8) << cell(pair.worst, 8) << " ";
        out << cell(over("gain_by_rays").mean, 8) << " " << cell(over("calibration_slope").mean, 8)
            << "\n";
    }
    // Orders that know nothing: random is 0 by definition.
    for (const char* name : {"scanline", "checkerboard"}) {
        std::vector<double> gains;
        for (const ViewMeasurement& view : measurement.views)
            for (const ReferenceOrder& order : view.orders)
                if (order.name == name && hasVisibleError(view))
                    gains.push_back(order.gain);
        const OverViews gain = overViews(gains, Better::kGreater);
        line("%-*s %*s ", name_width, name, 16 + 1 + 16 + 1 + 8 + 1 + 8 + 1 + 16 + 1 + 16, "");
        out << cell(gain.mean, 8) << cell(gain.worst, 8) << "\n";
    }
    for (const ViewMeasurement& view : measurement.views) {
        line("%s: MSE %.3g, %.1f %% of the pixels above 1/255", view.name.c_str(), view.mse,
             100 * view.positives[0]);
        if (const RefinedFrame& frame = view.frame; frame.points.size() > 1) {
            line("; estimated after %.0f ms", frame.estimate_ms);
            for (const double share : kShares)
                if (const double ms = frame.msUntil(share); std::isnan(ms))
                    line(", MSE never at %.0f %%", 100 * share);
                else
                    line(", MSE at %.0f %% after %.0f ms", 100 * share, ms);
            line(", done after %.0f ms (all traced: %.0f ms)", frame.points.back().ms,
                 frame.prt_ms);
        }
        if (measurement.is_truth_judged)
            line("; undecidable at 1/255: %zu pixels", view.undecidable[0]);
        out << "\n";
    }
}

void printMarkdown(const Measurement& measurement, std::ostream& out) {
    struct Column {
        const char *title, *figure;
        uint threshold;
        bool has_worst;
    };
    static constexpr Column kColumns[] = {{"recall > 1/255", "recall", 1, true},
                                          {"> 8/255", "recall", 8, true},
                                          {"precision", "precision", 1, false},
                                          {"flagged", "flagged", 1, false},
                                          {"AUC", "auc", 1, true},
                                          {"Spearman", "spearman", 1, true},
                                          {"gain G", "gain", 1, true},
                                          {"G of flagged", "gain_flagged", 1, true},
                                          {"G by rays", "gain_by_rays", 1, false},
                                          {"slope", "calibration_slope", 1, false}};
    const auto number = [](double value) {
        char buffer[32];
        std::snprintf(buffer, sizeof buffer, "%.3f", value);
        return std::isnan(value) ? std::string("–") : std::string(buffer);
    };
    out << "| metric |";
    for (const Column& column : kColumns)
        out << ' ' << column.title << " |";
    out << "\n|---|";
    for (std::size_t k = 0; k < std::size(kColumns); ++k)
        out << "--:|";
    out << "\n";
    for (std::size_t metric = 0; metric < measurement.names.size(); ++metric) {
        out << "| " << measurement.names[metric] << " |";
        for (const Column& column : kColumns) {
            const OverViews value = overViews(measurement, metric, column.figure, column.threshold);
            out << ' ' << number(value.mean);
            if (column.has_worst && !std::isnan(value.worst))
                out << " (" << number(value.worst) << ')';
            out << " |";
        }
        out << "\n";
    }
}

} // namespace hone::cli

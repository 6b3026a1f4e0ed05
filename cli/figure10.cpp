// SPDX-License-Identifier: Apache-2.0
//
// hone bench figure10: Figure 10 of the paper, real error, estimated error and their difference,
// for every way of combining metrics, with the numbers that the paper does not give.
#include "hone/cli/commands.h"
#include "hone/cli/json.h"
#include "hone/cli/measure_pictures.h"
#include "hone/core/error.h"
#include "hone/core/image/atomic_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ostream>

namespace hone::cli {
namespace {

using Json = nlohmann::ordered_json;

/// A combiner in one of its modes, in one view.
struct Row {
    std::string view, pass, mode;
    double mae = 0, rmse = 0; ///< of the estimate against the real error
    MetricQuality quality;
    Image8 strip;
};

Row rowOf(const JudgedView& view, const MetricPlanes& metric, const GraphMetric& combiner) {
    Row row{view.name,
            combiner.pass,
            combiner.mode,
            0,
            0,
            judge(view.known(), metric.expect, metric.bound),
            errorStrip(view.truth.extent, metric.expect, view.error.max)};
    for (std::size_t pixel = 0; pixel < metric.expect.size(); ++pixel) {
        const double difference = double{metric.expect[pixel]} - double{view.error.max[pixel]};
        row.mae += std::fabs(difference);
        row.rmse += difference * difference;
    }
    const auto pixels = static_cast<double>(metric.expect.size());
    row.mae /= pixels;
    row.rmse = std::sqrt(row.rmse / pixels);
    return row;
}

/// The strips below each other.
Image8 sheetOf(const std::vector<Row>& rows) {
    constexpr uint kGap = 4;
    const uvec2 one = rows.front().strip.extent;
    const uint count = static_cast<uint>(rows.size());
    Image8 sheet{{one.x, one.y * count + kGap * (count - 1)}, {}};
    for (const Row& row : rows) {
        if (!sheet.rgba.empty())
            sheet.rgba.insert(sheet.rgba.end(), std::size_t{4} * one.x * kGap, 255);
        sheet.rgba.insert(sheet.rgba.end(), row.strip.rgba.begin(), row.strip.rgba.end());
    }
    return sheet;
}

Json toJson(const Row& row) {
    return {{"view", row.view},          {"pass", row.pass},
            {"mode", row.mode},          {"mae", row.mae},
            {"rmse", row.rmse},          {"spearman", row.quality.spearman},
            {"auc", row.quality.auc[0]}, {"gain", row.quality.gain}};
}

std::string htmlOf(const std::vector<Row>& rows, const std::string& scene) {
    Report report;
    report.title = "Figure 10: real error, estimated error, difference";
    report.summary = scene + "; each picture: estimated, real, their difference";
    ReportTable table{"Estimate against real error", {"view", "pass", "mode"}, {}};
    const Json names = toJson(rows.front());
    for (const auto& [name, value] : names.items())
        if (value.is_number() || value.is_null())
            table.head.push_back(name);
    for (const Row& row : rows) {
        report.pictures.push_back({row.pass + ", " + row.mode, row.view, row.strip});
        std::vector<std::string>& cells = table.rows.emplace_back();
        cells = {row.view, row.pass, row.mode};
        for (const double value :
             {row.mae, row.rmse, row.quality.spearman, row.quality.auc[0], row.quality.gain}) {
            char cell[32];
            std::snprintf(cell, sizeof cell, "%.4f", value);
            cells.emplace_back(cell);
        }
    }
    report.tables.push_back(std::move(table));
    return toHtml(report);
}

void printTable(const std::vector<Row>& rows, std::ostream& out) {
    const auto line = [&out](const char* pattern, auto... values) {
        char buffer[256];
        std::snprintf(buffer, sizeof buffer, pattern, values...);
        out << buffer;
    };
    line("%-24s %-12s %-10s %9s %9s %9s %9s %9s\n", "view", "pass", "mode", "MAE", "RMSE",
         "Spearman", "AUC", "gain");
    for (const Row& row : rows)
        line("%-24s %-12s %-10s %9.5f %9.5f %9.4f %9.4f %9.4f\n", row.view.c_str(),
             row.pass.c_str(), row.mode.c_str(), row.mae, row.rmse, row.quality.spearman,
             row.quality.auc[0], row.quality.gain);
}

} // namespace

int benchFigure10(const MeasureArguments& arguments, const Console& console) {
    requireWritableDirectory(arguments.output_directory);
    MeasureStage stage(arguments, console);
    std::vector<Row> rows;
    for (const MeasureView& place : stage.views()) {
        const JudgedView view = stage.judge(place);
        for (std::size_t k = 0; k < stage.metrics().size(); ++k)
            if (const GraphMetric& combiner = stage.metrics()[k]; !combiner.mode.empty())
                rows.push_back(rowOf(view, view.metrics[k], combiner));
    }
    if (rows.empty())
        throw GraphError(arguments.graph + ": no pass of type combine outside loops");

    const std::string folder = arguments.output_directory;
    writePng(folder + "/figure10.png", sheetOf(rows));
    const std::string html = htmlOf(rows, stage.scene().name);
    writeFileAtomically(folder + "/figure10.html", std::as_bytes(std::span(html)));
    if (arguments.json) {
        Json all = Json::array();
        for (const Row& row : rows)
            all.push_back(toJson(row));
        print(console.out, {{"graph", arguments.graph},
                            {"scene", stage.scene().name},
                            {"size", {arguments.size.x, arguments.size.y}},
                            {"rows", std::move(all)},
                            {"files", {folder + "/figure10.png", folder + "/figure10.html"}}});
    } else {
        printTable(rows, console.out);
    }
    console.err << "wrote " << folder << "/figure10.png and figure10.html\n";
    return kOk;
}

} // namespace hone::cli

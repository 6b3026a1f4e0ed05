// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/table1.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <ostream>

namespace hone::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kBaseline =
    "PRT: prt.json, all pixels at once in tile order, coherent packets for primary and shadow rays";

/// PRT and SIR milliseconds of the paper's Table 1 by size and share of error pixels.
struct PaperRow {
    uvec2 size;
    double share, prt_ms, sir_ms;
};
constexpr PaperRow kPaper[] = {
    {{800, 600}, .40, 440, 406},    {{800, 600}, .20, 312, 230},   {{800, 600}, .05, 203, 79},
    {{800, 600}, .01, 145, 45},     {{1024, 768}, .40, 640, 587},  {{1024, 768}, .20, 305, 185},
    {{1024, 768}, .05, 238, 84},    {{1024, 768}, .01, 201, 52},   {{1920, 1080}, .40, 1510, 1463},
    {{1920, 1080}, .20, 1107, 901}, {{1920, 1080}, .05, 639, 243}, {{1920, 1080}, .01, 484, 113}};

std::string text(uvec2 size) {
    return std::to_string(size.x) + "x" + std::to_string(size.y);
}

Json numbers(vec3 v) {
    return {v.x, v.y, v.z};
}

} // namespace

Table1Share shareOf(std::string_view pass_type) {
    if (pass_type == "raster" || pass_type == "depth_of_field")
        return Table1Share::kRaster;
    if (pass_type == "sort")
        return Table1Share::kSort;
    if (pass_type == "combine" || pass_type.starts_with("error.") ||
        pass_type.starts_with("weight."))
        return Table1Share::kMetric;
    return Table1Share::kRefine;
}

std::optional<double> Table1Row::paperRatio() const {
    if (samples != 1)
        return std::nullopt;
    for (const PaperRow& row : kPaper)
        if (row.size == size && row.share == view.wanted_share)
            return row.sir_ms / row.prt_ms;
    return std::nullopt;
}

Json Table1::json() const {
    Json list = Json::array();
    for (const Table1Row& row : rows) {
        const std::optional<double> paper = row.paperRatio();
        Json passes = Json::object();
        for (const auto& [name, ms] : row.passes)
            passes[name] = ms;
        list.push_back({{"size", text(row.size)},
                        {"samples", row.samples},
                        {"camera",
                         {{"name", row.view.camera.name},
                          {"position", numbers(row.view.camera.position)},
                          {"target", numbers(row.view.camera.target)}}},
                        {"wanted_share", row.view.wanted_share},
                        {"error_share", row.error_share},
                        {"f_c", row.f_c},
                        {"raster_share", row.raster_share},
                        {"metric_share", row.metric_share},
                        {"sort_share", row.sort_share},
                        {"prt_ms", row.prt_ms},
                        {"sir_ms", row.sir_ms},
                        {"ratio", row.ratio},
                        {"limit", row.limit()},
                        {"ok", row.ratio <= row.limit()},
                        {"paper_ratio", paper ? Json(*paper) : Json(nullptr)},
                        {"passes", passes}});
    }
    return {{"baseline", kBaseline}, {"rows", list}};
}

void Table1::print(std::ostream& out) const {
    const auto line = [&out](const char* pattern, auto... values) {
        char buffer[256];
        std::snprintf(buffer, sizeof buffer, pattern, values...);
        out << buffer;
    };
    out << kBaseline << "\n\n";
    line("%-10s %7s %-9s %7s %6s %7s %8s %6s %9s %9s %7s %7s %7s\n", "size", "samples", "view",
         "error", "f_c", "raster", "metrics", "sort", "PRT ms", "SIR ms", "ratio", "limit",
         "paper");
    for (const Table1Row& row : rows) {
        line("%-10s %7u %-9s %6.1f%% %6.3f %7.3f %8.3f %6.3f %9.1f %9.1f %7.3f %7.3f",
             text(row.size).c_str(), row.samples, row.view.camera.name.c_str(),
             100 * row.error_share, row.f_c, row.raster_share, row.metric_share, row.sort_share,
             row.prt_ms, row.sir_ms, row.ratio, row.limit());
        if (const std::optional<double> paper = row.paperRatio())
            line(" %7.3f", *paper);
        else
            line(" %7s", "");
        out << (row.ratio <= row.limit() ? "  ok\n" : "  missed\n");
    }
    out << "\nerror: pixels that the metrics flag. f_c: the share of PRT's rays that those take. "
           "raster, metrics, sort: their time as a share of PRT's. limit: f_c + raster + 0.05. "
           "paper: SIR / PRT as printed there.\n";
}

bool Table1::allMet() const {
    return std::ranges::all_of(rows, [](const Table1Row& row) { return row.ratio <= row.limit(); });
}

void makeLightsPoints(Scene& scene) {
    for (Light& light : scene.lights) {
        const float parallelogram = glm::length(glm::cross(light.half_u, light.half_v));
        if (light.kind == kLightRectangle)
            light.intensity *= 4.0f * parallelogram;
        else if (light.kind == kLightDisc)
            light.intensity *= std::numbers::pi_v<float> * parallelogram;
        else if (light.kind == kLightSphere)
            light.intensity *= std::numbers::pi_v<float> * light.radius * light.radius;
        light.radius = 0; // a sun becomes parallel light
        if (light.kind == kLightDirectional || light.kind == kLightSpot)
            continue;
        light.kind = kLightPoint;
    }
    touch(scene);
}

} // namespace hone::cli

// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/svg_plot.h"

#include "hone/cli/color_map.h"
#include "hone/cli/report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace hone::cli {
namespace {

// In pixels of the drawing.
constexpr double kWidth = 690, kHeight = 420;
constexpr double kLeft = 64, kRight = 230, kTop = 36, kBottom = 52;
constexpr double kPlotWidth = kWidth - kLeft - kRight, kPlotHeight = kHeight - kTop - kBottom;

/// Colours that people with any colour vision tell apart (Okabe, Ito 2008), black first.
constexpr std::array kColors{"#000000", "#e69f00", "#56b4e9", "#009e73",
                             "#d55e00", "#0072b2", "#cc79a7", "#998f00"};

std::string text(const char* pattern, auto... values) {
    char buffer[512];
    std::snprintf(buffer, sizeof buffer, pattern, values...);
    return buffer;
}

std::string label(double x, double y, const char* anchor, const std::string& words,
                  const char* more = "") {
    return text("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\"%s>", x, y, anchor, more) +
           escapeHtml(words) + "</text>\n";
}

/// A round number near a fifth of the axis.
double tickOf(double end) {
    const double decade = std::pow(10.0, std::floor(std::log10(end / 5)));
    const double rest = end / 5 / decade;
    return decade * (rest < 1.5 ? 1 : rest < 3.5 ? 2 : rest < 7.5 ? 5 : 10);
}

std::string axes(const Plot& plot) {
    std::string svg;
    const double x_tick = tickOf(plot.x_end), y_tick = tickOf(plot.y_end);
    for (int k = 0; k * x_tick <= plot.x_end * 1.001; ++k) {
        const double x = kLeft + kPlotWidth * k * x_tick / plot.x_end;
        svg += text("<path d=\"M%.1f %.1fv%.1f\" stroke=\"#ddd\"/>\n", x, kTop, kPlotHeight);
        svg += label(x, kHeight - kBottom + 18, "middle", text("%g", k * x_tick));
    }
    for (int k = 0; k * y_tick <= plot.y_end * 1.001; ++k) {
        const double y = kHeight - kBottom - kPlotHeight * k * y_tick / plot.y_end;
        svg += text("<path d=\"M%.1f %.1fh%.1f\" stroke=\"#ddd\"/>\n", kLeft, y, kPlotWidth);
        svg += label(kLeft - 8, y + 4, "end", text("%g", k * y_tick));
    }
    svg += label(kLeft + kPlotWidth / 2, kHeight - 12, "middle", plot.x_label);
    svg +=
        label(-(kTop + kPlotHeight / 2), 16, "middle", plot.y_label, " transform=\"rotate(-90)\"");
    svg += label(kLeft, 22, "start", plot.title, " font-weight=\"bold\"");
    return svg;
}

std::string cells(const PlotGrid& grid) {
    std::string svg;
    if (grid.columns == 0 || grid.rows == 0)
        return svg;
    const double most = *std::ranges::max_element(grid.counts);
    const double width = kPlotWidth / grid.columns, height = kPlotHeight / grid.rows;
    for (uint row = 0; row < grid.rows; ++row)
        for (uint column = 0; column < grid.columns; ++column) {
            const double count = grid.counts[std::size_t{row} * grid.columns + column];
            if (!(count > 0))
                continue;
            const vec3 color =
                255.0f * heatColor(static_cast<float>(std::log1p(count) / std::log1p(most)));
            svg += text("<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" "
                        "fill=\"rgb(%.0f,%.0f,%.0f)\"/>\n",
                        kLeft + column * width, kHeight - kBottom - (row + 1) * height, width + 0.2,
                        height + 0.2, static_cast<double>(color.x), static_cast<double>(color.y),
                        static_cast<double>(color.z));
        }
    return svg;
}

std::string lines(const Plot& plot) {
    std::string svg;
    for (std::size_t k = 0; k < plot.lines.size(); ++k) {
        const PlotLine& line = plot.lines[k];
        // Colours come again after the last: dotted, then.
        const char* dashes = line.is_dashed        ? " stroke-dasharray=\"5 4\""
                             : k >= kColors.size() ? " stroke-dasharray=\"1.5 2.5\""
                                                   : "";
        const std::string stroke = text("fill=\"none\" stroke-width=\"1.8\" stroke=\"%s\"%s",
                                        kColors[k % kColors.size()], dashes);
        std::string path;
        for (const auto& [x, y] : line.points)
            if (std::isfinite(x) && std::isfinite(y))
                path += text("%c%.2f %.2f", path.empty() ? 'M' : 'L',
                             kLeft + kPlotWidth * x / plot.x_end,
                             kHeight - kBottom - kPlotHeight * y / plot.y_end);
        svg += "<path d=\"" + path + "\" " + stroke + " clip-path=\"url(#inside)\"/>\n";
        const double y = kTop + 8 + 18 * static_cast<double>(k);
        svg += text("<path d=\"M%.1f %.1fh22\" ", kWidth - kRight + 12, y) + stroke + "/>\n";
        svg += label(kWidth - kRight + 40, y + 4, "start", line.name);
    }
    return svg;
}

} // namespace

std::string toSvg(const Plot& plot) {
    std::string svg =
        text("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %g %g\" width=\"%g\" "
             "height=\"%g\" font-family=\"system-ui,sans-serif\" font-size=\"12\">\n",
             kWidth, kHeight, kWidth, kHeight);
    svg += text("<rect width=\"%g\" height=\"%g\" fill=\"#fff\"/>\n", kWidth, kHeight);
    svg += text("<clipPath id=\"inside\"><rect x=\"%g\" y=\"%g\" width=\"%g\" height=\"%g\"/>"
                "</clipPath>\n",
                kLeft, kTop, kPlotWidth, kPlotHeight);
    svg += axes(plot) + cells(plot.grid) + lines(plot);
    return svg + text("<rect x=\"%g\" y=\"%g\" width=\"%g\" height=\"%g\" fill=\"none\" "
                      "stroke=\"#333\"/>\n</svg>\n",
                      kLeft, kTop, kPlotWidth, kPlotHeight);
}

} // namespace hone::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/math.h"

#include <string>
#include <vector>

namespace hone::cli {

struct PlotLine {
    std::string name;
    std::vector<std::pair<double, double>> points; ///< what is not finite is left out
    bool is_dashed = false;
};

/// How many of a plot's items fall into each cell of a grid.
struct PlotGrid {
    uint columns = 0, rows = 0; ///< 0 = no grid
    std::vector<double> counts; ///< columns from the left, rows from the bottom
};

/// Lines over two axes that begin at 0, and cells below them, coloured by the logarithm of their
/// count.
struct Plot {
    std::string title;
    std::string x_label, y_label;
    double x_end = 1, y_end = 1; ///< greater than 0
    PlotGrid grid;
    std::vector<PlotLine> lines;
};

/// A drawing for browsers and papers (SVG 1.1): text stays text, no script, no outside file. All
/// text is escaped.
[[nodiscard]] std::string toSvg(const Plot& plot);

} // namespace hone::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/cli/view_choice.h"

#include <nlohmann/json.hpp>

#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hone::cli {

/// What a pass's time counts as.
enum class Table1Share : std::uint8_t { kRaster, kMetric, kSort, kRefine };
[[nodiscard]] Table1Share shareOf(std::string_view pass_type);

/// One view at one size: refined where it is wrong against ray-traced whole. Shares are parts of
/// prt_ms.
struct Table1Row {
    uvec2 size{0, 0};
    uint samples = 1;
    ChosenView view;
    double error_share = 0; ///< of the pixels
    double f_c = 0;         ///< of PRT's rays: what the error pixels alone would cost
    double raster_share = 0;
    double metric_share = 0;
    double sort_share = 0;
    double prt_ms = 0, sir_ms = 0; ///< medians
    double ratio = 0;              ///< sir_ms / prt_ms, the median of what ran side by side
    std::vector<std::pair<std::string, double>> passes{}; ///< of SIR with their milliseconds

    /// What `ratio` is held to: what has to be done, and a twentieth of PRT on top.
    [[nodiscard]] double limit() const { return f_c + raster_share + 0.05; }
    /// SIR / PRT as Amann, Chajdas, Westermann 2012, Table 1 print it for this size and share;
    /// their views, scene and machine were others.
    [[nodiscard]] std::optional<double> paperRatio() const;
};

struct Table1 {
    std::vector<Table1Row> rows;

    /// {"baseline", "rows": [{size, samples, camera, error_share, f_c, raster_share, ..., passes:
    /// {name: ms}}]}
    [[nodiscard]] nlohmann::ordered_json json() const;
    void print(std::ostream& out) const;
    [[nodiscard]] bool allMet() const;
};

/// The paper's light: each light that has an extent becomes a point at its centre that sends out as
/// much.
void makeLightsPoints(Scene& scene);

} // namespace hone::cli

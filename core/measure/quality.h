// SPDX-License-Identifier: Apache-2.0
//
// All that is said of one error metric in one view, and of one in many views.
#pragma once

#include "hone/core/math.h"
#include "hone/core/measure/ranking.h"

#include <array>
#include <functional>
#include <span>
#include <vector>

namespace hone {

/// Errors above so many 255ths count: what a screen of 8 bits may show.
inline constexpr std::array<uint, 5> kThresholds{1, 2, 4, 8, 16};
template <class T> using ByThreshold = std::array<T, kThresholds.size()>;
[[nodiscard]] constexpr float thresholdValue(uint threshold) {
    return static_cast<float>(threshold) / 255.0f;
}

/// Shares of the squared error whose costs are told.
inline constexpr std::array<double, 2> kShares{0.1, 0.01};

/// What is known of a view: lists of one number a pixel.
struct ViewTruth {
    uvec2 extent{0, 0};
    std::span<const float> error;  ///< real error, display units (realError().max)
    std::span<const float> square; ///< its square (realError().square)
    std::span<const float> cost;   ///< rays that tracing the pixel takes; empty = 1 each
    std::span<const float> noise;  ///< standard error of the truth, display units; empty = exact
};

/// Pixels of which nobody can say whether their error is above a threshold: the truth's standard
/// error is more than a quarter of the threshold, and the error less than three standard errors
/// away from it. They are left out.
[[nodiscard]] std::vector<bool> undecidable(const ViewTruth& truth, uint threshold);

/// How good an estimate is, in one view.
struct MetricQuality {
    ByThreshold<Detection> detection; ///< worst_miss only where it is above the threshold, else 0
    ByThreshold<double> auc{};        ///< NaN where there is nothing to tell apart
    ByThreshold<double> average_precision{};
    double spearman = 0; ///< of expect and the error
    Calibration calibration;
    Convergence by_pixels, by_rays; ///< MSE while pixels are refined in this order
    std::array<double, 2> pixels_until{}, rays_until{}; ///< cost until each of kShares is left
    double gain = 0, gain_by_rays = 0;
    /// The same among the pixels that the gate lets through: what the order is worth without what
    /// the gate is worth. AUC at the first threshold.
    double auc_flagged = 0, gain_flagged = 0;
};
/// `expect` orders and `bound` gates, one each a pixel, finite.
[[nodiscard]] MetricQuality judge(const ViewTruth& truth, std::span<const float> expect,
                                  std::span<const float> bound);

/// An order that knows nothing of errors, as a score to rank pixels by.
struct BlindOrder {
    const char* name;
    std::vector<float> score;
};
/// random: all the same, since ties count as random; scanline: rows from the top; checkerboard:
/// every second pixel first, row by row, then the others.
[[nodiscard]] std::vector<BlindOrder> blindOrders(uvec2 extent);

/// A number over several views, those left out where it is not defined (NaN); NaN if it never is.
struct OverViews {
    double mean = 0;
    double worst = 0;
};
enum class Better { kGreater, kLess, kNearOne };
[[nodiscard]] OverViews overViews(std::span<const double> values, Better better);

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
//
// How good an estimate of the error is, against the real one: pure statistics over pixels. All take
// finite numbers, one a pixel, lists of equal length; sums run in double and in pixel order or in
// the order of the ranking, so results are the same everywhere.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace hone {

/// Pixels by score, greatest first; equal scores by pixel.
[[nodiscard]] std::vector<std::uint32_t> rankByScore(std::span<const float> score);

/// How well a gate finds the pixels whose error is above a threshold.
struct Detection {
    double recall = 1;     ///< of the pixels above, the share that the gate lets through; 1 if none
    double precision = 1;  ///< of those let through, the share that is above; 1 if none
    double flagged = 0;    ///< share of all pixels that the gate lets through
    double positives = 0;  ///< share of all pixels that are above
    double worst_miss = 0; ///< greatest error that the gate stops
    double missed_energy =
        0; ///< share of the summed squared error that it stops; 0 if there is none
};

/// The gate is `bound > 0` (Amann, Chajdas, Westermann 2012: E > 0); a pixel is above if its error
/// exceeds `threshold`.
[[nodiscard]] Detection detect(std::span<const float> error, std::span<const float> bound,
                               float threshold);

/// The chance that a pixel above the threshold has a greater score than one that is not, ties
/// counted half (area under the ROC curve; Fawcett, An Introduction to ROC Analysis, 2006). NaN
/// where all pixels are on one side.
[[nodiscard]] double rocAuc(std::span<const float> error, std::span<const float> score,
                            float threshold);

/// Mean of the precision at each pixel above the threshold, taken by descending score; inside a
/// tie, expected over its orders to first order: the precision grows linearly through the tie. NaN
/// where no pixel is above.
[[nodiscard]] double averagePrecision(std::span<const float> error, std::span<const float> score,
                                      float threshold);

/// Pearson's correlation of ranks, ties given their mean rank (Spearman 1904). NaN where either
/// list is constant.
[[nodiscard]] double spearman(std::span<const float> a, std::span<const float> b);

/// How `expect` scales: least squares of error = slope * expect + offset, and the expected
/// calibration error: the mean over 20 bins of as many pixels each, by expect, of |mean error -
/// mean expect|.
struct Calibration {
    double slope = 0; ///< NaN where expect is constant
    double offset = 0;
    double expected_error = 0;
};
[[nodiscard]] Calibration calibrate(std::span<const float> error, std::span<const float> expect);

/// What remains of the summed squared error while pixels are refined one after another, their error
/// set to 0.
struct Convergence {
    /// After each tie, from (0, 1): the share of the cost spent, and of the squared error left.
    struct Point {
        double cost = 0;
        double left = 1;
    };
    std::vector<Point> curve;
    double area = 0.5; ///< below the curve: 1/2 for random order; NaN where there is no error

    /// The share of the cost at which `left` of the squared error is left.
    [[nodiscard]] double costUntil(double left) const;
    /// The share of the squared error left at a share of the cost in [0,1].
    [[nodiscard]] double leftAt(double cost) const;
};

/// Refines by descending score; equal scores in random order, so the curve is straight through a
/// tie. `cost`: of each pixel, positive; empty for 1 each.
[[nodiscard]] Convergence converge(std::span<const float> squared_error,
                                   std::span<const float> score, std::span<const float> cost);
/// The best order there is: by squared error per cost.
[[nodiscard]] Convergence convergeOracle(std::span<const float> squared_error,
                                         std::span<const float> cost);

/// (1/2 - area) / (1/2 - oracle): 1 for the oracle's order, 0 for a random one, negative for a
/// harmful one. NaN where every order is as good.
[[nodiscard]] double gain(const Convergence& order, const Convergence& oracle);

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
//
// Weights of a linear combination of error metrics, fitted to the real error (Amann, Chajdas,
// Westermann 2012, section 3.4, which searches at random).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace hone {

/// J(w) = sum over pixels of (sum_i w_i E_i - e)^2 as a quadratic form, so that J of any weights
/// costs n^2 and no pixel is looked at again. Forms of several views add up.
class SquaredResidual {
public:
    explicit SquaredResidual(std::size_t metrics);

    /// Adds a view: `metrics` lists of one estimate a pixel, and the real error. Sums run in double
    /// and in pixel order.
    void add(std::span<const std::vector<float>> metrics, std::span<const float> error);
    void add(const SquaredResidual& other);

    [[nodiscard]] std::size_t metrics() const { return moment_.size(); }
    [[nodiscard]] std::size_t pixels() const { return pixels_; }
    /// J; never negative.
    [[nodiscard]] double at(std::span<const double> weights) const;
    /// Half of its gradient: Gw - g.
    [[nodiscard]] std::vector<double> slope(std::span<const double> weights) const;
    [[nodiscard]] double gram(std::size_t i, std::size_t j) const {
        return gram_[i * metrics() + j];
    }
    [[nodiscard]] std::span<const double> moment() const { return moment_; }

private:
    std::vector<double> gram_;   ///< G = sum E E^T, row by row
    std::vector<double> moment_; ///< g = sum E e
    double energy_ = 0;          ///< sum e^2
    std::size_t pixels_ = 0;
};

struct RandomSearch {
    std::uint64_t tuples = 1000;
    double greatest = 1; ///< weights are uniform in [0, greatest]
    std::uint64_t seed = 0;
};
/// The best of so many random tuples: the paper's way (it gives neither number nor range).
[[nodiscard]] std::vector<double> fitAtRandom(const SquaredResidual& residual,
                                              const RandomSearch& search);

/// The least J that weights >= 0 can have: non-negative least squares. Tries every set of metrics
/// that may have a weight, at most 2^8 (InPort::kMaxEdges), so the optimum is global by exhaustion.
/// A set whose metrics depend on each other is passed over: one with fewer of them is as good, so
/// that collinear metrics need no ridge. Throws std::logic_error for more than 16 metrics.
[[nodiscard]] std::vector<double> fitNonNegative(const SquaredResidual& residual);

/// How far weights are from the optimum's conditions (Karush, Kuhn, Tucker), relative to |g|: the
/// slope is 0 where a weight is positive and not negative where it is 0.
[[nodiscard]] double optimalityResidual(const SquaredResidual& residual,
                                        std::span<const double> weights);

} // namespace hone

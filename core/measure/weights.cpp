// SPDX-License-Identifier: Apache-2.0
#include "hone/core/measure/weights.h"

#include "hone/core/error.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <random>

namespace hone {
namespace {

/// Solves G w = g for the metrics of `members` by Cholesky's decomposition; nothing where they
/// depend on each other.
std::optional<std::vector<double>> solve(const SquaredResidual& residual,
                                         std::span<const std::size_t> members) {
    // Below this share of its diagonal a pivot is rounding.
    constexpr double kLeastPivot = 1e-12;
    const std::size_t n = members.size();
    std::vector<double> lower(n * n), solution(n);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = residual.gram(members[i], members[j]);
            for (std::size_t k = 0; k < j; ++k)
                sum -= lower[i * n + k] * lower[j * n + k];
            if (i != j) {
                lower[i * n + j] = sum / lower[j * n + j];
                continue;
            }
            if (!(sum > kLeastPivot * residual.gram(members[i], members[i])))
                return std::nullopt;
            lower[i * n + i] = std::sqrt(sum);
        }
    for (std::size_t i = 0; i < n; ++i) {
        double sum = residual.moment()[members[i]];
        for (std::size_t k = 0; k < i; ++k)
            sum -= lower[i * n + k] * solution[k];
        solution[i] = sum / lower[i * n + i];
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t k = i + 1; k < n; ++k)
            solution[i] -= lower[k * n + i] * solution[k];
        solution[i] /= lower[i * n + i];
    }
    return solution;
}

} // namespace

SquaredResidual::SquaredResidual(std::size_t metrics)
    : gram_(metrics * metrics), moment_(metrics) {}

void SquaredResidual::add(std::span<const std::vector<float>> metrics,
                          std::span<const float> error) {
    const std::size_t n = moment_.size();
    HONE_ASSERT(metrics.size() == n, "one list a metric");
    for (const std::vector<float>& metric : metrics)
        HONE_ASSERT(metric.size() == error.size(), "one estimate a pixel");
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = 0;
            for (std::size_t pixel = 0; pixel < error.size(); ++pixel)
                sum += double{metrics[i][pixel]} * double{metrics[j][pixel]};
            gram_[i * n + j] += sum;
            if (i != j)
                gram_[j * n + i] += sum;
        }
        for (std::size_t pixel = 0; pixel < error.size(); ++pixel)
            moment_[i] += double{metrics[i][pixel]} * double{error[pixel]};
    }
    for (const float e : error)
        energy_ += double{e} * double{e};
    pixels_ += error.size();
}

void SquaredResidual::add(const SquaredResidual& other) {
    HONE_ASSERT(other.moment_.size() == moment_.size(), "forms of the same metrics");
    const auto plus = [](std::vector<double>& sums, const std::vector<double>& terms) {
        std::ranges::transform(sums, terms, sums.begin(), std::plus{});
    };
    plus(gram_, other.gram_);
    plus(moment_, other.moment_);
    energy_ += other.energy_;
    pixels_ += other.pixels_;
}

double SquaredResidual::at(std::span<const double> weights) const {
    double sum = energy_;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        for (std::size_t j = 0; j < weights.size(); ++j)
            sum += weights[i] * gram(i, j) * weights[j];
        sum -= 2 * weights[i] * moment_[i];
    }
    return std::max(sum, 0.0); // rounding may leave a perfect fit below 0
}

std::vector<double> SquaredResidual::slope(std::span<const double> weights) const {
    std::vector<double> result(moment_.size());
    for (std::size_t i = 0; i < result.size(); ++i) {
        for (std::size_t j = 0; j < result.size(); ++j)
            result[i] += gram(i, j) * weights[j];
        result[i] -= moment_[i];
    }
    return result;
}

std::vector<double> fitAtRandom(const SquaredResidual& residual, const RandomSearch& search) {
    // Not std::uniform_real_distribution, whose numbers each library makes its own way.
    std::mt19937_64 random(search.seed);
    std::vector<double> best(residual.metrics()), weights(residual.metrics());
    double least = residual.at(best);
    for (std::uint64_t tuple = 0; tuple < search.tuples; ++tuple) {
        for (double& weight : weights)
            weight = search.greatest * static_cast<double>(random() >> 11u) * 0x1p-53;
        if (const double j = residual.at(weights); j < least) {
            least = j;
            best = weights;
        }
    }
    return best;
}

std::vector<double> fitNonNegative(const SquaredResidual& residual) {
    const std::size_t n = residual.metrics();
    HONE_ASSERT(n <= 16, "too many metrics to try every set of them");
    std::vector<double> best(n), weights(n);
    // What weights save is g^T w where the slope of J is 0: unlike J itself it does not cancel.
    double most_saved = 0;
    std::vector<std::size_t> members;
    for (std::uint32_t set = 1; set < 1u << n; ++set) {
        members.clear();
        for (std::size_t i = 0; i < n; ++i)
            if ((set >> i & 1u) != 0)
                members.push_back(i);
        const std::optional<std::vector<double>> solution = solve(residual, members);
        if (!solution || std::ranges::any_of(*solution, [](double w) { return !(w >= 0); }))
            continue;
        std::ranges::fill(weights, 0.0);
        double saved = 0;
        for (std::size_t k = 0; k < members.size(); ++k) {
            weights[members[k]] = (*solution)[k];
            saved += residual.moment()[members[k]] * (*solution)[k];
        }
        if (saved > most_saved) {
            most_saved = saved;
            best = weights;
        }
    }
    return best;
}

double optimalityResidual(const SquaredResidual& residual, std::span<const double> weights) {
    const std::vector<double> slope = residual.slope(weights);
    double violation = 0, size = 0;
    for (std::size_t i = 0; i < slope.size(); ++i) {
        const double wrong = weights[i] > 0 ? slope[i] : std::min(slope[i], 0.0);
        violation += wrong * wrong;
        size += residual.moment()[i] * residual.moment()[i];
    }
    return size > 0 ? std::sqrt(violation / size) : std::sqrt(violation);
}

} // namespace hone

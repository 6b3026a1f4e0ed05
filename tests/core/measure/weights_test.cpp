// SPDX-License-Identifier: Apache-2.0
#include "hone/core/measure/weights.h"

#include <gtest/gtest.h>

#include <random>

namespace hone {
namespace {

/// Metrics of independent random values in [0,1], and an error made of them (SCIENCE 9, item 16).
struct Planted {
    explicit Planted(const std::vector<double>& weights, std::uint32_t seed = 1, double noise = 0)
        : metrics(weights.size()), residual(weights.size()) {
        std::mt19937 random(seed);
        const auto next = [&] { return static_cast<float>(random() & 0xffffffu) / 16777216.0f; };
        std::vector<float> error(1000);
        for (std::vector<float>& metric : metrics)
            metric.resize(error.size());
        for (std::size_t pixel = 0; pixel < error.size(); ++pixel) {
            double sum = noise * (next() - 0.5);
            for (std::size_t i = 0; i < weights.size(); ++i) {
                metrics[i][pixel] = next();
                sum += weights[i] * metrics[i][pixel];
            }
            error[pixel] = static_cast<float>(sum);
        }
        residual.add(metrics, error);
    }

    std::vector<std::vector<float>> metrics;
    SquaredResidual residual;
};

TEST(SquaredResidual, IsTheSumOverPixels) {
    SquaredResidual residual(2);
    residual.add(std::vector<std::vector<float>>{{1, 2}, {3, 0}}, std::vector<float>{4, 1});
    // (2 * 1 + 3 - 4)^2 + (2 * 2 + 0 - 1)^2
    EXPECT_DOUBLE_EQ(residual.at(std::vector<double>{2, 1}), 1 + 9);
    // Half the gradient: sum of E_i times the residual.
    EXPECT_EQ(residual.slope(std::vector<double>{2, 1}), (std::vector<double>{1 + 6, 3}));
}

TEST(SquaredResidual, AddsViews) {
    const Planted a({0.5, 1}, 1), b({1, 0.25}, 2);
    SquaredResidual both = a.residual;
    both.add(b.residual);
    const std::vector<double> weights{0.3, 0.6};
    EXPECT_DOUBLE_EQ(both.at(weights), a.residual.at(weights) + b.residual.at(weights));
    EXPECT_EQ(both.pixels(), 2000u);
}

TEST(FitNonNegative, RecoversPlantedWeights) {
    const std::vector<double> weights = fitNonNegative(Planted({0.7, 0.2}).residual);
    EXPECT_NEAR(weights[0], 0.7, 1e-6);
    EXPECT_NEAR(weights[1], 0.2, 1e-6);
}

TEST(FitNonNegative, GivesAPlantedNegativeWeightNone) {
    const SquaredResidual residual = Planted({0.7, -0.3, 0.2}).residual;
    const std::vector<double> weights = fitNonNegative(residual);
    EXPECT_GT(weights[0], 0);
    EXPECT_EQ(weights[1], 0);
    EXPECT_LE(optimalityResidual(residual, weights), 1e-9);
}

TEST(FitNonNegative, IsNeverWorseThanRandomSearch) {
    for (std::uint32_t seed = 0; seed < 100; ++seed) {
        const SquaredResidual residual =
            Planted({0.9, -0.2, 0.4, 0.05 * seed}, seed + 1, 0.5).residual;
        const std::vector<double> weights = fitNonNegative(residual);
        EXPECT_LE(residual.at(weights), residual.at(fitAtRandom(residual, {.seed = seed})));
        EXPECT_LE(optimalityResidual(residual, weights), 1e-9) << seed;
    }
}

// Two metrics that are one: any split of the weight is as good, and some is found.
TEST(FitNonNegative, NeedsNoIndependentMetrics) {
    const Planted planted({0.6});
    const std::vector<std::vector<float>> twice{planted.metrics[0], planted.metrics[0]};
    std::vector<float> error(1000);
    for (std::size_t i = 0; i < error.size(); ++i)
        error[i] = 0.5f * planted.metrics[0][i];
    SquaredResidual residual(2);
    residual.add(twice, error);
    const std::vector<double> weights = fitNonNegative(residual);
    EXPECT_NEAR(weights[0] + weights[1], 0.5, 1e-6);
}

TEST(FitNonNegative, GivesMetricsThatAreNothingNoWeight) {
    SquaredResidual residual(1);
    residual.add(std::vector<std::vector<float>>{{0, 0}}, std::vector<float>{1, 2});
    EXPECT_EQ(fitNonNegative(residual), std::vector<double>{0});
}

TEST(FitAtRandom, IsTheSameForTheSameSeedAndStaysInItsRange) {
    const SquaredResidual residual = Planted({0.9, 0.1}).residual;
    const RandomSearch search{.tuples = 100, .greatest = 0.5, .seed = 7};
    const std::vector<double> weights = fitAtRandom(residual, search);
    EXPECT_EQ(weights, fitAtRandom(residual, search));
    for (const double weight : weights) {
        EXPECT_GE(weight, 0);
        EXPECT_LE(weight, 0.5);
    }
}

} // namespace
} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/measure/ranking.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace hone {
namespace {

using Floats = std::vector<float>;

// Errors above 1/2: pixels 0, 2, 3. The gate lets 0, 1, 2 through.
TEST(Detection, CountsWhatTheGateFindsAndMisses) {
    const Detection found = detect(Floats{1, 0, 2, 3}, Floats{1, 1, 0.1f, 0}, 0.5f);
    EXPECT_DOUBLE_EQ(found.recall, 2.0 / 3);
    EXPECT_DOUBLE_EQ(found.precision, 2.0 / 3);
    EXPECT_DOUBLE_EQ(found.flagged, 0.75);
    EXPECT_DOUBLE_EQ(found.positives, 0.75);
    EXPECT_DOUBLE_EQ(found.worst_miss, 3);
    EXPECT_DOUBLE_EQ(found.missed_energy, 9.0 / 14);
}

TEST(Detection, HasPerfectRecallWhereNothingIsAbove) {
    const Detection found = detect(Floats{0, 0}, Floats{0, 0}, 0.5f);
    EXPECT_EQ(found.recall, 1);
    EXPECT_EQ(found.precision, 1);
    EXPECT_EQ(found.missed_energy, 0);
}

// An error equal to the threshold is not above it.
TEST(Detection, TakesTheThresholdItselfForNoError) {
    EXPECT_EQ(detect(Floats{0.5f}, Floats{0}, 0.5f).positives, 0);
}

TEST(RocAuc, IsOneZeroOrAHalfForGoodBadAndConstantScores) {
    const Floats error{0, 0, 1, 1};
    EXPECT_DOUBLE_EQ(rocAuc(error, Floats{1, 2, 3, 4}, 0.5f), 1);
    EXPECT_DOUBLE_EQ(rocAuc(error, Floats{4, 3, 2, 1}, 0.5f), 0);
    EXPECT_DOUBLE_EQ(rocAuc(error, Floats{7, 7, 7, 7}, 0.5f), 0.5);
}

// Pairs (positive, negative): 3 against 1 and 3, 5 against 1 and 3: 1, 1/2, 1, 1 of 4.
TEST(RocAuc, CountsTiesHalf) {
    EXPECT_DOUBLE_EQ(rocAuc(Floats{0, 0, 1, 1}, Floats{1, 3, 3, 5}, 0.5f), 3.5 / 4);
}

TEST(RocAuc, IsNotDefinedForOneClass) {
    EXPECT_TRUE(std::isnan(rocAuc(Floats{1, 1}, Floats{1, 2}, 0.5f)));
    EXPECT_TRUE(std::isnan(rocAuc(Floats{}, Floats{}, 0.5f)));
}

// By descending score: yes, no, yes. Precisions at the hits: 1 and 2/3.
TEST(AveragePrecision, IsTheMeanPrecisionAtTheHits) {
    EXPECT_DOUBLE_EQ(averagePrecision(Floats{1, 0, 1}, Floats{9, 8, 7}, 0.5f), (1 + 2.0 / 3) / 2);
    EXPECT_DOUBLE_EQ(averagePrecision(Floats{1, 1, 0}, Floats{9, 8, 7}, 0.5f), 1);
}

// One tie of everything: the precision is the share of positives all the way.
TEST(AveragePrecision, IsTheShareOfPositivesForAConstantScore) {
    EXPECT_DOUBLE_EQ(averagePrecision(Floats{1, 0, 0, 1}, Floats{5, 5, 5, 5}, 0.5f), 0.5);
}

TEST(Spearman, SeesOrderOnly) {
    EXPECT_DOUBLE_EQ(spearman(Floats{1, 2, 3}, Floats{1, 10, 1000}), 1);
    EXPECT_DOUBLE_EQ(spearman(Floats{1, 2, 3}, Floats{3, 2, 1}), -1);
    EXPECT_TRUE(std::isnan(spearman(Floats{1, 2, 3}, Floats{4, 4, 4})));
}

// Ranks 1, 2.5, 2.5, 4 and 1, 2, 3, 4: covariance 4.5 over sqrt(4.5 * 5).
TEST(Spearman, GivesTiesTheirMeanRank) {
    EXPECT_NEAR(spearman(Floats{1, 2, 2, 3}, Floats{1, 2, 3, 4}), 4.5 / std::sqrt(4.5 * 5), 1e-12);
}

TEST(Calibration, RecoversAPlantedLine) {
    Floats expect, error;
    for (int i = 0; i < 100; ++i) {
        expect.push_back(static_cast<float>(i) / 64);
        error.push_back(0.5f * expect.back() + 0.25f);
    }
    const Calibration found = calibrate(error, expect);
    EXPECT_NEAR(found.slope, 0.5, 1e-12);
    EXPECT_NEAR(found.offset, 0.25, 1e-12);
}

// Every bin of five pixels is off by 1/4 in the mean, however the pixels in it are off.
TEST(Calibration, AveragesTheBinsErrors) {
    Floats expect, error;
    for (int i = 0; i < 100; ++i) {
        expect.push_back(static_cast<float>(i / 5));
        error.push_back(expect.back() + (i % 5 == 0 ? 1.25f : 0.0f));
    }
    EXPECT_NEAR(calibrate(error, expect).expected_error, 0.25, 1e-12);
    EXPECT_EQ(calibrate(expect, expect).expected_error, 0);
}

// 3, 1 of 4 units of squared error: after the first pixel 1/4 is left, after the second nothing.
TEST(Convergence, FollowsTheOrder) {
    const Convergence best = converge(Floats{1, 3}, Floats{0, 1}, {});
    ASSERT_EQ(best.curve.size(), 3u);
    EXPECT_DOUBLE_EQ(best.curve[1].cost, 0.5);
    EXPECT_DOUBLE_EQ(best.curve[1].left, 0.25);
    EXPECT_EQ(best.curve[2].left, 0);
    EXPECT_DOUBLE_EQ(best.area, 0.5 * 0.625 + 0.5 * 0.125);
    EXPECT_DOUBLE_EQ(best.costUntil(0.25), 0.5);
    EXPECT_DOUBLE_EQ(best.costUntil(0.625), 0.25);
}

TEST(Convergence, IsOneHalfForATieOfAll) {
    EXPECT_DOUBLE_EQ(converge(Floats{5, 0, 1, 2}, Floats{1, 1, 1, 1}, {}).area, 0.5);
}

// The cheap pixel first: a quarter of the cost removes half of the error.
TEST(Convergence, CountsCost) {
    const Floats squared{2, 2}, cost{3, 1};
    const Convergence oracle = convergeOracle(squared, cost);
    EXPECT_DOUBLE_EQ(oracle.curve[1].cost, 0.25);
    EXPECT_DOUBLE_EQ(oracle.curve[1].left, 0.5);
}

TEST(Gain, IsOneForTheOracleZeroForAConstantAndNegativeForTheReverse) {
    std::mt19937 random(3);
    Floats squared(1000), reverse(1000);
    for (float& s : squared)
        s = static_cast<float>(random() % 1000) / 1000;
    std::ranges::transform(squared, reverse.begin(), [](float s) { return -s; });
    const Convergence oracle = convergeOracle(squared, {});
    EXPECT_DOUBLE_EQ(gain(converge(squared, squared, {}), oracle), 1);
    EXPECT_NEAR(gain(converge(squared, Floats(1000, 4.0f), {}), oracle), 0, 1e-12);
    EXPECT_NEAR(gain(converge(squared, reverse, {}), oracle), -1, 1e-9);
}

TEST(Gain, IsNotDefinedWithoutError) {
    const Floats none(4, 0.0f);
    EXPECT_TRUE(std::isnan(gain(converge(none, none, {}), convergeOracle(none, {}))));
}

} // namespace
} // namespace hone

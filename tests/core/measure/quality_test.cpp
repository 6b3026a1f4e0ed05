// SPDX-License-Identifier: Apache-2.0
#include "hone/core/measure/quality.h"

#include "hone/core/measure/real_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace hone {
namespace {

using Floats = std::vector<float>;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Errors of 0, 3, 6, 12 and 24 of 255.
const Floats kError{0, 3 / 255.0f, 6 / 255.0f, 12 / 255.0f, 24 / 255.0f};
const Floats kSquare{0, 9, 36, 144, 576};

TEST(RealError, IsWhatAScreenShows) {
    // 0.0025 is on the linear part of sRGB: 12.92 * 0.0025 = 0.0323. Above 1 all is white.
    const RealError error =
        realError({{2, 1}, {{0.0025f, 0, 0.0025f}, {5, 1, 1}}}, {{2, 1}, {{0, 0, 0}, {1, 1, 1}}});
    EXPECT_FLOAT_EQ(error.max[0], 0.0323f);
    EXPECT_FLOAT_EQ(error.square[0], 2 * 0.0323f * 0.0323f / 3);
    EXPECT_EQ(error.max[1], 0);
    EXPECT_EQ(error.square[1], 0);
}

TEST(RealError, CountsWhatCannotBeComparedAsOne) {
    const RealError error =
        realError({{2, 1}, {{kNan, 0, 0}, vec3(kNan)}}, {{2, 1}, {{0, 0, 0}, vec3(kNan)}});
    EXPECT_EQ(error.max, (Floats{1, 0}));
}

TEST(Judge, FindsThePerfectEstimatePerfect) {
    const MetricQuality quality = judge({{5, 1}, kError, kSquare, {}, {}}, kError, kError);
    for (std::size_t t = 0; t < kThresholds.size(); ++t) {
        EXPECT_EQ(quality.detection[t].recall, 1);
        EXPECT_EQ(quality.detection[t].worst_miss, 0);
        EXPECT_EQ(quality.auc[t], 1);
        EXPECT_EQ(quality.average_precision[t], 1);
    }
    // Flagged are 4; above 1/255: 4, above 16/255: 1.
    EXPECT_EQ(quality.detection[0].precision, 1);
    EXPECT_EQ(quality.detection[4].precision, 0.25);
    EXPECT_DOUBLE_EQ(quality.spearman, 1);
    EXPECT_NEAR(quality.calibration.slope, 1, 1e-6);
    EXPECT_DOUBLE_EQ(quality.gain, 1);
    EXPECT_DOUBLE_EQ(quality.gain_by_rays, 1);
}

TEST(Judge, FindsAConstantEstimateOfNoUse) {
    const MetricQuality quality =
        judge({{5, 1}, kError, kSquare, {}, {}}, Floats(5, 1), Floats(5, 0));
    EXPECT_EQ(quality.auc[0], 0.5);
    EXPECT_NEAR(quality.gain, 0, 1e-12);
    EXPECT_EQ(quality.detection[0].recall, 0);
    EXPECT_EQ(quality.detection[0].worst_miss, double{kError[4]});
}

// The gate finds the two great errors, the order inside is the wrong one: of the possible gain as
// much is lost.
TEST(Judge, TellsTheOrderInsideTheGateApart) {
    const MetricQuality quality =
        judge({{5, 1}, kError, kSquare, {}, {}}, Floats{0, 0, 0, 2, 1}, Floats{0, 0, 0, 1, 1});
    EXPECT_GT(quality.gain, 0.5);
    EXPECT_DOUBLE_EQ(quality.gain_flagged, -1);
    EXPECT_TRUE(std::isnan(quality.auc_flagged)); // both are above 1/255
    EXPECT_TRUE(
        std::isnan(judge({{5, 1}, kError, kSquare, {}, {}}, kError, Floats(5, 0)).gain_flagged));
}

// What is missed is no miss where it is not above the threshold: the worst here is 6 of 255.
TEST(Judge, NamesTheWorstMissOnlyAboveTheThreshold) {
    const MetricQuality quality =
        judge({{5, 1}, kError, kSquare, {}, {}}, kError, Floats{0, 0, 0, 1, 1});
    EXPECT_EQ(quality.detection[2].worst_miss, double{kError[2]}); // 4
    EXPECT_EQ(quality.detection[3].worst_miss, 0);                 // 8
}

// By pixels the last is first; by rays the pixel with a quarter of its error and a 100th of its
// cost.
TEST(Judge, WeighsErrorsByWhatTheyCost) {
    const Floats cost{1, 1, 1, 1, 100};
    const ViewTruth truth{{5, 1}, kError, kSquare, cost, {}};
    const MetricQuality by_error = judge(truth, kError, kError);
    EXPECT_DOUBLE_EQ(by_error.gain, 1);
    EXPECT_LT(by_error.gain_by_rays, 0.5);
    const MetricQuality by_worth = judge(truth, Floats{0, 9, 36, 144, 5.76f}, kError);
    EXPECT_DOUBLE_EQ(by_worth.gain_by_rays, 1);
}

// The error 3/255 with a standard error of 1/255 may be above 1/255 and 2/255, or not; at 4/255 a
// quarter of the threshold is that little. 24/255 is clearly above 1/255 although it is noisier.
TEST(Judge, LeavesOutPixelsWhoseTruthIsTooNoisy) {
    const Floats noise{0, 1 / 255.0f, 0, 0, 5 / 255.0f};
    const ViewTruth truth{{5, 1}, kError, kSquare, {}, noise};
    const std::vector<bool> none(5, false), second{false, true, false, false, false};
    EXPECT_EQ(undecidable(truth, 1), second);
    EXPECT_EQ(undecidable(truth, 2), second);
    EXPECT_EQ(undecidable(truth, 4), none);
    EXPECT_EQ(undecidable(truth, 16), (std::vector<bool>{false, false, false, false, true}));
    const MetricQuality quality = judge(truth, kError, Floats{0, 0, 1, 1, 1});
    EXPECT_EQ(quality.detection[0].recall, 1); // the miss is not judged
    EXPECT_EQ(quality.detection[0].positives, 0.75);
}

TEST(BlindOrders, GoByRowsAndByEverySecondPixel) {
    const std::vector<BlindOrder> orders = blindOrders({3, 2});
    ASSERT_EQ(orders.size(), 3u);
    EXPECT_EQ(rankByScore(orders[1].score), (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(rankByScore(orders[2].score), (std::vector<std::uint32_t>{0, 2, 4, 1, 3, 5}));
    EXPECT_EQ(converge(Floats{1, 2, 3, 4, 5, 6}, orders[0].score, {}).area, 0.5);
}

TEST(OverViews, TakesMeanAndWorstOfWhatIsDefined) {
    const double values[] = {0.5, double{kNan}, 4, 3};
    EXPECT_EQ(overViews(values, Better::kGreater).worst, 0.5);
    EXPECT_EQ(overViews(values, Better::kLess).worst, 4);
    EXPECT_EQ(overViews(values, Better::kNearOne).worst, 4);
    EXPECT_EQ(overViews(values, Better::kGreater).mean, 2.5);
    EXPECT_TRUE(std::isnan(overViews({}, Better::kLess).mean));
}

TEST(Convergence, TellsWhatIsLeft) {
    // Half the cost each; the first takes 3/4 of the error.
    const Convergence order = converge(Floats{3, 1}, Floats{2, 1}, {});
    EXPECT_DOUBLE_EQ(order.leftAt(0), 1);
    EXPECT_DOUBLE_EQ(order.leftAt(0.25), 0.625);
    EXPECT_DOUBLE_EQ(order.leftAt(0.5), 0.25);
    EXPECT_DOUBLE_EQ(order.leftAt(1), 0);
}

} // namespace
} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/support/each_build.h"

#include <gtest/gtest.h>

#include <limits>

namespace hone {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

class Combine : public EachBuild {};
HONE_ON_EACH_BUILD(Combine);

/// Three metrics at one pixel: (0.25, 0.5) weight 2, (0.5, 1) weight 0.5, (0, 0) weight 1.
vec2 combined(const char* mode) {
    PassRun run = EachBuild::pass(combinePass());
    run.extent({1, 1}).param("mode", mode);
    run.plane<vec2>("errors", {{0.25f, 0.5f}}, {2.0f});
    run.plane<vec2>("errors", {{0.5f, 1.0f}}, {0.5f});
    run.plane<vec2>("errors", {{0.0f, 0.0f}});
    return run.execute().output<vec2>("error").front();
}

TEST_P(Combine, MeanDividesByTheNumberOfMetricsAndAddsBounds) {
    EXPECT_EQ(combined("mean"), vec2(0.25f, 1.5f)); // (0.25 + 0.5 + 0) / 3
}

TEST_P(Combine, LinearAddsWeightedErrorsAndUnweightedBounds) {
    EXPECT_EQ(combined("linear"), vec2(0.75f, 1.5f)); // 2 * 0.25 + 0.5 * 0.5
}

TEST_P(Combine, MaxTakesTheLargestWeightedErrorAndTheLargestBound) {
    EXPECT_EQ(combined("max"), vec2(0.5f, 1.0f));
}

TEST_P(Combine, SumAddsErrorsAndBoundsWithoutWeights) {
    EXPECT_EQ(combined("sum"), vec2(0.75f, 1.5f)); // 0.25 + 0.5 + 0
}

TEST_P(Combine, NoisyOrIsTheChanceThatAnyEffectIsWrong) {
    EXPECT_EQ(combined("noisy_or"), vec2(0.625f, 1.5f)); // 1 - (1 - 2 * 0.25)(1 - 0.5 * 0.5)
}

TEST_P(Combine, NoisyOrIsCertainWhereOneMetricIsAndKeepsSmallChances) {
    PassRun run = EachBuild::pass(combinePass());
    run.extent({2, 1}).param("mode", "noisy_or");
    run.plane<vec2>("errors", {{0.75f, 1.0f}, {1e-12f, 0.0f}}, {4.0f}); // 3, cut at 1
    run.plane<vec2>("errors", {{0.5f, 1.0f}, {0.0f, 0.0f}});
    const std::vector<vec2> error = run.execute().output<vec2>("error");
    EXPECT_EQ(error[0], vec2(1.0f, 2.0f));
    EXPECT_EQ(error[1], vec2(4e-12f, 0.0f)); // 1 - (1 - 4e-12) would be 0
}

TEST_P(Combine, LinearIsNotCutAtOne) {
    PassRun run = EachBuild::pass(combinePass());
    run.extent({1, 1}).param("mode", "linear");
    run.plane<vec2>("errors", {{0.75f, 1.0f}}, {4.0f}).execute();
    EXPECT_EQ(run.output<vec2>("error").front(), vec2(3.0f, 1.0f));
}

TEST_P(Combine, CountsWhatIsNotFiniteAsOneAndWhatIsNegativeAsZero) {
    for (const char* mode : {"mean", "linear", "max", "noisy_or", "sum"}) {
        PassRun run = EachBuild::pass(combinePass());
        run.extent({4, 1}).param("mode", mode);
        run.plane<vec2>("errors",
                        {{kNan, kNan}, {kInfinity, -kInfinity}, {-0.5f, -1.0f}, {-0.0f, 0.25f}});
        const std::vector<vec2> error = run.execute().output<vec2>("error");
        EXPECT_EQ(error[0], vec2(1.0f, 1.0f)) << mode;
        EXPECT_EQ(error[1], vec2(1.0f, 1.0f)) << mode;
        EXPECT_EQ(error[2], vec2(0.0f, 0.0f)) << mode;
        EXPECT_EQ(error[3], vec2(0.0f, 0.25f)) << mode;
    }
}

TEST_P(Combine, StaysFiniteWhenTermsOverflow) {
    PassRun run = EachBuild::pass(combinePass());
    run.extent({1, 1}).param("mode", "linear");
    run.plane<vec2>("errors", {{3e38f, 3e38f}}, {2.0f});
    run.plane<vec2>("errors", {{3e38f, 3e38f}});
    const vec2 error = run.execute().output<vec2>("error").front();
    EXPECT_EQ(error, vec2(std::numeric_limits<float>::max()));
}

TEST_P(Combine, TakesEightMetricsEachWithItsWeight) {
    PassRun run = EachBuild::pass(combinePass());
    run.extent({1, 1}).param("mode", "linear");
    for (uint metric = 0; metric < 8; ++metric)
        run.plane<vec2>("errors", {{1.0f, 1.0f}}, {static_cast<float>(1u << metric)});
    EXPECT_EQ(run.execute().output<vec2>("error").front(), vec2(255.0f, 8.0f));
}

} // namespace
} // namespace hone

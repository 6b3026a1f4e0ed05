// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/passes.h"
#include "hone/tests/support/run_pass.h"

#include <gtest/gtest.h>

#include <limits>

namespace hone {
namespace {

std::vector<uint> countsOf(const std::vector<float>& expected, uint max_count) {
    std::vector<vec2> errors;
    for (float expect : expected)
        errors.emplace_back(expect, 1.0f);
    PassRun run(estimatePass());
    run.extent({static_cast<uint>(errors.size()), 1}).param("max_count", max_count);
    return run.plane("error", errors).execute().output<uint>("counts");
}

TEST(Estimate, GivesSamplesInProportionToTheErrorAndEachPixelOne) {
    // 8 * E / 0.5, rounded: 8, 4, 1.6 -> 2, 0.16 -> 0, which is too few.
    EXPECT_EQ(countsOf({0.5f, 0.25f, 0.1f, 0.01f, 0.0f}, 8), (std::vector<uint>{8, 4, 2, 1, 1}));
}

TEST(Estimate, GivesEachPixelOneSampleWhereNothingIsWrong) {
    EXPECT_EQ(countsOf({0, 0, 0}, 8), (std::vector<uint>{1, 1, 1}));
}

TEST(Estimate, CountsWhatIsNotFiniteAsOneAndWhatIsNegativeAsZero) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    EXPECT_EQ(countsOf({kNan, kInfinity, -kInfinity, -3, 0.5f}, 4),
              (std::vector<uint>{4, 4, 4, 1, 2}));
}

TEST(Estimate, IsExactForTheGreatestAndTheLeastNumbers) {
    const float most = std::numeric_limits<float>::max();
    EXPECT_EQ(countsOf({most, most / 2, 1.0f}, 65536), (std::vector<uint>{65536, 32768, 1}));
    const float least = std::numeric_limits<float>::denorm_min();
    EXPECT_EQ(countsOf({least, 0.0f}, 16), (std::vector<uint>{16, 1}));
}

} // namespace
} // namespace hone

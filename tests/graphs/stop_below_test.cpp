// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/graphs/refinement_fixture.h"

#include <algorithm>

namespace hone {
namespace {

using StopBelow = RefinementTest;

TEST_F(StopBelow, LeavesOnlyPixelsThatAreExpectedToBeGoodEnough) {
    open("cornell");
    const auto executor = load("sir", {{"batch", "64"}, {"threshold", "0.05"}});
    executor->run();
    const Curve& curve = *executor->output("curve").curve;
    EXPECT_EQ(curve.stop, "below");
    EXPECT_LT(curve.records.back().worst_expect, 0.05f);
    const auto error = executor->output("error").as<vec2>();
    const auto round = executor->output("round").as<uint>();
    std::size_t left = 0;
    for (std::size_t pixel = 0; pixel < round.size(); ++pixel)
        if (round[pixel] == 0) {
            EXPECT_LT(error[pixel].x, 0.05f) << "pixel " << pixel;
            ++left;
        }
    EXPECT_GT(left, 0u);
    EXPECT_LT(left, round.size());
}

} // namespace
} // namespace hone

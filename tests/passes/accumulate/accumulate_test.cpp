// SPDX-License-Identifier: Apache-2.0
#include "hone/core/trace/sample.glsl.h"
#include "hone/tests/support/each_build.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hone {
namespace {

class Accumulate : public EachBuild {};
HONE_ON_EACH_BUILD(Accumulate);

TEST_P(Accumulate, AddsAPixelsSamplesAndCountsThem) {
    PassRun run = pass(accumulatePass());
    run.extent({3, 1});
    run.list<Sample>("samples", {{{1, 2, 3}, 2}, {{4, 5, 6}, 0}, {{7, 8, 9}, 0}}, 10).execute();
    const std::vector<Accumulated> sums = run.output<Accumulated>("accumulation");
    EXPECT_EQ(sums[0].sum, vec3(11, 13, 15));
    EXPECT_EQ(sums[0].count, 2);
    EXPECT_EQ(sums[1].sum, vec3(0));
    EXPECT_EQ(sums[1].count, 0);
    EXPECT_EQ(sums[2].sum, vec3(1, 2, 3));
    EXPECT_EQ(sums[2].count, 1);
}

TEST_P(Accumulate, GoesOnFromTheSumsItIsGiven) {
    PassRun run = pass(accumulatePass());
    run.extent({1, 1}).plane<Accumulated>("accumulation", {{{1, 1, 1}, 3}});
    run.list<Sample>("samples", {{{2, 0, 0}, 0}}).execute();
    EXPECT_EQ(run.output<Accumulated>("accumulation").front().sum, vec3(3, 1, 1));
    EXPECT_EQ(run.output<Accumulated>("accumulation").front().count, 4);
}

TEST_P(Accumulate, SumsInSampleOrderHoweverSamplesAreBatched) {
    // Terms whose float sum depends on the order: 1, then many of half an ulp of 1.
    const uint count = 100;
    std::vector<Sample> samples(count, {vec3(std::ldexp(1.0f, -24)), 0});
    samples[0].radiance = vec3(1.0f);
    for (uint batch : {1u, 7u, 50u, count}) {
        PassRun run = pass(accumulatePass());
        run.extent({1, 1});
        for (uint begin = 0; begin < count; begin += batch) {
            const auto first = samples.begin() + begin;
            run.list<Sample>("samples", {first, first + std::min(batch, count - begin)}).execute();
        }
        // Each half ulp is rounded to even on its own: added first they would have counted.
        EXPECT_EQ(run.output<Accumulated>("accumulation").front().sum, vec3(1.0f)) << batch;
    }
}

} // namespace
} // namespace hone

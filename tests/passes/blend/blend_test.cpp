// SPDX-License-Identifier: Apache-2.0
#include "hone/core/trace/sample.glsl.h"
#include "hone/passes/passes.h"
#include "hone/tests/support/run_pass.h"

#include <gtest/gtest.h>

namespace hone {
namespace {

/// A pixel of raster radiance 1 with `count` samples that sum to `sum`, of which there will be 4.
vec3 blended(const char* mode, vec3 sum, uint count, bool has_base = true) {
    PassRun run(blendPass());
    run.extent({1, 1}).param("mode", mode).param("samples", 4u);
    run.list<uvec3>("requests", {{0, 0, 1}}).plane<vec3>("image", {vec3(1)});
    run.plane<Accumulated>("accumulation", {{sum, count}});
    if (has_base)
        run.plane<vec3>("base", {vec3(1)});
    return run.execute().output<vec3>("image").front();
}

TEST(Blend, ReplacesByTheMeanOfTheSamplesSoFar) {
    EXPECT_EQ(blended("replace", {1, 2, 4}, 2), vec3(0.5f, 1, 2));
}

TEST(Blend, RampsFromTheBaseByTheShareOfSamples) {
    EXPECT_EQ(blended("ramp", {5, 1, 2}, 1), vec3(2, 1, 1.25f)); // 1 + 1/4 * (mean - 1)
    EXPECT_EQ(blended("ramp", {10, 2, 4}, 2), vec3(3, 1, 1.5f)); // 1 + 2/4 * (mean - 1)
}

TEST(Blend, EndsAtExactlyTheMean) {
    // 1 + (0.1 - 1) is not 0.1 in floats; a copy is.
    EXPECT_EQ(blended("ramp", vec3(0.4f), 4), vec3(0.4f / 4.0f));
    EXPECT_NE(1.0f + 1.0f * (0.1f - 1.0f), 0.1f);
}

TEST(Blend, ReplacesWithoutABase) {
    EXPECT_EQ(blended("ramp", {1, 2, 4}, 2, false), vec3(0.5f, 1, 2));
}

TEST(Blend, KeepsTheBitsOfASingleSample) {
    PassRun run(blendPass());
    const vec3 radiance(0.1f, 1e-40f, 3e38f);
    run.extent({1, 1}).list<uvec3>("requests", {{0, 0, 1}}).plane<vec3>("image", {vec3(1)});
    run.plane<Accumulated>("accumulation", {{radiance, 1}}).execute();
    EXPECT_EQ(run.output<vec3>("image").front(), radiance);
}

TEST(Blend, WritesRequestedPixelsOnly) {
    PassRun run(blendPass());
    run.extent({3, 1}).list<uvec3>("requests", {{1, 0, 1}}, 8);
    run.plane<vec3>("image", {vec3(5), vec3(6), vec3(7)});
    run.plane<Accumulated>("accumulation", {{vec3(1), 1}, {vec3(2), 1}, {vec3(3), 1}}).execute();
    EXPECT_EQ(run.output<vec3>("image"), (std::vector<vec3>{vec3(5), vec3(2), vec3(7)}));
}

TEST(Blend, RemembersWhichRoundFirstTracedAPixel) {
    PassRun run(blendPass());
    run.extent({3, 1}).iteration(4).list<uvec3>("requests", {{0, 1, 1}, {1, 0, 1}});
    run.plane<vec3>("image", {vec3(0), vec3(0), vec3(0)}).plane<uint>("round", {2, 0, 0});
    run.plane<Accumulated>("accumulation", {{vec3(1), 2}, {vec3(2), 1}, {vec3(0), 0}}).execute();
    EXPECT_EQ(run.output<uint>("round"), (std::vector<uint>{2, 4, 0}));
}

} // namespace
} // namespace hone

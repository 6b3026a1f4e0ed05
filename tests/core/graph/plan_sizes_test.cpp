// SPDX-License-Identifier: Apache-2.0
#include "hone/core/graph/plan_sizes.h"

#include "hone/tests/support/graph_fixture.h"

namespace hone {
namespace {

class PlanSizesTest : public GraphTest {
protected:
    static std::size_t of(const CompiledGraph& graph, const PlanSizes& sizes, const char* value) {
        return sizes.values[graph.findValue(value)].value_or(0);
    }
};

// 5 x 2 pixels: planes of 10 elements, batches of 4.
TEST_F(PlanSizesTest, AreThoseThatTheExecutorAllocates) {
    for (const char* name :
         {"refinement.json", "shared_memory.json", "nested_loops.json", "last_frame.json"}) {
        const CompiledGraph graph = plan(planFile(name));
        const PlanSizes sizes = planSizes(graph, {5, 2});
        const auto executor = start(graph);
        executor->run();
        std::size_t scene_bytes = 0;
        SceneBuffers buffers(*host, scene);
        scene_bytes = buffers.bytes();
        std::size_t scratch = 0; // of x, which changes places with y
        if (name == std::string_view("nested_loops.json"))
            scratch = 120;
        EXPECT_EQ(sizes.bytes + scene_bytes + scratch, executor->bytesAllocated()) << name;
        EXPECT_EQ(sizes.unknown, 0u);
    }
}

TEST_F(PlanSizesTest, FollowListsThroughPassesAndLoops) {
    const CompiledGraph graph = plan(planFile("refinement.json"));
    const PlanSizes sizes = planSizes(graph, {5, 2});
    EXPECT_EQ(of(graph, sizes, "raster.color"), 120u);
    EXPECT_EQ(of(graph, sizes, "sort.order"), 40u);
    EXPECT_EQ(of(graph, sizes, "refine.state"), 4u);
    EXPECT_EQ(of(graph, sizes, "refine.request.requests"), 48u); // 4 of 12 bytes
    EXPECT_EQ(of(graph, sizes, "refine.trace.samples"), 64u);    // 4 of 16 bytes
    EXPECT_FALSE(sizes.values[graph.findValue("$scene")]);
}

// image and blend.image are one plane of 120 bytes, state and request.state one record of 4.
TEST_F(PlanSizesTest, SaveWhatSharesMemory) {
    EXPECT_EQ(planSizes(plan(planFile("refinement.json")), {5, 2}).saved, 124u);
    // a, c and d of 120 bytes in one.
    EXPECT_EQ(planSizes(plan(planFile("shared_memory.json")), {5, 2}).saved, 240u);
}

TEST(ByteText, HasThreeDigits) {
    EXPECT_EQ(byteText(0), "0 B");
    EXPECT_EQ(byteText(999), "999 B");
    EXPECT_EQ(byteText(1000), "1.00 kB");
    EXPECT_EQ(byteText(131072), "131 kB");
    EXPECT_EQ(byteText(999499), "999 kB");
    EXPECT_EQ(byteText(999500), "1.00 MB");
    EXPECT_EQ(byteText(5760000), "5.76 MB");
    EXPECT_EQ(byteText(24883200), "24.9 MB");
}

} // namespace
} // namespace hone

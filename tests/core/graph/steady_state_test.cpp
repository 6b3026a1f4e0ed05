// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/allocation_count.h"
#include "hone/tests/support/graph_fixture.h"

namespace hone {
namespace {

class SteadyState : public GraphTest, public testing::WithParamInterface<const char*> {};

TEST_P(SteadyState, AllocatesNothing) {
    const auto executor = start(planFile(GetParam()));
    const auto run = [&](float x) {
        camera.position.x = x;
        executor->setCamera(camera);
        executor->run();
    };
    run(1);
    run(2);
    const std::size_t before = cli::allocationCount();
    run(3);
    EXPECT_EQ(cli::allocationCount() - before, 0u);
    EXPECT_EQ(runs(*executor, "raster"), 3u);
}

INSTANTIATE_TEST_SUITE_P(All, SteadyState,
                         testing::Values("refinement.json", "shared_memory.json",
                                         "nested_loops.json"),
                         [](const auto& test) {
                             const std::string name = test.param;
                             return name.substr(0, name.find('.'));
                         });

} // namespace
} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/bench_passes.h"
#include "hone/tests/support/run_pass.h"
#include "hone/tests/support/vulkan_fixture.h"

namespace hone::cli {
namespace {

class BenchPasses : public VulkanTest {};

// The bare draw is a fair counterpart only if it draws the same faces: it covers the same pixels.
TEST_F(BenchPasses, DepthOnlyCoversThePixelsThatVisibilitySees) {
    const Scene scene = loadScene("builtin:cornell");
    const Camera camera = makeCamera(scene.camera(""));
    PassRun visibility(benchVisibilityPass(), device()), depth_only(benchDepthOnlyPass(), device());
    for (PassRun* run : {&visibility, &depth_only})
        run->extent({64, 48}).scene(scene).camera(camera).execute();
    const std::vector<Hit> hits = visibility.output<Hit>("gbuffer");
    const std::vector<float> depths = depth_only.output<float>("depth");
    ASSERT_EQ(hits.size(), depths.size());
    std::size_t seen = 0, different = 0;
    for (std::size_t pixel = 0; pixel < hits.size(); ++pixel) {
        seen += hits[pixel].instance != kNone ? 1 : 0;
        different += (hits[pixel].instance != kNone) != (depths[pixel] > 0) ? 1 : 0;
    }
    EXPECT_GT(seen, hits.size() / 2);
    EXPECT_EQ(different, 0u);
}

} // namespace
} // namespace hone::cli

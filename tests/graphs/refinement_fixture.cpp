// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/graphs/refinement_fixture.h"

#include "hone/backends/embree/embree_backend.h"
#include "hone/backends/host/host_device.h"
#include "hone/passes/passes.h"

#include <bit>

namespace hone {

void RefinementTest::open(const std::string& scene) {
    registerPasses(passes_);
    tracers_.add("embree", "", [](const Devices&) { return makeEmbreeBackend(); });
    host_ = makeHostDevice();
    scene_ = loadScene("builtin:" + scene);
    camera_ = makeCamera(scene_.camera(""));
}

std::unique_ptr<Executor> RefinementTest::load(const std::string& graph,
                                               const Overrides& overrides) {
    constexpr std::uint64_t kSeed = 3;
    const Catalog catalog{&passes_, &tracers_};
    auto executor = std::make_unique<Executor>(
        loadGraph(HONE_SOURCE_DIR "/graphs/" + graph + ".json", catalog, overrides), catalog,
        Devices{host_.get(), &device()}, kSeed);
    executor->setScene(scene_);
    executor->setCamera(camera_);
    executor->setExtent(kExtent);
    return executor;
}

std::vector<vec3> RefinementTest::colorOf(Executor& executor, const RunOptions& options) {
    executor.run(options);
    const Value& color = executor.output("color");
    const std::span<vec3> pixels = color.as<vec3>();
    EXPECT_EQ(pixels.size(), std::size_t{color.extent.x} * color.extent.y);
    return {pixels.begin(), pixels.end()};
}

testing::AssertionResult RefinementTest::areSameBits(const std::vector<vec3>& a,
                                                     const std::vector<vec3>& b) {
    std::size_t differing = 0, first = 0;
    for (std::size_t pixel = a.size(); pixel-- > 0;) {
        bool same = true;
        for (int channel = 0; channel < 3; ++channel)
            same &=
                std::bit_cast<uint>(a[pixel][channel]) == std::bit_cast<uint>(b[pixel][channel]);
        if (!same) {
            ++differing;
            first = pixel;
        }
    }
    if (differing == 0)
        return testing::AssertionSuccess();
    return testing::AssertionFailure()
           << differing << " pixels differ, first (" << first % kExtent.x << ", "
           << first / kExtent.x << "): " << a[first].x << " " << a[first].y << " " << a[first].z
           << " against " << b[first].x << " " << b[first].y << " " << b[first].z;
}

std::uint64_t RefinementTest::runsOf(const Executor& executor, const std::string& node) {
    for (const NodeReport& report : executor.nodes())
        if (report.name == node)
            return report.runs;
    ADD_FAILURE() << "no node " << node;
    return 0;
}

} // namespace hone

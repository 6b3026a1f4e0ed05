// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/brute/brute_backend.h"
#include "hone/core/trace/sample.glsl.h"
#include "hone/passes/passes.h"
#include "hone/tests/support/lens_scenes.h"
#include "hone/tests/support/run_pass.h"
#include "hone/tests/support/vulkan_fixture.h"

#include <gtest/gtest.h>

namespace hone {
namespace {

constexpr uvec2 kExtent{64, 64}; // the focal length of lensCamera() is 64 pixels

/// Samples of the pixels of the middle row.
std::vector<Sample> middleRow(const Scene& scene, const Camera& camera, uint samples,
                              Device* device = nullptr) {
    TraceBackendRegistry brute;
    brute.add("brute", "every triangle", [](const Devices&) { return makeBruteBackend(); });
    std::unique_ptr<PassRun> run = device != nullptr
                                       ? std::make_unique<PassRun>(tracePass(), *device)
                                       : std::make_unique<PassRun>(tracePass());
    std::vector<uvec3> requests;
    for (uint x = 0; x < kExtent.x; ++x)
        requests.push_back({32 * kExtent.x + x, 0, samples});
    run->extent(kExtent).scene(scene).camera(camera).tracers(brute).param("samples", samples);
    run->list("requests", requests).execute();
    EXPECT_EQ(run->counter("rays.primary"),
              camera.lens_radius > 0 ? kExtent.x * samples : kExtent.x);
    return run->output<Sample>("samples");
}

/// The mean red of each pixel of the middle row.
std::vector<float> meanRow(const Scene& scene, const Camera& camera, uint samples,
                           Device* device = nullptr) {
    std::vector<float> means(kExtent.x, 0.0f);
    for (const Sample& sample : middleRow(scene, camera, samples, device))
        means[sample.pixel % kExtent.x] += sample.radiance.x / static_cast<float>(samples);
    return means;
}

/// A half-plane of radiance 1 to the left at 2 m before a plane of radiance 0.25 at 8 m.
Scene twoPlanes() {
    const test::Card cards[] = {{.high = {0, 100}, .depth = 2, .emission = vec3(1)},
                                {.depth = 8, .emission = vec3(0.25f)}};
    return test::cardScene(cards);
}

TEST(TraceLens, BlursTheEdgeOfANearPlaneByWhatItCoversOfTheLens) {
    // Blurred over 1 * 64 * |1/4 - 1/2| = 16 pixels: I = a + (1 - a) / 4, a the part of a disc of
    // radius 8 around the pixel that lies to the left of the edge (between pixels 31 and 32).
    const std::vector<float> row = meanRow(twoPlanes(), test::lensCamera(1, 4), 1024);
    for (uint x = 0; x < kExtent.x; ++x) {
        const float covered = test::discBeyond((static_cast<float>(x) - 31.5f) / 8);
        EXPECT_NEAR(row[x], covered + 0.25f * (1 - covered), 0.004f) << x;
    }
    EXPECT_NEAR(row[35], 0.25f + 0.75f * 0.23064f,
                0.004f); // (acos t - t sqrt(1 - t^2)) / pi, t 7/16
}

TEST(TraceLens, SeesWhatIsInFocusSharply) {
    for (const Sample& sample : middleRow(twoPlanes(), test::lensCamera(1, 2), 16))
        EXPECT_EQ(sample.radiance.x, sample.pixel % kExtent.x < 32 ? 1.0f : 0.25f);
}

TEST(TraceLens, WithoutExtentIsThePinholeBitForBit) {
    const std::vector<Sample> tiny = middleRow(twoPlanes(), test::lensCamera(1e-30f, 4), 4);
    const std::vector<Sample> pinhole = middleRow(twoPlanes(), test::lensCamera(0, 4), 4);
    for (std::size_t i = 0; i < pinhole.size(); ++i)
        EXPECT_EQ(tiny[i].radiance, pinhole[i].radiance);
}

class TraceLensVulkan : public VulkanTest {};

TEST_F(TraceLensVulkan, SeesWhatTheHostSees) {
    const std::vector<float> host = meanRow(twoPlanes(), test::lensCamera(1, 4), 64);
    const std::vector<float> vulkan = meanRow(twoPlanes(), test::lensCamera(1, 4), 64, &device());
    // A lens point within rounding of the edge may see the other plane.
    for (uint x = 0; x < kExtent.x; ++x)
        EXPECT_NEAR(vulkan[x], host[x], 0.75f * 2 / 64) << x;
}

} // namespace
} // namespace hone

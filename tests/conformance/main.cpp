// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/brute/brute_backend.h"
#include "hone/backends/bvh/binned_builder.h"
#include "hone/backends/bvh/bvh_backend.h"
#include "hone/backends/embree/embree_backend.h"
#include "hone/backends/host/host_device.h"
#include "hone/backends/host/parallel_for.h"
#include "hone/backends/vulkan/vulkan_tracers.h"
#include "hone/core/plugin/plugin.h"
#include "hone/tests/conformance/conformance.h"
#include "hone/tests/support/vulkan_fixture.h"

namespace hone {
namespace {

/// Shared by all tests of the program.
Device& hostDevice() {
    static const std::unique_ptr<Device> device = makeHostDevice();
    return *device;
}

} // namespace
} // namespace hone

int main(int argc, char** argv) {
    using namespace hone;
    test::addTracer({.name = "brute", .make = makeBruteBackend, .is_brute = true});
    test::addTracer({.name = "embree", .make = makeEmbreeBackend});
    // Every mesh with two instances gets a tree of its own.
    test::addTracer({.name = "embree_instances",
                     .make = [] { return makeEmbreeBackendWith({.flatten_triangles = 0}); }});
    test::addTracer({.name = "vulkan_ray_query",
                     .make = [] { return makeRayQueryTracer(sharedVulkanDevice()); },
                     .is_slow = true,
                     .memory = [] { return &sharedVulkanDevice(); }});
    test::addTracer(
        {.name = "vulkan_ray_query_instances",
         .make = [] { return makeRayQueryTracer(sharedVulkanDevice(), {.flatten_triangles = 0}); },
         .is_slow = true,
         .memory = [] { return &sharedVulkanDevice(); }});
    // Flattened instances stand in one tree.
    test::addTracer(
        {.name = "vulkan_ray_pipeline",
         .make = [] { return makeRayPipelineTracer(sharedVulkanDevice(), {.most_apart = 0}); },
         .is_slow = true,
         .memory = [] { return &sharedVulkanDevice(); }});
    test::addTracer(
        {.name = "bvh", .make = [] { return makeBvhTracer(hostDevice(), buildBinnedBvh, {}); }});
    test::addTracer({.name = "bvh_instances", .make = [] {
                         return makeBvhTracer(hostDevice(), buildBinnedBvh,
                                              {.flatten_triangles = 0});
                     }});
    test::addTracer({.name = "vulkan_compute",
                     .make = [] { return makeBvhTracer(sharedVulkanDevice(), buildBinnedBvh, {}); },
                     .is_slow = true,
                     .memory = [] { return &sharedVulkanDevice(); }});
    test::addTracer({.name = "vulkan_compute_instances",
                     .make =
                         [] {
                             return makeBvhTracer(sharedVulkanDevice(), buildBinnedBvh,
                                                  {.flatten_triangles = 0});
                         },
                     .is_slow = true,
                     .memory = [] { return &sharedVulkanDevice(); }});
    // The example of a plug-in.
    test::addTracer({.name = "custom", .make = [] {
                         PassRegistry passes;
                         TraceBackendRegistry registry;
                         Plugin(HONE_CUSTOM_BACKEND, hostParallelFor).addTo(passes, registry);
                         return registry.create("custom", {});
                     }});
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}

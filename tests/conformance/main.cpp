// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/brute/brute_backend.h"
#include "hone/backends/embree/embree_backend.h"
#include "hone/backends/vulkan/vulkan_tracers.h"
#include "hone/tests/conformance/conformance.h"
#include "hone/tests/support/vulkan_fixture.h"

int main(int argc, char** argv) {
    using namespace hone;
    test::addTracer({.name = "brute", .make = makeBruteBackend, .is_brute = true});
    test::addTracer({.name = "embree", .make = makeEmbreeBackend});
    // Every mesh with two instances gets a tree of its own.
    test::addTracer({.name = "embree_instances",
                     .make = [] { return makeEmbreeBackendWith({.flatten_triangles = 0}); }});
    test::addTracer({.name = "vulkan_ray_query",
                     .make = [] { return makeRayQueryTracer(sharedVulkanDevice()); },
                     .is_slow = true});
    test::addTracer(
        {.name = "vulkan_ray_query_instances",
         .make = [] { return makeRayQueryTracer(sharedVulkanDevice(), {.flatten_triangles = 0}); },
         .is_slow = true});
    test::addTracer({.name = "vulkan_ray_pipeline",
                     .make = [] { return makeRayPipelineTracer(sharedVulkanDevice()); },
                     .is_slow = true});
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}

// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/backends.h"

#include "hone/backends/brute/brute_backend.h"
#include "hone/backends/bvh/bvh_backend.h"
#include "hone/backends/embree/embree_backend.h"
#include "hone/backends/embree/embree_bvh.h"
#include "hone/backends/vulkan/vulkan_tracers.h"
#include "hone/backends/vulkan_tracer.h"
#include "hone/core/trace/null_backend.h"

namespace hone {

void registerTraceBackends(TraceBackendRegistry& registry) {
    registry.add("embree", "Embree on all cores",
                 [](const Devices&) { return makeEmbreeBackend(); });
    registry.add("vulkan", "the Vulkan device, in the best way it offers", makeVulkanTracer);
    registry.add("vulkan.ray_query", "ray queries of the Vulkan device",
                 [](const Devices& devices) {
                     return makeRayQueryTracer(vulkanOf(devices, "vulkan.ray_query"));
                 });
    registry.add("vulkan.ray_pipeline", "ray pipelines of the Vulkan device",
                 [](const Devices& devices) {
                     return makeRayPipelineTracer(vulkanOf(devices, "vulkan.ray_pipeline"));
                 });
    registry.add("vulkan.compute", "compute shaders of the Vulkan device",
                 [](const Devices& devices) {
                     return makeComputeTracer(vulkanOf(devices, "vulkan.compute"));
                 });
    registry.add(
        "bvh", "the same traversal as vulkan.compute, on all cores",
        [](const Devices& devices) { return makeBvhTracer(*devices.host, buildEmbreeBvh); });
    registry.add("brute", "every ray against every triangle: the reference, for tiny scenes",
                 [](const Devices&) { return makeBruteBackend(); });
    registry.add("null", "sees nothing: what a graph costs without its rays",
                 [](const Devices&) { return makeNullBackend(); });
}

} // namespace hone

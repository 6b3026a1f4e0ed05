// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan_tracer.h"

#include "hone/backends/bvh/bvh_backend.h"
#include "hone/backends/embree/embree_bvh.h"
#include "hone/backends/vulkan/vulkan_tracers.h"
#include "hone/core/error.h"
#include "hone/core/log.h"

#include <string>

namespace hone {

Device& vulkanOf(const Devices& devices, const char* tracer) {
    if (devices.raster == nullptr)
        throw DeviceError(std::string(tracer) +
                          " needs a Vulkan device, and there is none (hone doctor says what is "
                          "missing); trace with embree instead");
    return *devices.raster;
}

std::unique_ptr<TraceBackend> makeComputeTracer(Device& device) {
    return makeBvhTracer(device, buildEmbreeBvh, {.name = "vulkan.compute"});
}

std::unique_ptr<TraceBackend> makeVulkanTracer(const Devices& devices) {
    Device& device = vulkanOf(devices, "vulkan");
    const RayTracing offered = rayTracing(device);
    std::unique_ptr<TraceBackend> tracer = offered.query      ? makeRayQueryTracer(device)
                                           : offered.pipeline ? makeRayPipelineTracer(device)
                                                              : makeComputeTracer(device);
    const char* reason = offered.query      ? ""
                         : offered.pipeline ? ", which offers no ray query"
                                            : ", which offers neither ray query nor ray pipeline";
    logger().info("vulkan traces by {} on {}{}", tracer->caps().name, device.info().name, reason);
    return tracer;
}

} // namespace hone

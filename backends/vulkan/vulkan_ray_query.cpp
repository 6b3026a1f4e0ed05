// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan/vulkan_ray_tracer.h"

#include "hone_spirv/vulkan_ray_query_comp.h"

namespace hone {
namespace {

constexpr Kernel kRayQuery{.name = "vulkan.ray_query",
                           .spirv = spirv::vulkan_ray_query_comp,
                           .params_bytes = sizeof(TraceParams),
                           .run = nullptr};

void shoot(VulkanEncoder& encoder, const Arguments& arguments, const TraceParams& params,
           uint count) {
    encoder.dispatch(kRayQuery, arguments, std::as_bytes(std::span(&params, 1)), count);
}

} // namespace

std::unique_ptr<TraceBackend> makeRayQueryTracer(Device& device, const RayTracerParams& params) {
    requireRays(device, rayTracing(device).query, kRayQuery.name, "VK_KHR_ray_query");
    return std::make_unique<VulkanRayTracer>(device, kRayQuery.name, shoot, params);
}

} // namespace hone

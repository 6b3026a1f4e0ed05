// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan/vulkan_ray_tracer.h"

#include "hone_spirv/vulkan_rays_rahit.h"
#include "hone_spirv/vulkan_rays_rchit.h"
#include "hone_spirv/vulkan_rays_rgen.h"
#include "hone_spirv/vulkan_rays_rmiss.h"

namespace hone {
namespace {

constexpr RayShaders kRayShaders{.name = "vulkan.ray_pipeline",
                                 .generation = spirv::vulkan_rays_rgen,
                                 .miss = spirv::vulkan_rays_rmiss,
                                 .closest_hit = spirv::vulkan_rays_rchit,
                                 .any_hit = spirv::vulkan_rays_rahit,
                                 .params_bytes = sizeof(TraceParams)};

void shoot(VulkanEncoder& encoder, const Arguments& arguments, const TraceParams& params,
           uint count) {
    encoder.traceRays(kRayShaders, arguments, std::as_bytes(std::span(&params, 1)), count);
}

} // namespace

std::unique_ptr<TraceBackend> makeRayPipelineTracer(Device& device, const RayTracerParams& params) {
    requireRays(device, rayTracing(device).pipeline, kRayShaders.name,
                "VK_KHR_ray_tracing_pipeline");
    return std::make_unique<VulkanRayTracer>(device, kRayShaders.name, shoot, params);
}

} // namespace hone

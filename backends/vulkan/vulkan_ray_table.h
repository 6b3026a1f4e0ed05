// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/backends/vulkan/vulkan_addressed_buffer.h"
#include "hone/backends/vulkan/vulkan_pipeline.h"

#include <span>

namespace hone {

/// The shaders of a pipeline of rays, as SPIR-V that lives as long as the program.
struct RayShaders {
    const char* name = "";
    std::span<const std::uint32_t> generation, miss, closest_hit, any_hit;
    std::uint32_t params_bytes = 0;
};

/// A pipeline of rays with its shader binding table: one shader for generation, one for misses, one
/// group for all hits. Rays are not traced from hits.
struct RayPipeline {
    ShaderInterface interface;
    OwnedRayPipeline pipeline;
    AddressedBuffer table;
    VkStridedDeviceAddressRegionKHR generation{}, miss{}, hit{};
};

/// Throws DeviceError naming the shaders if they need more than the device has.
[[nodiscard]] RayPipeline makeRayPipeline(const VulkanContext& context, const VulkanMemory& memory,
                                          const RayShaders& shaders);

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/backends/vulkan/vulkan_descriptors.h"
#include "hone/backends/vulkan/vulkan_image.h"
#include "hone/backends/vulkan/vulkan_ray_table.h"

#include <unordered_map>

namespace hone {

/// Everything that lives on the device, in the order in which it must be made.
struct VulkanResources {
    explicit VulkanResources(const VulkanOptions& options)
        : context(options), memory(context), descriptors(context, memory, buffers) {}

    /// Lets retired objects go; no work that names them may be recorded or pending.
    void releaseRetired() {
        buffers.releaseRetired();
        images.releaseRetired();
        raster_pipelines.releaseRetired();
    }

    VulkanContext context;
    VulkanMemory memory;
    VulkanSlots<VulkanBuffer> buffers;
    VulkanSlots<VulkanImage> images;
    VulkanSlots<RasterPipeline> raster_pipelines;
    /// By the address of the kernel's SPIR-V, which lives as long as the program; those of kernels
    /// that were made at run time by Kernel::content.
    std::unordered_map<const std::uint32_t*, ComputePipeline> compute_pipelines;
    std::unordered_map<std::uint64_t, ComputePipeline> made_pipelines;
    /// By the address of the generation shader's SPIR-V.
    std::unordered_map<const std::uint32_t*, RayPipeline> ray_pipelines;
    VulkanDescriptors descriptors;
};

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/backends/vulkan/vulkan_context.h"
#include "hone/backends/vulkan/vulkan_reflection.h"
#include "hone/core/device/device.h"

#include <string>
#include <vector>

namespace hone {

/// Upper bound of the storage buffers of one pipeline, elements of arrays counted singly.
constexpr std::uint32_t kMaxDescriptors = 64;

/// What a pipeline binds: one descriptor set, whose binding i is bindings[i], and push constants.
/// The stages of a pipeline share bindings of the same name.
struct ShaderInterface {
    std::string name;
    std::vector<ShaderBinding> bindings;
    VkShaderStageFlags stages = 0;
    std::uint32_t push_constant_bytes = 0;
    OwnedSetLayout set_layout;
    OwnedPipelineLayout layout;
};

struct ComputePipeline {
    ShaderInterface interface;
    uint workgroup = 1; ///< invocations of a workgroup along x; y and z are 1
    OwnedComputePipeline pipeline;
};

struct RasterPipeline {
    ShaderInterface interface;
    bool has_color = false;
    OwnedGraphicsPipeline pipeline;
};

/// Both throw DeviceError naming the shader if it needs more than the device has.
[[nodiscard]] ComputePipeline makeComputePipeline(const VulkanContext& context,
                                                  const Kernel& kernel);
[[nodiscard]] RasterPipeline makeRasterPipeline(const VulkanContext& context,
                                                const RasterPipelineDesc& desc);

} // namespace hone

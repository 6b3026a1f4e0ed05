// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/backends/vulkan/vulkan_pipeline.h"

namespace hone {

/// One stage: its SPIR-V, whose binding numbers are rewritten to those of the pipeline.
struct Stage {
    VkShaderStageFlagBits stage;
    std::vector<std::uint32_t> spirv;
    ShaderReflection reflection;
};
[[nodiscard]] Stage makeStage(VkShaderStageFlagBits stage, std::span<const std::uint32_t> spirv,
                              const std::string& name);

/// What the stages of a pipeline bind together; gives each name one number and writes it into
/// their SPIR-V. Throws DeviceError naming the shader if it needs more than the device has.
[[nodiscard]] ShaderInterface makeInterface(const VulkanContext& context, std::string name,
                                            std::span<Stage> stages);

[[nodiscard]] OwnedShaderModule makeModule(const VulkanContext& context, const Stage& stage,
                                           const std::string& name);
/// Points into `module`.
[[nodiscard]] VkPipelineShaderStageCreateInfo stageInfo(VkShaderStageFlagBits stage,
                                                        const OwnedShaderModule& module);

} // namespace hone

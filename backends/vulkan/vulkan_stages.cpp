// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan/vulkan_stages.h"

#include "hone/core/error.h"

#include <algorithm>
#include <array>

namespace hone {
namespace {

/// The number of the binding of that name, new or shared with an earlier stage.
std::uint32_t assign(ShaderInterface& shared, const ShaderBinding& binding) {
    const auto found = std::ranges::find(shared.bindings, binding.name, &ShaderBinding::name);
    const auto number = static_cast<std::uint32_t>(found - shared.bindings.begin());
    if (found == shared.bindings.end())
        shared.bindings.push_back(binding);
    else if (found->elements != binding.elements)
        throw DeviceError(shared.name + ": the stages disagree how many buffers " + binding.name +
                          " has");
    return number;
}

void checkLimits(const VulkanContext& context, const ShaderInterface& interface) {
    const VkPhysicalDeviceLimits& limits = context.limits();
    std::uint32_t descriptors = 0;
    for (const ShaderBinding& binding : interface.bindings)
        descriptors += binding.elements;
    const std::uint32_t most =
        std::min({kMaxDescriptors, limits.maxPerStageDescriptorStorageBuffers,
                  limits.maxDescriptorSetStorageBuffers});
    if (descriptors > most)
        throw DeviceError(interface.name + " binds " + std::to_string(descriptors) +
                          " buffers; at most " + std::to_string(most) + " are possible here");
    if (interface.push_constant_bytes > limits.maxPushConstantsSize)
        throw DeviceError(interface.name + " has " + std::to_string(interface.push_constant_bytes) +
                          " bytes of parameters; the device takes " +
                          std::to_string(limits.maxPushConstantsSize));
}

} // namespace

Stage makeStage(VkShaderStageFlagBits stage, std::span<const std::uint32_t> spirv,
                const std::string& name) {
    return {stage, {spirv.begin(), spirv.end()}, reflectShader(spirv, name.c_str())};
}

ShaderInterface makeInterface(const VulkanContext& context, std::string name,
                              std::span<Stage> stages) {
    ShaderInterface result;
    result.name = std::move(name);

    // Give each name one number, and write it into the SPIR-V of every stage that uses it.
    for (Stage& stage : stages) {
        result.stages |= stage.stage;
        result.push_constant_bytes =
            std::max(result.push_constant_bytes, stage.reflection.push_constant_bytes);
        for (const ShaderBinding& binding : stage.reflection.bindings) {
            stage.spirv[binding.binding_word] = assign(result, binding);
            stage.spirv[binding.set_word] = 0;
        }
    }
    checkLimits(context, result);

    std::array<VkDescriptorSetLayoutBinding, kMaxDescriptors> bindings{};
    for (std::uint32_t i = 0; i < result.bindings.size(); ++i)
        bindings[i] = {.binding = i,
                       .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                       .descriptorCount = result.bindings[i].elements,
                       .stageFlags = result.stages,
                       .pImmutableSamplers = nullptr};
    const VkDescriptorSetLayoutCreateInfo set_info{
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .pNext = nullptr,
        .flags = 0,
        .bindingCount = static_cast<std::uint32_t>(result.bindings.size()),
        .pBindings = bindings.data()};
    result.set_layout = OwnedSetLayout(context.device(), set_info, result.name.c_str());
    context.setName(VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, result.set_layout.handle(), result.name);

    const VkDescriptorSetLayout set = result.set_layout.handle();
    const VkPushConstantRange range{result.stages, 0, result.push_constant_bytes};
    const VkPipelineLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                          .pNext = nullptr,
                                          .flags = 0,
                                          .setLayoutCount = 1,
                                          .pSetLayouts = &set,
                                          .pushConstantRangeCount = range.size > 0 ? 1u : 0u,
                                          .pPushConstantRanges = &range};
    result.layout = OwnedPipelineLayout(context.device(), info, result.name.c_str());
    context.setName(VK_OBJECT_TYPE_PIPELINE_LAYOUT, result.layout.handle(), result.name);
    return result;
}

OwnedShaderModule makeModule(const VulkanContext& context, const Stage& stage,
                             const std::string& name) {
    const VkShaderModuleCreateInfo info{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                        .pNext = nullptr,
                                        .flags = 0,
                                        .codeSize = stage.spirv.size() * sizeof(std::uint32_t),
                                        .pCode = stage.spirv.data()};
    OwnedShaderModule module(context.device(), info, name.c_str());
    context.setName(VK_OBJECT_TYPE_SHADER_MODULE, module.handle(), name);
    return module;
}

VkPipelineShaderStageCreateInfo stageInfo(VkShaderStageFlagBits stage,
                                          const OwnedShaderModule& module) {
    return {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
            .pNext = nullptr,
            .flags = 0,
            .stage = stage,
            .module = module.handle(),
            .pName = "main",
            .pSpecializationInfo = nullptr};
}

} // namespace hone

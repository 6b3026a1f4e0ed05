// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan/vulkan_ray_table.h"

#include "hone/backends/vulkan/vulkan_stages.h"
#include "hone/core/error.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace hone {
namespace {

enum Group : std::uint32_t { kGeneration, kMissed, kHit, kGroups };

VkRayTracingShaderGroupCreateInfoKHR generalGroup(std::uint32_t stage) {
    VkRayTracingShaderGroupCreateInfoKHR group{};
    group.sType = VK_STRUCTURE_TYPE_RAY_TRACING_SHADER_GROUP_CREATE_INFO_KHR;
    group.type = VK_RAY_TRACING_SHADER_GROUP_TYPE_GENERAL_KHR;
    group.generalShader = stage;
    group.closestHitShader = VK_SHADER_UNUSED_KHR;
    group.anyHitShader = VK_SHADER_UNUSED_KHR;
    group.intersectionShader = VK_SHADER_UNUSED_KHR;
    return group;
}

VkRayTracingShaderGroupCreateInfoKHR hitGroup(std::uint32_t closest, std::uint32_t any) {
    VkRayTracingShaderGroupCreateInfoKHR group = generalGroup(VK_SHADER_UNUSED_KHR);
    group.type = VK_RAY_TRACING_SHADER_GROUP_TYPE_TRIANGLES_HIT_GROUP_KHR;
    group.closestHitShader = closest;
    group.anyHitShader = any;
    return group;
}

OwnedRayPipeline makeOwned(const VulkanContext& context, const RayShaders& shaders,
                           const std::array<Stage, 4>& stages, VkPipelineLayout layout) {
    std::array<OwnedShaderModule, 4> modules;
    std::array<VkPipelineShaderStageCreateInfo, 4> infos;
    for (std::size_t i = 0; i < stages.size(); ++i) {
        modules[i] = makeModule(context, stages[i], shaders.name);
        infos[i] = stageInfo(stages[i].stage, modules[i]);
    }
    const std::array groups{generalGroup(0), generalGroup(1), hitGroup(2, 3)};
    VkRayTracingPipelineCreateInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CREATE_INFO_KHR;
    info.stageCount = static_cast<std::uint32_t>(infos.size());
    info.pStages = infos.data();
    info.groupCount = static_cast<std::uint32_t>(groups.size());
    info.pGroups = groups.data();
    info.maxPipelineRayRecursionDepth = 1;
    info.layout = layout;
    info.basePipelineIndex = -1;
    OwnedRayPipeline pipeline(context.device(), info, shaders.name);
    context.setName(VK_OBJECT_TYPE_PIPELINE, pipeline.handle(), shaders.name);
    return pipeline;
}

VkPhysicalDeviceRayTracingPipelinePropertiesKHR limitsOf(const VulkanContext& context) {
    VkPhysicalDeviceRayTracingPipelinePropertiesKHR limits{};
    limits.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_PROPERTIES_KHR;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &limits;
    vkGetPhysicalDeviceProperties2(context.chosen().device, &properties);
    return limits;
}

} // namespace

RayPipeline makeRayPipeline(const VulkanContext& context, const VulkanMemory& memory,
                            const RayShaders& shaders) {
    const std::string name = shaders.name;
    std::array stages{makeStage(VK_SHADER_STAGE_RAYGEN_BIT_KHR, shaders.generation, name),
                      makeStage(VK_SHADER_STAGE_MISS_BIT_KHR, shaders.miss, name),
                      makeStage(VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR, shaders.closest_hit, name),
                      makeStage(VK_SHADER_STAGE_ANY_HIT_BIT_KHR, shaders.any_hit, name)};
    RayPipeline result;
    result.interface = makeInterface(context, name, stages);
    result.pipeline = makeOwned(context, shaders, stages, result.interface.layout.handle());

    // One record a group, each where a group's table may begin.
    const auto limits = limitsOf(context);
    const VkDeviceSize size = limits.shaderGroupHandleSize;
    const VkDeviceSize base = limits.shaderGroupBaseAlignment;
    const VkDeviceSize stride = (size + base - 1) / base * base;
    std::vector<std::byte> handles(kGroups * size);
    const auto get_handles =
        HONE_DEVICE_CALL(context.device(), vkGetRayTracingShaderGroupHandlesKHR);
    HONE_VULKAN(get_handles(context.device(), result.pipeline.handle(), 0, kGroups, handles.size(),
                            handles.data()));
    result.table = AddressedBuffer(context, memory, kGroups * stride,
                                   VK_BUFFER_USAGE_SHADER_BINDING_TABLE_BIT_KHR,
                                   AddressedBuffer::Place::kMapped, shaders.name, base);
    for (std::uint32_t group = 0; group < kGroups; ++group)
        std::memcpy(result.table.as<std::byte>().data() + group * stride,
                    handles.data() + group * size, size);
    const auto region = [&](Group group) {
        return VkStridedDeviceAddressRegionKHR{result.table.address() + group * stride, stride,
                                               stride};
    };
    result.generation = region(kGeneration);
    result.miss = region(kMissed);
    result.hit = region(kHit);
    return result;
}

} // namespace hone

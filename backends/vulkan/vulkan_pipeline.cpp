// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan/vulkan_pipeline.h"

#include "hone/backends/vulkan/vulkan_image.h"
#include "hone/backends/vulkan/vulkan_stages.h"
#include "hone/core/error.h"

#include <array>

namespace hone {

ComputePipeline makeComputePipeline(const VulkanContext& context, const Kernel& kernel) {
    const std::string name = kernel.name;
    if (kernel.spirv.empty())
        throw DeviceError(name + " has no device build; run it on the host");
    Stage stage = makeStage(VK_SHADER_STAGE_COMPUTE_BIT, kernel.spirv, name);
    ComputePipeline result;
    result.workgroup = stage.reflection.workgroup.x;
    result.interface = makeInterface(context, name, {&stage, 1});

    const OwnedShaderModule module = makeModule(context, stage, name);
    const VkComputePipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                           .pNext = nullptr,
                                           .flags = 0,
                                           .stage = stageInfo(stage.stage, module),
                                           .layout = result.interface.layout.handle(),
                                           .basePipelineHandle = VK_NULL_HANDLE,
                                           .basePipelineIndex = -1};
    result.pipeline = OwnedComputePipeline(context.device(), info, name.c_str());
    context.setName(VK_OBJECT_TYPE_PIPELINE, result.pipeline.handle(), name);
    return result;
}

RasterPipeline makeRasterPipeline(const VulkanContext& context, const RasterPipelineDesc& desc) {
    const std::string name(desc.name);
    std::vector<Stage> stages;
    stages.push_back(makeStage(VK_SHADER_STAGE_VERTEX_BIT, desc.vertex_spirv, name));
    if (!desc.fragment_spirv.empty())
        stages.push_back(makeStage(VK_SHADER_STAGE_FRAGMENT_BIT, desc.fragment_spirv, name));
    RasterPipeline result;
    result.has_color = desc.has_color;
    result.interface = makeInterface(context, name, stages);

    std::vector<OwnedShaderModule> modules;
    std::vector<VkPipelineShaderStageCreateInfo> stage_infos;
    for (const Stage& stage : stages) {
        modules.push_back(makeModule(context, stage, name));
        stage_infos.push_back(stageInfo(stage.stage, modules.back()));
    }

    // Vertices are pulled from storage buffers, so there is no vertex input.
    VkPipelineVertexInputStateCreateInfo vertex_input{};
    vertex_input.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
    VkPipelineInputAssemblyStateCreateInfo assembly{};
    assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkPipelineViewportStateCreateInfo viewport{};
    viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
    viewport.viewportCount = 1;
    viewport.scissorCount = 1;

    // Vulkan computes the turn with y down, as a picture is looked at: what turns counter-clockwise
    // in the picture (row 0 on top) is a front face.
    VkPipelineRasterizationStateCreateInfo rasterization{};
    rasterization.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
    rasterization.polygonMode = VK_POLYGON_MODE_FILL;
    rasterization.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
    rasterization.lineWidth = 1.0f;
    VkPipelineMultisampleStateCreateInfo multisample{};
    multisample.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
    multisample.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    VkPipelineDepthStencilStateCreateInfo depth{};
    depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
    depth.depthTestEnable = VK_TRUE;
    depth.depthWriteEnable = VK_TRUE;
    depth.depthCompareOp = VK_COMPARE_OP_GREATER;
    VkPipelineColorBlendAttachmentState color{};
    color.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT;
    VkPipelineColorBlendStateCreateInfo blend{};
    blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
    blend.attachmentCount = desc.has_color ? 1 : 0;
    blend.pAttachments = &color;
    const std::array dynamic_states{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
                                    VK_DYNAMIC_STATE_CULL_MODE};
    VkPipelineDynamicStateCreateInfo dynamic{};
    dynamic.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
    dynamic.dynamicStateCount = static_cast<std::uint32_t>(dynamic_states.size());
    dynamic.pDynamicStates = dynamic_states.data();

    const VkFormat color_format = VulkanImage::vulkanFormat(ImageFormat::kRg32Uint);
    VkPipelineRenderingCreateInfo rendering{};
    rendering.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO;
    rendering.colorAttachmentCount = desc.has_color ? 1 : 0;
    rendering.pColorAttachmentFormats = &color_format;
    rendering.depthAttachmentFormat = VulkanImage::vulkanFormat(ImageFormat::kDepth32);

    VkGraphicsPipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
    info.pNext = &rendering;
    info.stageCount = static_cast<std::uint32_t>(stage_infos.size());
    info.pStages = stage_infos.data();
    info.pVertexInputState = &vertex_input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &rasterization;
    info.pMultisampleState = &multisample;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &blend;
    info.pDynamicState = &dynamic;
    info.layout = result.interface.layout.handle();
    result.pipeline = OwnedGraphicsPipeline(context.device(), info, name.c_str());
    context.setName(VK_OBJECT_TYPE_PIPELINE, result.pipeline.handle(), name);
    return result;
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan/vulkan_encoder.h"

#include "hone/core/error.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace hone {
namespace {

/// What comes before every kernel's parameters (kernel.glsl.h, HONE_PARAMS).
struct KernelHeader {
    uint hone_count = 0; ///< invocations
    uint hone_row = 0;   ///< invocations that one row of workgroups covers
};

constexpr std::size_t kMaxPushConstants = 256;

void memoryBarrier(VkCommandBuffer commands, VkPipelineStageFlags2 stages, VkAccessFlags2 access) {
    const VkMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                   .pNext = nullptr,
                                   .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                   .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
                                   .dstStageMask = stages,
                                   .dstAccessMask = access};
    VkDependencyInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &info);
}

VkRenderingAttachmentInfo attachment(VkImageView view, VkImageLayout layout, VkClearValue clear) {
    VkRenderingAttachmentInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
    info.imageView = view;
    info.imageLayout = layout;
    info.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    info.clearValue = clear;
    return info;
}

OwnedCommandPool makeCommandPool(const VulkanContext& context) {
    const VkCommandPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                       .pNext = nullptr,
                                       .flags = 0,
                                       .queueFamilyIndex = context.chosen().queue_family};
    OwnedCommandPool pool(context.device(), info);
    context.setName(VK_OBJECT_TYPE_COMMAND_POOL, pool.handle(), "encoder");
    return pool;
}

OwnedFence makeFence(const VulkanContext& context) {
    const VkFenceCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, .pNext = nullptr, .flags = 0};
    OwnedFence fence(context.device(), info);
    context.setName(VK_OBJECT_TYPE_FENCE, fence.handle(), "encoder");
    return fence;
}

} // namespace

VulkanEncoder::VulkanEncoder(VulkanResources& resources)
    : resources_(&resources), scopes_(resources.context), pool_(makeCommandPool(resources.context)),
      fence_(makeFence(resources.context)) {
    const VulkanContext& context = resources.context;
    const VkCommandBufferAllocateInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                           .pNext = nullptr,
                                           .commandPool = pool_.handle(),
                                           .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                           .commandBufferCount = 1};
    HONE_VULKAN(vkAllocateCommandBuffers(context.device(), &info, &commands_));
    context.setName(VK_OBJECT_TYPE_COMMAND_BUFFER, commands_, "encoder");
}

VkCommandBuffer VulkanEncoder::recorded() const {
    return is_recording_ ? commands_ : VK_NULL_HANDLE;
}

VkCommandBuffer VulkanEncoder::next() {
    return record(hazards_.mustWaitForAll());
}

VkCommandBuffer VulkanEncoder::next(std::span<const BufferUse> uses) {
    return record(hazards_.mustWait(uses));
}

VkCommandBuffer VulkanEncoder::record(bool waits) {
    HONE_ASSERT(!in_raster_, "only drawIndexed() may stand between beginRaster() and endRaster()");
    if (is_recording_) {
        if (waits) {
            memoryBarrier(commands_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                          VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT);
            ++barriers_;
        }
        return commands_;
    }
    const VkCommandBufferBeginInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                        .pNext = nullptr,
                                        .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
                                        .pInheritanceInfo = nullptr};
    HONE_VULKAN(vkBeginCommandBuffer(commands_, &info));
    is_recording_ = true;
    scopes_.beginRecording(commands_);
    return commands_;
}

VkBuffer VulkanEncoder::buffer(BufferView view, std::string_view what) {
    return resources_->buffers.get(view.handle, what).handle();
}

void VulkanEncoder::bindArguments(const ShaderInterface& interface, VkPipelineBindPoint point,
                                  const Arguments& arguments) {
    if (interface.bindings.empty())
        return;
    const VkDescriptorSet set = resources_->descriptors.bind(interface, arguments);
    vkCmdBindDescriptorSets(commands_, point, interface.layout.handle(), 0, 1, &set, 0, nullptr);
}

void VulkanEncoder::dispatch(const Kernel& kernel, const Arguments& arguments,
                             std::span<const std::byte> params, uint count) {
    HONE_ASSERT(params.size() == kernel.params_bytes, kernel.name);
    if (count == 0)
        return;
    const auto pipelineIn = [&](auto& pipelines, auto key) -> const ComputePipeline& {
        auto found = pipelines.find(key);
        if (found == pipelines.end())
            found = pipelines.emplace(key, makeComputePipeline(resources_->context, kernel)).first;
        return found->second;
    };
    const ComputePipeline& pipeline =
        kernel.content != 0 ? pipelineIn(resources_->made_pipelines, kernel.content)
                            : pipelineIn(resources_->compute_pipelines, kernel.spirv.data());
    const ShaderInterface& interface = pipeline.interface;

    // Spread what is wider than one row of workgroups over rows, as evenly as possible.
    const std::uint32_t widest = resources_->context.limits().maxComputeWorkGroupCount[0];
    const uint groups = (count - 1) / pipeline.workgroup + 1;
    const uint rows = (groups - 1) / widest + 1;
    const uint row_groups = (groups - 1) / rows + 1;
    std::array<BufferUse, kMaxDescriptors> uses;
    std::size_t used = 0;
    for (const ShaderBinding& binding : interface.bindings)
        for (std::uint32_t element = 0; element < binding.elements; ++element)
            if (const Argument* argument = arguments.find(binding.name, element))
                uses[used++] = {argument->buffer, binding.is_written};
    const VkCommandBuffer commands = next(std::span(uses).first(used));
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.pipeline.handle());
    bindArguments(interface, VK_PIPELINE_BIND_POINT_COMPUTE, arguments);
    pushParams(interface, count, row_groups * pipeline.workgroup, params);
    vkCmdDispatch(commands, row_groups, rows, 1);
}

void VulkanEncoder::traceRays(const RayShaders& shaders, const Arguments& arguments,
                              std::span<const std::byte> params, uint count) {
    HONE_ASSERT(params.size() == shaders.params_bytes, shaders.name);
    if (count == 0)
        return;
    auto& pipelines = resources_->ray_pipelines;
    auto found = pipelines.find(shaders.generation.data());
    if (found == pipelines.end())
        found = pipelines
                    .emplace(shaders.generation.data(),
                             makeRayPipeline(resources_->context, resources_->memory, shaders))
                    .first;
    const RayPipeline& pipeline = found->second;

    // A row is at least 65,535 invocations by the standard.
    constexpr uint kRow = 1u << 15;
    const uint rows = (count - 1) / kRow + 1;
    const uint row = rows > 1 ? kRow : count;
    const VkCommandBuffer commands = next();
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, pipeline.pipeline.handle());
    bindArguments(pipeline.interface, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, arguments);
    pushParams(pipeline.interface, count, row, params);
    const VkStridedDeviceAddressRegionKHR no_callables{};
    const auto trace = HONE_DEVICE_CALL(resources_->context.device(), vkCmdTraceRaysKHR);
    trace(commands, &pipeline.generation, &pipeline.miss, &pipeline.hit, &no_callables, row, rows,
          1);
}

void VulkanEncoder::pushParams(const ShaderInterface& interface, uint count, uint row,
                               std::span<const std::byte> params) {
    const KernelHeader header{count, row};
    std::array<std::byte, kMaxPushConstants> constants;
    const std::size_t bytes = sizeof(header) + params.size();
    HONE_ASSERT(bytes == interface.push_constant_bytes && bytes <= constants.size(),
                interface.name + ": Params has " + std::to_string(params.size()) +
                    " bytes in C++; the shader's push constants have " +
                    std::to_string(interface.push_constant_bytes));
    std::memcpy(constants.data(), &header, sizeof(header));
    if (!params.empty())
        std::memcpy(constants.data() + sizeof(header), params.data(), params.size());
    vkCmdPushConstants(commands_, interface.layout.handle(), interface.stages, 0,
                       static_cast<std::uint32_t>(bytes), constants.data());
}

void VulkanEncoder::copy(BufferView source, BufferView target) {
    HONE_ASSERT(source.bytes == target.bytes, "copy between unequal sizes");
    if (source.bytes == 0)
        return;
    const VkBuffer from = buffer(source, "the source of a copy");
    const VkBuffer to = buffer(target, "the target of a copy");
    const VkBufferCopy region{source.offset, target.offset, source.bytes};
    const BufferUse uses[] = {{source, false}, {target, true}};
    vkCmdCopyBuffer(next(uses), from, to, 1, &region);
}

void VulkanEncoder::fill(BufferView target, uint word) {
    HONE_ASSERT(target.bytes % 4 == 0 && target.offset % 4 == 0, "fill sets whole words");
    if (target.bytes == 0)
        return;
    const VkBuffer to = buffer(target, "the target of a fill");
    const BufferUse uses[] = {{target, true}};
    vkCmdFillBuffer(next(uses), to, target.offset, target.bytes, word);
}

void VulkanEncoder::beginRaster(const RasterTarget& target) {
    VulkanImage& depth =
        resources_->images.get(static_cast<std::uint64_t>(target.depth), "the depth target");
    VulkanImage* color = nullptr;
    if (target.color != ImageHandle::kNone)
        color =
            &resources_->images.get(static_cast<std::uint64_t>(target.color), "the colour target");
    HONE_ASSERT(depth.extent() == target.extent &&
                    (color == nullptr || color->extent() == target.extent),
                "a raster target's extent must be that of its images");
    HONE_ASSERT(depth.format() == ImageFormat::kDepth32 &&
                    (color == nullptr || color->format() == ImageFormat::kRg32Uint),
                "a raster target needs a kDepth32 depth and a kRg32Uint colour image");

    const VkCommandBuffer commands = next();
    depth.transition(commands, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, false);
    if (color != nullptr)
        color->transition(commands, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, false);

    const VkRenderingAttachmentInfo depth_info =
        attachment(depth.view(), VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                   {.depthStencil = {.depth = 0.0f, .stencil = 0}});
    VkRenderingAttachmentInfo color_info{};
    if (color != nullptr)
        color_info = attachment(color->view(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                {.color = {.uint32 = {~0u, ~0u, ~0u, ~0u}}});
    const VkRect2D area{{0, 0}, {target.extent.x, target.extent.y}};
    VkRenderingInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
    info.renderArea = area;
    info.layerCount = 1;
    info.colorAttachmentCount = color != nullptr ? 1 : 0;
    info.pColorAttachments = &color_info;
    info.pDepthAttachment = &depth_info;
    vkCmdBeginRendering(commands, &info);
    in_raster_ = true;
    raster_has_color_ = color != nullptr;

    const VkViewport viewport{
        0, 0, static_cast<float>(target.extent.x), static_cast<float>(target.extent.y), 0, 1};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &area);
}

void VulkanEncoder::drawIndexed(PipelineHandle pipeline_handle, CullMode cull,
                                const Arguments& arguments, std::span<const std::byte> params,
                                BufferView indices, BufferView draws) {
    HONE_ASSERT(in_raster_, "drawIndexed() outside beginRaster() and endRaster()");
    const RasterPipeline& pipeline = resources_->raster_pipelines.get(
        static_cast<std::uint64_t>(pipeline_handle), "the raster pipeline");
    const ShaderInterface& interface = pipeline.interface;
    HONE_ASSERT(pipeline.has_color == raster_has_color_,
                interface.name + ": the pipeline and the target disagree whether there is colour");
    HONE_ASSERT(params.size() == interface.push_constant_bytes,
                interface.name + ": " + std::to_string(params.size()) +
                    " bytes of parameters; the shaders' push constants have " +
                    std::to_string(interface.push_constant_bytes));
    HONE_ASSERT(draws.bytes % sizeof(DrawIndexed) == 0 && draws.offset % 4 == 0,
                interface.name + ": the draws must be whole DrawIndexed");
    if (draws.bytes == 0 || indices.bytes == 0)
        return;

    vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.pipeline.handle());
    vkCmdSetCullMode(commands_,
                     cull == CullMode::kBack ? VK_CULL_MODE_BACK_BIT : VK_CULL_MODE_NONE);
    bindArguments(interface, VK_PIPELINE_BIND_POINT_GRAPHICS, arguments);
    if (!params.empty())
        vkCmdPushConstants(commands_, interface.layout.handle(), interface.stages, 0,
                           static_cast<std::uint32_t>(params.size()), params.data());
    vkCmdBindIndexBuffer(commands_, buffer(indices, "the index buffer"), indices.offset,
                         VK_INDEX_TYPE_UINT32);

    // One call takes as many draws as the device allows; without multiDrawIndirect that is one.
    const VkBuffer draw_buffer = buffer(draws, "the draws");
    const VulkanContext& context = resources_->context;
    const std::size_t most =
        context.chosen().multi_draw ? context.limits().maxDrawIndirectCount : 1;
    const std::size_t count = draws.bytes / sizeof(DrawIndexed);
    for (std::size_t first = 0; first < count; first += most)
        vkCmdDrawIndexedIndirect(commands_, draw_buffer, draws.offset + first * sizeof(DrawIndexed),
                                 static_cast<std::uint32_t>(std::min(most, count - first)),
                                 sizeof(DrawIndexed));
}

void VulkanEncoder::endRaster() {
    HONE_ASSERT(in_raster_, "endRaster() without beginRaster()");
    vkCmdEndRendering(commands_);
    in_raster_ = false;
}

void VulkanEncoder::copyImage(ImageHandle handle, BufferView target) {
    VulkanImage& image =
        resources_->images.get(static_cast<std::uint64_t>(handle), "the image to copy");
    const uvec2 extent = image.extent();
    HONE_ASSERT(image.isDrawn(), "an image that was never drawn into has nothing to copy");
    HONE_ASSERT(target.bytes == std::size_t{extent.x} * extent.y * image.pixelBytes(),
                "copyImage: the buffer has " + std::to_string(target.bytes) +
                    " bytes; the image has " + std::to_string(extent.x) + " x " +
                    std::to_string(extent.y) + " pixels of " + std::to_string(image.pixelBytes()));
    const VkBuffer to = buffer(target, "the target of an image copy");
    const VkCommandBuffer commands = next();
    image.transition(commands, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, true);
    const VkBufferImageCopy region{.bufferOffset = target.offset,
                                   .bufferRowLength = 0,
                                   .bufferImageHeight = 0,
                                   .imageSubresource = {image.aspect(), 0, 0, 1},
                                   .imageOffset = {0, 0, 0},
                                   .imageExtent = {extent.x, extent.y, 1}};
    vkCmdCopyImageToBuffer(commands, image.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to, 1,
                           &region);
}

void VulkanEncoder::beginScope(std::string_view name) {
    scopes_.push(recorded(), name);
}

void VulkanEncoder::endScope() {
    scopes_.pop(recorded());
}

void VulkanEncoder::finish() {
    if (!is_recording_)
        return;
    HONE_ASSERT(!in_raster_, "finish() between beginRaster() and endRaster()");
    try {
        submitAndWait();
        scopes_.collect();
    } catch (...) {
        reset();
        throw;
    }
    reset();
}

void VulkanEncoder::submitAndWait() {
    const VulkanContext& context = resources_->context;
    scopes_.endRecording(commands_);
    memoryBarrier(commands_, VK_PIPELINE_STAGE_2_HOST_BIT,
                  VK_ACCESS_2_HOST_READ_BIT | VK_ACCESS_2_HOST_WRITE_BIT);
    HONE_VULKAN(vkEndCommandBuffer(commands_));
    const VkCommandBufferSubmitInfo commands{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                             .pNext = nullptr,
                                             .commandBuffer = commands_,
                                             .deviceMask = 0};
    VkSubmitInfo2 submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2;
    submit.commandBufferInfoCount = 1;
    submit.pCommandBufferInfos = &commands;
    HONE_VULKAN(vkQueueSubmit2(context.queue(), 1, &submit, fence_.handle()));
    const VkFence fence = fence_.handle();
    HONE_VULKAN(vkWaitForFences(context.device(), 1, &fence, VK_TRUE, UINT64_MAX));
    HONE_VULKAN(vkResetFences(context.device(), 1, &fence));
}

void VulkanEncoder::reset() {
    is_recording_ = false;
    hazards_.clear();
    in_raster_ = false;
    scopes_.discard();
    resources_->releaseRetired();
    resources_->descriptors.reset();
    HONE_VULKAN(vkResetCommandPool(resources_->context.device(), pool_.handle(), 0));
}

} // namespace hone

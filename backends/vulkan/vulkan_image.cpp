// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan/vulkan_image.h"

#include "hone/core/error.h"

#include <string>

namespace hone {

VulkanImage::VulkanImage(const VulkanContext& context, VulkanMemory& memory, const ImageDesc& desc)
    : extent_(desc.extent), format_(desc.format) {
    const std::string name(desc.name);
    const std::uint32_t limit = context.limits().maxImageDimension2D;
    if (extent_.x == 0 || extent_.y == 0 || extent_.x > limit || extent_.y > limit)
        throw DeviceError("the image " + name + " of " + std::to_string(extent_.x) + " x " +
                          std::to_string(extent_.y) + " pixels is outside what " +
                          context.chosen().report.name + " offers: 1 to " + std::to_string(limit) +
                          " each way");
    const bool is_depth = format_ == ImageFormat::kDepth32;
    const VkImageCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .pNext = nullptr,
        .flags = 0,
        .imageType = VK_IMAGE_TYPE_2D,
        .format = vulkanFormat(format_),
        .extent = {extent_.x, extent_.y, 1},
        .mipLevels = 1,
        .arrayLayers = 1,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .tiling = VK_IMAGE_TILING_OPTIMAL,
        .usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                 VkImageUsageFlags{is_depth ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT
                                            : VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT},
        .sharingMode = VK_SHARING_MODE_EXCLUSIVE,
        .queueFamilyIndexCount = 0,
        .pQueueFamilyIndices = nullptr,
        .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED};
    image_ = OwnedImage(context.device(), info, name.c_str());
    context.setName(VK_OBJECT_TYPE_IMAGE, image_.handle(), name);

    VkMemoryRequirements needs{};
    vkGetImageMemoryRequirements(context.device(), image_.handle(), &needs);
    memory_ = memory.allocateForImage(needs, image_.handle(), name.c_str());
    HONE_VULKAN(vkBindImageMemory(context.device(), image_.handle(), memory_.handle(), 0));

    const VkImageViewCreateInfo view{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                     .pNext = nullptr,
                                     .flags = 0,
                                     .image = image_.handle(),
                                     .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                     .format = info.format,
                                     .components = {},
                                     .subresourceRange = {aspect(), 0, 1, 0, 1}};
    view_ = OwnedImageView(context.device(), view, name.c_str());
    context.setName(VK_OBJECT_TYPE_IMAGE_VIEW, view_.handle(), name);
}

void VulkanImage::transition(VkCommandBuffer commands, VkImageLayout layout, bool keep) {
    const VkImageMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                        .pNext = nullptr,
                                        .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                        .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
                                        .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                        .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT |
                                                         VK_ACCESS_2_MEMORY_WRITE_BIT,
                                        .oldLayout = keep ? layout_ : VK_IMAGE_LAYOUT_UNDEFINED,
                                        .newLayout = layout,
                                        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                        .image = image_.handle(),
                                        .subresourceRange = {aspect(), 0, 1, 0, 1}};
    VkDependencyInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    info.imageMemoryBarrierCount = 1;
    info.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &info);
    layout_ = layout;
}

std::size_t VulkanImage::pixelBytes() const {
    return format_ == ImageFormat::kDepth32 ? 4 : 8;
}

VkImageAspectFlags VulkanImage::aspect() const {
    return format_ == ImageFormat::kDepth32 ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

VkFormat VulkanImage::vulkanFormat(ImageFormat format) {
    return format == ImageFormat::kDepth32 ? VK_FORMAT_D32_SFLOAT : VK_FORMAT_R32G32_UINT;
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/backends/vulkan/vulkan_memory.h"
#include "hone/core/device/device.h"

namespace hone {

/// An attachment with memory of its own. Move-only.
class VulkanImage {
public:
    VulkanImage(const VulkanContext& context, VulkanMemory& memory, const ImageDesc& desc);

    /// Records the change to another layout, after all that was recorded before and before all
    /// that comes. `keep` false lets the content go.
    void transition(VkCommandBuffer commands, VkImageLayout layout, bool keep);

    [[nodiscard]] VkImage handle() const { return image_.handle(); }
    [[nodiscard]] VkImageView view() const { return view_.handle(); }
    [[nodiscard]] uvec2 extent() const { return extent_; }
    [[nodiscard]] ImageFormat format() const { return format_; }
    [[nodiscard]] std::size_t pixelBytes() const;
    [[nodiscard]] VkImageAspectFlags aspect() const;
    [[nodiscard]] bool isDrawn() const { return layout_ != VK_IMAGE_LAYOUT_UNDEFINED; }

    [[nodiscard]] static VkFormat vulkanFormat(ImageFormat format);

private:
    uvec2 extent_;
    ImageFormat format_;
    VkImageLayout layout_ = VK_IMAGE_LAYOUT_UNDEFINED;
    OwnedMemory memory_; // first, so that it goes last
    OwnedImage image_;
    OwnedImageView view_;
};

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/backends/vulkan/vulkan_context.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace hone {

/// A stretch of device memory, always mapped if its type is host-visible.
struct MemoryRange {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize offset = 0;
    VkDeviceSize bytes = 0;    ///< at least what was asked
    std::byte* data = nullptr; ///< the host's view, already advanced by offset
};

/// The first type among `allowed` that has all of `wanted`; types are listed best first by Vulkan's
/// rules.
[[nodiscard]] std::optional<std::uint32_t> findType(const VkPhysicalDeviceMemoryProperties& memory,
                                                    std::uint32_t allowed,
                                                    VkMemoryPropertyFlags wanted);

/// The type for hone's buffers, which are mapped and coherent always. Throws DeviceError if none
/// is.
///
/// Where one type is all that and device-local and cached (software, integrated GPUs), that. On a
/// discrete GPU whose whole memory the host sees (resizable BAR) its own memory: kernels go through
/// a buffer many times, the host reads results once, and uncached. Where the host sees but a window
/// of it, cached memory of the host, which the GPU reads over the bus.
[[nodiscard]] std::uint32_t bufferType(const VkPhysicalDeviceMemoryProperties& memory,
                                       std::uint32_t allowed);

/// Memory of buffers: blocks of 64 MiB, mapped for their whole life, first fit; what is larger than
/// a quarter of a block gets an allocation of its own. Freed ranges are joined and used again.
class VulkanMemory {
public:
    static constexpr VkDeviceSize kBlockBytes = VkDeviceSize{64} << 20;
    static constexpr VkDeviceSize kLargestShared = kBlockBytes / 4;

    explicit VulkanMemory(const VulkanContext& context) : context_(&context) {}

    /// Mapped, coherent memory for a buffer; its content is undefined.
    /// Throws OutOfMemory naming `about` and how much is in use.
    [[nodiscard]] MemoryRange allocate(const VkMemoryRequirements& needs, const char* about);
    void free(const MemoryRange& range);

    /// Memory for one image, not mapped.
    [[nodiscard]] OwnedMemory allocateForImage(const VkMemoryRequirements& needs, VkImage image,
                                               const char* about);

    /// Memory for one buffer that shaders reach by its address: mapped and coherent, or where the
    /// device reads fastest.
    [[nodiscard]] OwnedMemory allocateAddressed(const VkMemoryRequirements& needs, bool is_mapped,
                                                const char* about) const;

    [[nodiscard]] VkDeviceSize bytesInUse() const { return bytes_in_use_; }

private:
    struct Gap {
        VkDeviceSize offset = 0;
        VkDeviceSize bytes = 0;
    };
    struct Block {
        OwnedMemory memory;
        std::byte* data = nullptr;
        VkDeviceSize bytes = 0;
        std::uint32_t type = 0;
        std::vector<Gap> gaps; ///< by offset, never adjacent
    };

    Block& addBlock(VkDeviceSize bytes, std::uint32_t type, const char* about);
    /// First fit; false if no gap of the block is large enough.
    static bool take(Block& block, VkDeviceSize alignment, MemoryRange& range);

    const VulkanContext* context_;
    std::vector<std::unique_ptr<Block>> blocks_;
    VkDeviceSize bytes_in_use_ = 0;
};

} // namespace hone

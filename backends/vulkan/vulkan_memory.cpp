// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan/vulkan_memory.h"

#include "hone/core/error.h"
#include "hone/core/log.h"

#include <algorithm>
#include <string>

namespace hone {
namespace {

/// Buffers start on a cache line, so that host threads that write neighbours do not fight.
constexpr VkDeviceSize kCacheLine = 64;

VkDeviceSize roundUp(VkDeviceSize value, VkDeviceSize multiple) {
    return (value + multiple - 1) / multiple * multiple;
}

/// Through a window of this size discrete GPUs without resizable BAR show their memory.
constexpr VkDeviceSize kWindowBytes = VkDeviceSize{256} << 20;

} // namespace

std::optional<std::uint32_t> findType(const VkPhysicalDeviceMemoryProperties& memory,
                                      std::uint32_t allowed, VkMemoryPropertyFlags wanted) {
    for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i)
        if ((allowed >> i & 1u) != 0 && (memory.memoryTypes[i].propertyFlags & wanted) == wanted)
            return i;
    return std::nullopt;
}

std::uint32_t bufferType(const VkPhysicalDeviceMemoryProperties& memory, std::uint32_t allowed) {
    constexpr VkMemoryPropertyFlags kMapped =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    constexpr VkMemoryPropertyFlags kCached = kMapped | VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    constexpr VkMemoryPropertyFlags kLocal = kMapped | VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    if (const auto type = findType(memory, allowed, kCached | kLocal))
        return *type;
    const auto local = findType(memory, allowed, kLocal);
    if (local && memory.memoryHeaps[memory.memoryTypes[*local].heapIndex].size > kWindowBytes)
        return *local;
    for (const VkMemoryPropertyFlags wanted : {kCached, kLocal, kMapped})
        if (const auto type = findType(memory, allowed, wanted))
            return *type;
    // Vulkan promises every buffer a coherent, host-visible type.
    throw DeviceError("the device offers no host-visible, coherent memory for buffers");
}

namespace {

/// Where the device reads fastest, mapped or not.
std::uint32_t deviceType(const VkPhysicalDeviceMemoryProperties& memory, std::uint32_t allowed) {
    auto type = findType(memory, allowed, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    if (!type)
        type = findType(memory, allowed, 0);
    HONE_ASSERT(type.has_value(), "an object that no memory suits");
    return *type;
}

/// Memory for one object, which `chain` says more of.
OwnedMemory allocateOne(const VulkanContext& context, VkDeviceSize bytes, std::uint32_t type,
                        const void* chain, const char* about) {
    const VkMemoryAllocateInfo info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                    .pNext = chain,
                                    .allocationSize = bytes,
                                    .memoryTypeIndex = type};
    OwnedMemory memory(context.device(), info, about);
    context.setName(VK_OBJECT_TYPE_DEVICE_MEMORY, memory.handle(), about);
    return memory;
}

} // namespace

VulkanMemory::Block& VulkanMemory::addBlock(VkDeviceSize bytes, std::uint32_t type,
                                            const char* about) {
    auto block = std::make_unique<Block>();
    const VkMemoryAllocateInfo info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                    .pNext = nullptr,
                                    .allocationSize = bytes,
                                    .memoryTypeIndex = type};
    try {
        block->memory = OwnedMemory(context_->device(), info, about);
    } catch (const OutOfMemory& error) {
        throw OutOfMemory(std::string(error.what()) + ": " + std::to_string(bytes) +
                          " bytes asked, buffers already use " + std::to_string(bytes_in_use_));
    }
    context_->setName(VK_OBJECT_TYPE_DEVICE_MEMORY, block->memory.handle(),
                      bytes > kBlockBytes ? about : "buffer block");
    void* data = nullptr;
    HONE_VULKAN(
        vkMapMemory(context_->device(), block->memory.handle(), 0, VK_WHOLE_SIZE, 0, &data));
    block->data = static_cast<std::byte*>(data);
    block->bytes = bytes;
    block->type = type;
    block->gaps = {{0, bytes}};
    logger().debug("Vulkan: allocated {} bytes for {}", bytes, about);
    return *blocks_.emplace_back(std::move(block));
}

bool VulkanMemory::take(Block& block, VkDeviceSize alignment, MemoryRange& range) {
    for (std::size_t i = 0; i < block.gaps.size(); ++i) {
        Gap& gap = block.gaps[i];
        const VkDeviceSize begin = roundUp(gap.offset, alignment);
        const VkDeviceSize end = begin + range.bytes;
        const VkDeviceSize gap_end = gap.offset + gap.bytes;
        if (end > gap_end)
            continue;
        // What is left before and after stays a gap; often one or both are empty.
        const Gap after{end, gap_end - end};
        gap.bytes = begin - gap.offset;
        if (after.bytes > 0)
            block.gaps.insert(block.gaps.begin() + static_cast<std::ptrdiff_t>(i) + 1, after);
        if (block.gaps[i].bytes == 0)
            block.gaps.erase(block.gaps.begin() + static_cast<std::ptrdiff_t>(i));
        range.memory = block.memory.handle();
        range.offset = begin;
        range.data = block.data + begin;
        return true;
    }
    return false;
}

MemoryRange VulkanMemory::allocate(const VkMemoryRequirements& needs, const char* about) {
    const std::uint32_t type = bufferType(context_->memory(), needs.memoryTypeBits);
    const VkDeviceSize alignment = std::max(needs.alignment, kCacheLine);
    MemoryRange range;
    range.bytes = roundUp(needs.size, kCacheLine);
    const bool is_shared = range.bytes <= kLargestShared;
    bool is_found = false;
    for (auto& block : blocks_)
        if (is_shared && !is_found && block->type == type && block->bytes == kBlockBytes)
            is_found = take(*block, alignment, range);
    if (!is_found)
        is_found =
            take(addBlock(is_shared ? kBlockBytes : range.bytes, type, about), alignment, range);
    HONE_ASSERT(is_found, about);
    bytes_in_use_ += range.bytes;
    return range;
}

void VulkanMemory::free(const MemoryRange& range) {
    const auto found = std::ranges::find_if(
        blocks_, [&](const auto& block) { return block->memory.handle() == range.memory; });
    HONE_ASSERT(found != blocks_.end(), "memory that this device never gave");
    bytes_in_use_ -= range.bytes;

    // Join the freed range with the gaps that touch it.
    Block& block = **found;
    auto next =
        std::ranges::find_if(block.gaps, [&](const Gap& gap) { return gap.offset > range.offset; });
    auto gap = block.gaps.insert(next, Gap{range.offset, range.bytes});
    if (auto after = gap + 1;
        after != block.gaps.end() && gap->offset + gap->bytes == after->offset) {
        gap->bytes += after->bytes;
        block.gaps.erase(after);
    }
    if (gap != block.gaps.begin())
        if (auto before = gap - 1; before->offset + before->bytes == gap->offset) {
            before->bytes += gap->bytes;
            block.gaps.erase(gap);
        }

    // An empty shared block is kept for the next buffer; a large buffer's goes back at once.
    const bool is_empty = block.gaps.size() == 1 && block.gaps[0].bytes == block.bytes;
    if (is_empty && block.bytes != kBlockBytes)
        blocks_.erase(found);
}

OwnedMemory VulkanMemory::allocateForImage(const VkMemoryRequirements& needs, VkImage image,
                                           const char* about) {
    const VkMemoryDedicatedAllocateInfo dedicated{
        .sType = VK_STRUCTURE_TYPE_MEMORY_DEDICATED_ALLOCATE_INFO,
        .pNext = nullptr,
        .image = image,
        .buffer = VK_NULL_HANDLE};
    return allocateOne(*context_, needs.size, deviceType(context_->memory(), needs.memoryTypeBits),
                       &dedicated, about);
}

OwnedMemory VulkanMemory::allocateAddressed(const VkMemoryRequirements& needs, bool is_mapped,
                                            const char* about) const {
    const VkMemoryAllocateFlagsInfo flags{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO,
                                          .pNext = nullptr,
                                          .flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT,
                                          .deviceMask = 0};
    const std::uint32_t type = is_mapped ? bufferType(context_->memory(), needs.memoryTypeBits)
                                         : deviceType(context_->memory(), needs.memoryTypeBits);
    return allocateOne(*context_, needs.size, type, &flags, about);
}

} // namespace hone

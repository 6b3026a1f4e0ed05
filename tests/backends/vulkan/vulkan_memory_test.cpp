// SPDX-License-Identifier: Apache-2.0
//
// Which memory buffers get, on devices that are not here: their lists of types, as drivers give
// them.
#include "hone/backends/vulkan/vulkan_memory.h"

#include "hone/core/error.h"

#include <gtest/gtest.h>

namespace hone {
namespace {

constexpr VkMemoryPropertyFlags kLocal = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
constexpr VkMemoryPropertyFlags kMapped =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
constexpr VkMemoryPropertyFlags kCached = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
constexpr VkDeviceSize kGiB = VkDeviceSize{1} << 30;
constexpr std::uint32_t kAll = ~0u;

struct Type {
    VkMemoryPropertyFlags flags;
    VkDeviceSize heap_bytes; ///< each type has a heap of its own here
};

VkPhysicalDeviceMemoryProperties deviceWith(const std::vector<Type>& types) {
    VkPhysicalDeviceMemoryProperties memory{};
    for (const Type& type : types) {
        memory.memoryTypes[memory.memoryTypeCount++] = {type.flags, memory.memoryHeapCount};
        memory.memoryHeaps[memory.memoryHeapCount++] = {type.heap_bytes, 0};
    }
    return memory;
}

TEST(VulkanBufferType, IsTheOneMemoryOfASoftwareDevice) {
    EXPECT_EQ(bufferType(deviceWith({{kLocal | kMapped | kCached, 2 * kGiB}}), kAll), 0u);
}

TEST(VulkanBufferType, OfAnIntegratedGpuIsCachedAndItsOwn) {
    EXPECT_EQ(bufferType(deviceWith({{kLocal, 8 * kGiB},
                                     {kLocal | kMapped, 8 * kGiB},
                                     {kLocal | kMapped | kCached, 8 * kGiB}}),
                         kAll),
              2u);
}

TEST(VulkanBufferType, OfAGpuThatShowsAllItsMemoryIsThat) {
    EXPECT_EQ(bufferType(deviceWith({{kLocal, 16 * kGiB},
                                     {kMapped | kCached, 32 * kGiB},
                                     {kLocal | kMapped, 16 * kGiB}}),
                         kAll),
              2u);
}

TEST(VulkanBufferType, OfAGpuThatShowsAWindowOnlyIsTheHostsCachedMemory) {
    EXPECT_EQ(bufferType(deviceWith({{kLocal, 8 * kGiB},
                                     {kMapped, 32 * kGiB},
                                     {kMapped | kCached, 32 * kGiB},
                                     {kLocal | kMapped, kGiB / 4}}),
                         kAll),
              2u);
}

TEST(VulkanBufferType, IsAnyMappedOneWhereThereIsNoBetter) {
    EXPECT_EQ(bufferType(deviceWith({{kLocal, 8 * kGiB}, {kMapped, 32 * kGiB}}), kAll), 1u);
}

TEST(VulkanBufferType, IsOneThatTheBufferAllows) {
    EXPECT_EQ(bufferType(deviceWith({{kLocal | kMapped | kCached, kGiB}, {kMapped, kGiB}}), 2u),
              1u);
    EXPECT_THROW(static_cast<void>(bufferType(deviceWith({{kLocal, kGiB}}), kAll)), DeviceError);
}

} // namespace
} // namespace hone

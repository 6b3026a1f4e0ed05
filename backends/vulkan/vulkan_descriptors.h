// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/backends/vulkan/vulkan_buffer.h"
#include "hone/backends/vulkan/vulkan_pipeline.h"
#include "hone/backends/vulkan/vulkan_slots.h"

#include <vector>

namespace hone {

/// Descriptor sets of what is being recorded: taken from pools that grow as needed and are all
/// reset together, so that a steady state makes no new one.
class VulkanDescriptors {
public:
    VulkanDescriptors(const VulkanContext& context, VulkanMemory& memory,
                      VulkanSlots<VulkanBuffer>& buffers);

    /// A set with the arguments bound by name. Elements of an array that no argument names, and
    /// empty views, get a buffer of one zero word. Throws std::logic_error for a missing argument,
    /// DeviceError for one that is larger than the device can bind.
    [[nodiscard]] VkDescriptorSet bind(const ShaderInterface& interface,
                                       const Arguments& arguments);
    /// Takes all sets back; no work that uses them may be pending.
    void reset();

private:
    [[nodiscard]] VkDescriptorSet allocate(const ShaderInterface& interface);
    [[nodiscard]] VkDescriptorBufferInfo describe(const ShaderInterface& interface,
                                                  const Argument& argument);

    const VulkanContext* context_;
    VulkanSlots<VulkanBuffer>* buffers_;
    VulkanBuffer nothing_;
    std::vector<OwnedDescriptorPool> pools_;
    std::size_t current_ = 0; ///< the pool that sets come from; those before it are full
};

} // namespace hone

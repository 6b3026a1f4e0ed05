// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/backends/vulkan/vulkan_hazards.h"
#include "hone/backends/vulkan/vulkan_resources.h"
#include "hone/backends/vulkan/vulkan_scopes.h"

namespace hone {

/// Records into one command buffer; finish() submits it and waits.
///
/// An operation waits (one full memory barrier) only where it meets what was recorded before: it
/// writes what others use, or uses what others wrote (VulkanHazards). Drawing, copying of images
/// and ray tracing wait for everything, and what comes after them for them.
class VulkanEncoder final : public CommandEncoder {
public:
    explicit VulkanEncoder(VulkanResources& resources);

    void dispatch(const Kernel& kernel, const Arguments& arguments,
                  std::span<const std::byte> params, uint count) override;
    void copy(BufferView source, BufferView target) override;
    void fill(BufferView target, uint word) override;
    void beginRaster(const RasterTarget& target) override;
    void drawIndexed(PipelineHandle pipeline, CullMode cull, const Arguments& arguments,
                     std::span<const std::byte> params, BufferView indices,
                     BufferView draws) override;
    void endRaster() override;
    void copyImage(ImageHandle image, BufferView target) override;
    void beginScope(std::string_view name) override;
    void endScope() override;
    void finish() override;

    /// Traces `count` rays. Arguments and parameters are bound as for a kernel.
    void traceRays(const RayShaders& shaders, const Arguments& arguments,
                   std::span<const std::byte> params, uint count);
    /// For work of the backend's own, one operation at a time: starts recording if need be, and
    /// orders what comes after all that was recorded.
    [[nodiscard]] VkCommandBuffer next();
    /// Barriers between operations so far.
    [[nodiscard]] std::uint64_t barriers() const { return barriers_; }
    [[nodiscard]] bool isRecording() const { return is_recording_; }
    [[nodiscard]] std::vector<ScopeTiming> takeTimings() { return scopes_.take(); }

private:
    [[nodiscard]] VkCommandBuffer recorded() const;
    [[nodiscard]] VkBuffer buffer(BufferView view, std::string_view what);
    /// The same for an operation that uses no more than these bytes.
    [[nodiscard]] VkCommandBuffer next(std::span<const BufferUse> uses);
    [[nodiscard]] VkCommandBuffer record(bool waits);
    void bindArguments(const ShaderInterface& interface, VkPipelineBindPoint point,
                       const Arguments& arguments);
    /// Pushes what every kernel's parameters begin with, and the parameters.
    void pushParams(const ShaderInterface& interface, uint count, uint row,
                    std::span<const std::byte> params);
    void submitAndWait();
    void reset();

    VulkanResources* resources_;
    VulkanScopes scopes_;
    OwnedCommandPool pool_;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    OwnedFence fence_;
    VulkanHazards hazards_;
    std::uint64_t barriers_ = 0;
    bool is_recording_ = false;
    bool in_raster_ = false;
    bool raster_has_color_ = false;
};

} // namespace hone

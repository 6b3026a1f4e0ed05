// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/backends/vulkan/vulkan_resources.h"
#include "hone/backends/vulkan/vulkan_scopes.h"

namespace hone {

/// Records into one command buffer; finish() submits it and waits.
///
/// Every operation waits for all that was recorded before it (one full memory barrier): hone's
/// operations are large and nearly always depend on the one before.
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
    [[nodiscard]] bool isRecording() const { return is_recording_; }
    [[nodiscard]] std::vector<ScopeTiming> takeTimings() { return scopes_.take(); }

private:
    [[nodiscard]] VkCommandBuffer recorded() const;
    [[nodiscard]] VkBuffer buffer(BufferView view, std::string_view what);
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
    bool is_recording_ = false;
    bool in_raster_ = false;
    bool raster_has_color_ = false;
};

} // namespace hone

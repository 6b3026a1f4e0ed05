// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan/vulkan_device.h"

#include "hone/backends/vulkan/vulkan_encoder.h"
#include "hone/backends/vulkan/vulkan_import.h"
#include "hone/backends/vulkan/vulkan_inside.h"
#include "hone/backends/vulkan/vulkan_tracers.h"
#include "hone/core/error.h"

#include <algorithm>

namespace hone {
namespace {

class VulkanDevice final : public Device {
public:
    explicit VulkanDevice(const VulkanOptions& options)
        : resources_(options), encoder_(resources_) {
        const VulkanCandidate& chosen = resources_.context.chosen();
        info_.name = chosen.report.name;
        info_.driver = chosen.report.driver;
        info_.can_raster = true;
        info_.max_binding_bytes = chosen.properties.limits.maxStorageBufferRange;
        info_.is_software = chosen.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    }

    const DeviceInfo& info() const override { return info_; }

    Buffer createBuffer(std::size_t bytes, std::string_view name) override {
        const std::size_t size = std::max<std::size_t>(bytes, 4);
        VulkanBuffer buffer(resources_.context, resources_.memory, size, name);
        std::byte* data = buffer.data();
        return {*this, {resources_.buffers.add(std::move(buffer)), 0, size, data}};
    }

    Buffer importBuffer(std::span<std::byte> bytes, std::string_view name) override {
        auto buffer = importHostMemory(resources_.context, bytes, name);
        if (!buffer)
            return {};
        return {*this, {resources_.buffers.add(std::move(*buffer)), 0, bytes.size(), bytes.data()}};
    }

    BufferView viewOf(std::span<const std::byte> bytes) const override {
        BufferView found;
        resources_.buffers.forEach([&](std::uint64_t handle, const VulkanBuffer& buffer) {
            if (bytes.data() < buffer.data() ||
                bytes.data() + bytes.size() > buffer.data() + buffer.bytes())
                return;
            const auto offset = static_cast<std::size_t>(bytes.data() - buffer.data());
            found = {handle, offset, bytes.size(), buffer.data() + offset};
        });
        return found;
    }

    ImageHandle createImage(const ImageDesc& desc) override {
        return ImageHandle{
            resources_.images.add(VulkanImage(resources_.context, resources_.memory, desc))};
    }

    PipelineHandle createRasterPipeline(const RasterPipelineDesc& desc) override {
        return PipelineHandle{
            resources_.raster_pipelines.add(makeRasterPipeline(resources_.context, desc))};
    }

    void destroy(ImageHandle image) override {
        if (image == ImageHandle::kNone)
            return;
        resources_.images.retire(static_cast<std::uint64_t>(image), "the image to destroy");
        releaseIfIdle();
    }

    void destroy(PipelineHandle pipeline) override {
        if (pipeline == PipelineHandle::kNone)
            return;
        resources_.raster_pipelines.retire(static_cast<std::uint64_t>(pipeline),
                                           "the pipeline to destroy");
        releaseIfIdle();
    }

    CommandEncoder& encoder() override { return encoder_; }
    std::vector<ScopeTiming> takeTimings() override { return encoder_.takeTimings(); }
    const VulkanDeviceReport& report() const { return resources_.context.chosen().report; }
    VulkanInside inside() { return {&resources_, &encoder_}; }

private:
    void destroyBuffer(std::uint64_t handle) override {
        resources_.buffers.retire(handle, "the buffer to destroy");
        releaseIfIdle();
    }

    /// What recorded work may still name lives until finish().
    void releaseIfIdle() {
        if (!encoder_.isRecording())
            resources_.releaseRetired();
    }

    VulkanResources resources_;
    VulkanEncoder encoder_;
    DeviceInfo info_;
};

} // namespace

VulkanInside insideOf(Device& device) {
    auto* const own = dynamic_cast<VulkanDevice*>(&device);
    return own != nullptr ? own->inside() : VulkanInside{};
}

RayTracing rayTracing(const Device& device) {
    const auto* const own = dynamic_cast<const VulkanDevice*>(&device);
    if (own == nullptr)
        return {};
    return {.query = own->report().ray_query, .pipeline = own->report().ray_pipeline};
}

std::unique_ptr<Device> makeVulkanDevice(const VulkanOptions& options) {
    return std::make_unique<VulkanDevice>(options);
}

} // namespace hone

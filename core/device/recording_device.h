// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/device/device.h"

#include <string>
#include <vector>

namespace hone {

/// A device that writes down what it is asked to do, for tests of wiring that need no driver.
/// Kernels' native builds, copies and fills take effect when they are recorded; nothing is drawn.
///
/// Lines: "dispatch NAME COUNT", "copy FROM -> TO BYTES", "fill TARGET BYTES WORD", "begin raster
/// WxH", "draw", "end raster", "copy image -> TO BYTES", "scope NAME", "end scope", "finish" (only
/// where something was recorded before it). Buffers go by the names they were made with.
class RecordingDevice final : public Device {
public:
    /// A device that rasterises; `is_software` decides where executors run kernels.
    explicit RecordingDevice(bool is_software = false);
    ~RecordingDevice() override;

    [[nodiscard]] const DeviceInfo& info() const override { return info_; }
    [[nodiscard]] Buffer createBuffer(std::size_t bytes, std::string_view name) override;
    [[nodiscard]] BufferView viewOf(std::span<const std::byte>) const override { return {}; }
    [[nodiscard]] ImageHandle createImage(const ImageDesc& desc) override;
    [[nodiscard]] PipelineHandle createRasterPipeline(const RasterPipelineDesc& desc) override;
    void destroy(ImageHandle) override {}
    void destroy(PipelineHandle) override {}
    [[nodiscard]] CommandEncoder& encoder() override;
    [[nodiscard]] std::vector<ScopeTiming> takeTimings() override { return {}; }

    /// Everything recorded since the last call.
    [[nodiscard]] std::vector<std::string> takeLines();
    [[nodiscard]] std::size_t buffersAlive() const;

private:
    class Encoder;
    struct Memory {
        std::string name;
        std::unique_ptr<std::byte[]> bytes;
    };
    void destroyBuffer(std::uint64_t handle) override;
    [[nodiscard]] const std::string& nameOf(BufferView buffer) const;

    DeviceInfo info_;
    std::vector<Memory> memories_; ///< handle - 1
    std::vector<std::string> lines_;
    std::unique_ptr<Encoder> encoder_;
    std::uint64_t last_handle_ = 0;
};

} // namespace hone

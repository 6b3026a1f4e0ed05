// SPDX-License-Identifier: Apache-2.0
#include "hone/core/device/recording_device.h"

#include "hone/core/error.h"

#include <algorithm>
#include <cstring>

namespace hone {

class RecordingDevice::Encoder final : public CommandEncoder {
public:
    explicit Encoder(RecordingDevice& device) : device_(&device) {}

    void dispatch(const Kernel& kernel, const Arguments& arguments,
                  std::span<const std::byte> params, uint count) override {
        HONE_ASSERT(params.size() == kernel.params_bytes, kernel.name);
        write(std::string("dispatch ") + kernel.name + " " + std::to_string(count));
        if (kernel.run != nullptr)
            kernel.run(arguments, params.data(), 0, count);
    }

    void copy(BufferView source, BufferView target) override {
        HONE_ASSERT(source.bytes == target.bytes, "copy between unequal sizes");
        write("copy " + device_->nameOf(source) + " -> " + device_->nameOf(target) + " " +
              std::to_string(source.bytes));
        std::memcpy(target.data, source.data, source.bytes);
    }

    void fill(BufferView target, uint word) override {
        write("fill " + device_->nameOf(target) + " " + std::to_string(target.bytes) + " " +
              std::to_string(word));
        std::ranges::fill(target.as<uint>(), word);
    }

    void beginRaster(const RasterTarget& target) override {
        write("begin raster " + std::to_string(target.extent.x) + "x" +
              std::to_string(target.extent.y));
    }
    void drawIndexed(PipelineHandle, CullMode, const Arguments&, std::span<const std::byte>,
                     BufferView, BufferView) override {
        write("draw");
    }
    void endRaster() override { write("end raster"); }
    void copyImage(ImageHandle, BufferView target) override {
        write("copy image -> " + device_->nameOf(target) + " " + std::to_string(target.bytes));
    }
    void beginScope(std::string_view name) override { write("scope " + std::string(name)); }
    void endScope() override { write("end scope"); }

    void finish() override {
        if (is_recording_)
            device_->lines_.emplace_back("finish");
        is_recording_ = false;
    }

private:
    void write(std::string line) {
        device_->lines_.push_back(std::move(line));
        is_recording_ = true;
    }

    RecordingDevice* device_;
    bool is_recording_ = false;
};

RecordingDevice::RecordingDevice(bool is_software) : encoder_(std::make_unique<Encoder>(*this)) {
    info_.name = "recording";
    info_.can_raster = true;
    info_.is_software = is_software;
}

RecordingDevice::~RecordingDevice() = default;

Buffer RecordingDevice::createBuffer(std::size_t bytes, std::string_view name) {
    const std::size_t words = (std::max<std::size_t>(bytes, 4) + 3) / 4;
    Memory& memory =
        memories_.emplace_back(Memory{std::string(name), std::make_unique<std::byte[]>(4 * words)});
    return {*this, {memories_.size(), 0, std::max<std::size_t>(bytes, 4), memory.bytes.get()}};
}

ImageHandle RecordingDevice::createImage(const ImageDesc&) {
    return ImageHandle{++last_handle_};
}
PipelineHandle RecordingDevice::createRasterPipeline(const RasterPipelineDesc&) {
    return PipelineHandle{++last_handle_};
}
CommandEncoder& RecordingDevice::encoder() {
    return *encoder_;
}

std::vector<std::string> RecordingDevice::takeLines() {
    return std::exchange(lines_, {});
}

std::size_t RecordingDevice::buffersAlive() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(memories_, [](const Memory& m) { return m.bytes != nullptr; }));
}

void RecordingDevice::destroyBuffer(std::uint64_t handle) {
    memories_[handle - 1].bytes.reset();
}

const std::string& RecordingDevice::nameOf(BufferView buffer) const {
    return memories_[buffer.handle - 1].name;
}

} // namespace hone

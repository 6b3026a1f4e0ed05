// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/host/host_device.h"

#include "hone/core/error.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace hone {
namespace {

/// Invocations that one task runs at least; also a bound on how often a kernel binds its ports.
constexpr uint kGrain = 1024;

[[noreturn]] void cannotRaster() {
    throw DeviceError(
        "the host device cannot rasterise; install a Vulkan driver (hone doctor says which)");
}

class HostEncoder final : public CommandEncoder {
public:
    void dispatch(const Kernel& kernel, const Arguments& arguments,
                  std::span<const std::byte> params, uint count) override {
        HONE_ASSERT(params.size() == kernel.params_bytes, kernel.name);
        tbb::parallel_for(
            tbb::blocked_range<uint>(0, count, kGrain),
            [&](const tbb::blocked_range<uint>& range) {
                kernel.run(arguments, params.data(), range.begin(), range.end());
            },
            tbb::simple_partitioner());
    }

    void copy(BufferView source, BufferView target) override {
        HONE_ASSERT(source.bytes == target.bytes, "copy between unequal sizes");
        std::memcpy(target.data, source.data, source.bytes);
    }

    void fill(BufferView target, uint word) override { std::ranges::fill(target.as<uint>(), word); }

    void beginRaster(const RasterTarget&) override { cannotRaster(); }
    void drawIndexed(PipelineHandle, CullMode, const Arguments&, std::span<const std::byte>,
                     BufferView, BufferView) override {
        cannotRaster();
    }
    void endRaster() override { cannotRaster(); }
    void copyImage(ImageHandle, BufferView) override { cannotRaster(); }
    void beginScope(std::string_view) override {}
    void endScope() override {}
    void finish() override {}
};

class HostDevice final : public Device {
public:
    HostDevice() {
        info_.name =
            "host (" + std::to_string(tbb::this_task_arena::max_concurrency()) + " threads)";
    }

    const DeviceInfo& info() const override { return info_; }

    Buffer createBuffer(std::size_t bytes, std::string_view name) override {
        constexpr std::size_t kAlignment = 64;
        const std::size_t rounded =
            std::max(kAlignment, (bytes + kAlignment - 1) / kAlignment * kAlignment);
        // A size so near the largest that rounding it wraps around is refused like any other.
        auto* data = rounded < bytes
                         ? nullptr
                         : static_cast<std::byte*>(std::aligned_alloc(kAlignment, rounded));
        if (data == nullptr)
            throw OutOfMemory("no memory for " + std::to_string(bytes) + " bytes of " +
                              std::string(name));
        std::memset(data, 0, rounded);
        return {*this,
                {reinterpret_cast<std::uint64_t>(data), 0, std::max<std::size_t>(bytes, 4), data}};
    }

    /// Kernels of the host take any bytes. An odd handle stands for bytes that are not its own.
    Buffer importBuffer(std::span<std::byte> bytes, std::string_view) override {
        return {
            *this,
            {reinterpret_cast<std::uint64_t>(bytes.data()) | 1u, 0, bytes.size(), bytes.data()}};
    }

    /// Kernels of the host take any bytes.
    BufferView viewOf(std::span<const std::byte> bytes) const override {
        auto* data = const_cast<std::byte*>(bytes.data()); // whoever binds it says what is written
        return {reinterpret_cast<std::uint64_t>(data), 0, bytes.size(), data};
    }

    ImageHandle createImage(const ImageDesc&) override { cannotRaster(); }
    PipelineHandle createRasterPipeline(const RasterPipelineDesc&) override { cannotRaster(); }
    void destroy(ImageHandle) override {}
    void destroy(PipelineHandle) override {}
    CommandEncoder& encoder() override { return encoder_; }
    std::vector<ScopeTiming> takeTimings() override { return {}; }

private:
    void destroyBuffer(std::uint64_t handle) override {
        if ((handle & 1u) == 0)
            std::free(reinterpret_cast<void*>(handle));
    }

    DeviceInfo info_;
    HostEncoder encoder_;
};

} // namespace

std::unique_ptr<Device> makeHostDevice() {
    return std::make_unique<HostDevice>();
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/device/buffer.h"
#include "hone/core/device/kernel.h"
#include "hone/core/math.h"

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hone {

/// What a device is, for decisions and reports.
struct DeviceInfo {
    std::string name;        ///< "llvmpipe (LLVM 15.0.6, 256 bits)", "host (2 threads)"
    std::string driver;      ///< "Mesa 22.3.6", "" for the host
    bool can_raster = false; ///< beginRaster and drawIndexed work
    bool is_software = true; ///< runs on the CPU: the host build of a kernel is then the faster one
    std::size_t max_binding_bytes = SIZE_MAX; ///< what a kernel can read of one buffer
};

/// Formats of attachments. hone samples no image: pixels are copied into linear buffers, and
/// kernels filter by hand, so that host and device do the same arithmetic.
enum class ImageFormat : std::uint8_t { kRg32Uint, kDepth32 };

/// An attachment, made and destroyed by its device.
struct ImageDesc {
    uvec2 extent{0, 0};
    ImageFormat format = ImageFormat::kRg32Uint;
    std::string_view name; ///< shown in validation messages and captures
};

/// A graphics pipeline that reads its vertices from bound buffers (no vertex input state).
///
/// Clip space is Vulkan's: x right, y down (y = -w is row 0 of the image), 0 <= z <= w. Depth is
/// reversed: cleared to 0, the greater value is nearer, of equal ones the first drawn stays.
/// Shaders declare `buffer NAME_buffer { T NAME[]; }`, as kernels do, and parameters from byte 0
/// of a push constant block.
struct RasterPipelineDesc {
    std::string_view name;
    std::span<const std::uint32_t> vertex_spirv;
    std::span<const std::uint32_t> fragment_spirv; ///< empty: depth only
    bool has_color = false;                        ///< writes one kRg32Uint attachment
};

/// kBack leaves out triangles that turn clockwise in the picture (row 0 on top). Where the world's
/// up is up in the picture, that keeps glTF's front faces, which turn counter-clockwise.
enum class CullMode : std::uint8_t { kNone, kBack };

/// One indexed draw; layout of VkDrawIndexedIndirectCommand.
struct DrawIndexed {
    uint index_count = 0;
    uint instance_count = 1;
    uint first_index = 0;
    int vertex_offset = 0;
    uint first_instance = 0;
};

/// Handles of a device's objects. 0 = none. Owned by whoever made them; destroy() gives them back.
enum class ImageHandle : std::uint64_t { kNone = 0 };
enum class PipelineHandle : std::uint64_t { kNone = 0 };

struct RasterTarget {
    ImageHandle color = ImageHandle::kNone; ///< cleared to all ones (no hit)
    ImageHandle depth = ImageHandle::kNone; ///< cleared to 0 (infinitely far)
    uvec2 extent{0, 0};
};

/// Records work for one device, in order; each operation sees what those before it wrote.
///
/// On Vulkan work is recorded and runs at finish(); the host device runs it at once. Nothing here
/// allocates in a steady state. Throws DeviceError.
class CommandEncoder {
public:
    virtual ~CommandEncoder() = default;

    /// Runs `count` invocations of the kernel. Arguments are bound by name; `params` are the bytes
    /// of Kernel::Params.
    virtual void dispatch(const Kernel& kernel, const Arguments& arguments,
                          std::span<const std::byte> params, uint count) = 0;
    /// Copies source to target; sizes must be equal and the stretches must not overlap.
    virtual void copy(BufferView source, BufferView target) = 0;
    /// Sets every 32-bit word of target (a multiple of 4 bytes) to `word`.
    virtual void fill(BufferView target, uint word) = 0;

    /// Clears the target and starts drawing into it, y down, full viewport.
    virtual void beginRaster(const RasterTarget& target) = 0;
    /// Draws every entry of `draws` (DrawIndexed; the device reads them when it runs, so earlier
    /// work may write them) with 32-bit `indices`; gl_InstanceIndex starts at first_instance.
    virtual void drawIndexed(PipelineHandle pipeline, CullMode cull, const Arguments& arguments,
                             std::span<const std::byte> params, BufferView indices,
                             BufferView draws) = 0;
    virtual void endRaster() = 0;
    /// Copies an attachment, rows tightly packed, into target (8 bytes a pixel for kRg32Uint, 4 for
    /// kDepth32).
    virtual void copyImage(ImageHandle image, BufferView target) = 0;

    /// Names what is recorded until endScope() in captures and timings.
    virtual void beginScope(std::string_view name) = 0;
    virtual void endScope() = 0;

    /// Submits what was recorded and waits until it is done; after it the host may read every
    /// buffer. A no-op when nothing is recorded.
    virtual void finish() = 0;
};

/// Time that the scopes of one name took on the device since the last call of takeTimings().
struct ScopeTiming {
    std::string name;
    double ms = 0;
};

/// Where buffers live and work runs: `vulkan` rasterises and runs kernels, `host` runs kernels on
/// all cores over the same kind of mapped bytes, `recording` writes down what was asked, for wiring
/// tests.
///
/// Externally synchronised: one thread at a time. Objects must be destroyed before their device.
/// Throws DeviceError; OutOfMemory when an allocation fails, after which the device is still
/// usable.
class Device {
public:
    virtual ~Device() = default;
    [[nodiscard]] virtual const DeviceInfo& info() const = 0;

    /// A mapped linear buffer, zeroed. `bytes` 0 is rounded up to one word.
    [[nodiscard]] virtual Buffer createBuffer(std::size_t bytes, std::string_view name) = 0;
    /// A buffer that is these bytes of the host, used where they are, not copied. Empty if the
    /// device cannot: the caller then makes a buffer and copies.
    ///
    /// `bytes` must start at a page and have the rest of its last page to itself (PagedVector), and
    /// must stay where it is until the buffer is gone and the work that names it is done.
    [[nodiscard]] virtual Buffer importBuffer(std::span<std::byte> /*bytes*/,
                                              std::string_view /*name*/) {
        return {};
    }
    /// These bytes of the host as a stretch of one of this device's buffers; empty (data null) if
    /// they lie in none.
    [[nodiscard]] virtual BufferView viewOf(std::span<const std::byte> bytes) const = 0;
    [[nodiscard]] virtual ImageHandle createImage(const ImageDesc& desc) = 0;
    [[nodiscard]] virtual PipelineHandle createRasterPipeline(const RasterPipelineDesc& desc) = 0;
    virtual void destroy(ImageHandle image) = 0;
    virtual void destroy(PipelineHandle pipeline) = 0;

    /// The device's one encoder.
    [[nodiscard]] virtual CommandEncoder& encoder() = 0;
    /// Device time by scope name since the last call; empty where the device has no clock.
    [[nodiscard]] virtual std::vector<ScopeTiming> takeTimings() = 0;

private:
    friend class Buffer;
    virtual void destroyBuffer(std::uint64_t handle) = 0;
};

inline Buffer::~Buffer() {
    if (device_ != nullptr)
        device_->destroyBuffer(view_.handle);
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/shading/visibility.h"

#include "hone_spirv/depth_masked_frag.h"
#include "hone_spirv/resolve_hits.h"
#include "hone_spirv/visibility_frag.h"
#include "hone_spirv/visibility_masked_frag.h"
#include "hone_spirv/visibility_vert.h"

#include "hone/core/device/kernel.glsl.h"
#include "hone/core/error.h"

namespace hone {
namespace {

struct ResolveHits : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/shading/resolve_hits.glsl.h"
};
constexpr Kernel kResolveHits = makeKernel<ResolveHits>("resolve_hits", spirv::resolve_hits);

} // namespace

Visibility::~Visibility() {
    if (device_ == nullptr)
        return;
    device_->destroy(color_);
    device_->destroy(depth_);
    for (auto& by_masking : pipelines_)
        for (PipelineHandle pipeline : by_masking)
            device_->destroy(pipeline);
}

void Visibility::prepareImages(Device& device, uvec2 extent, bool has_color) {
    device_ = &device;
    if (extent_ != extent) {
        device.destroy(std::exchange(color_, ImageHandle::kNone));
        device.destroy(std::exchange(depth_, ImageHandle::kNone));
        depth_ = device.createImage({extent, ImageFormat::kDepth32, "visibility_depth"});
        extent_ = extent;
    }
    if (has_color && color_ == ImageHandle::kNone)
        color_ = device.createImage({extent, ImageFormat::kRg32Uint, "visibility_hits"});
}

PipelineHandle Visibility::pipeline(bool has_color, bool is_masked) {
    PipelineHandle& handle = pipelines_[has_color ? 1 : 0][is_masked ? 1 : 0];
    if (handle != PipelineHandle::kNone)
        return handle;
    RasterPipelineDesc desc;
    desc.name = has_color ? "visibility" : "depth";
    desc.vertex_spirv = spirv::visibility_vert;
    desc.has_color = has_color;
    if (is_masked) {
        desc.name = has_color ? "visibility_masked" : "depth_masked";
        desc.fragment_spirv = has_color
                                  ? std::span<const std::uint32_t>(spirv::visibility_masked_frag)
                                  : spirv::depth_masked_frag;
    } else if (has_color) {
        desc.fragment_spirv = spirv::visibility_frag;
    }
    return handle = device_->createRasterPipeline(desc);
}

void Visibility::draw(PassContext& context, const View& view, const Culling& culling,
                      bool has_color) {
    if (context.device == nullptr)
        throw DeviceError("pass \"" + std::string(context.pass_name) +
                          "\" rasterises, but there is no Vulkan device (hone doctor says why)");
    // The host writes the lists, so nothing that was recorded may still read them.
    context.device->finish();
    const Scene& scene = *context.scene().scene;
    prepareImages(*context.memory, view.extent, has_color);
    world_.update(*context.memory, scene);
    list_.build(*context.memory, scene, world_, view, culling);

    Arguments arguments = context.arguments();
    arguments.bind("world_positions", world_.positions());
    arguments.bind("triangle_ids", list_.triangleIds());
    const std::span<const std::byte> params = std::as_bytes(std::span(&view, 1));
    context.device->beginRaster({has_color ? color_ : ImageHandle::kNone, depth_, view.extent});
    // Facing was decided by the list, as exactly as the tracers do, for mirrored instances too.
    if (list_.opaqueDraws().bytes > 0)
        context.device->drawIndexed(pipeline(has_color, false), CullMode::kNone, arguments, params,
                                    list_.indices(), list_.opaqueDraws());
    if (list_.maskedDraws().bytes > 0)
        context.device->drawIndexed(pipeline(has_color, true), CullMode::kNone, arguments, params,
                                    list_.indices(), list_.maskedDraws());
    context.device->endRaster();
}

void Visibility::drawHits(PassContext& context, const View& view, const Culling& culling,
                          BufferView hits) {
    draw(context, view, culling, true);
    context.device->copyImage(color_, hits);
    if (context.chosen != context.device)
        context.device->finish();
    const Argument arguments[] = {{"hits", hits}, {"triangle_ids", list_.triangleIds()}};
    context.dispatch(kResolveHits, ResolveHits::Params{}, view.extent.x * view.extent.y, arguments);
}

void Visibility::drawDepth(PassContext& context, const View& view, const Culling& culling,
                           BufferView depth) {
    draw(context, view, culling, false);
    context.device->copyImage(depth_, depth);
}

} // namespace hone

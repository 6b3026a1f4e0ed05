// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/pass/pass.h"
#include "hone/passes/shading/draw_list.h"

namespace hone {

/// Rasterises what a view sees of a scene: which triangle each pixel's centre falls on, or only how
/// far it is. Owns the images and pipelines; belongs to one pass. Throws DeviceError, OutOfMemory.
class Visibility {
public:
    Visibility() = default;
    Visibility(const Visibility&) = delete;
    Visibility& operator=(const Visibility&) = delete;
    ~Visibility();

    /// Draws the scene of `context` and writes (instance, primitive) of each pixel to `hits`, a
    /// Hit each, kNone where nothing is. The content is there for kernels on context.chosen.
    void drawHits(PassContext& context, const View& view, const Culling& culling, BufferView hits);
    /// Draws depth only and copies it, a float a pixel: camera.near over view depth; orthographic 1
    /// at the camera and 0 at the box's end; 0 where nothing is. The content is there for the
    /// device at once, for the host after finish().
    void drawDepth(PassContext& context, const View& view, const Culling& culling,
                   BufferView depth);

private:
    void draw(PassContext& context, const View& view, const Culling& culling, bool has_color);
    void prepareImages(Device& device, uvec2 extent, bool has_color);
    [[nodiscard]] PipelineHandle pipeline(bool has_color, bool is_masked);

    Device* device_ = nullptr;
    WorldGeometry world_;
    DrawList list_;
    uvec2 extent_{0, 0};
    ImageHandle color_ = ImageHandle::kNone;
    ImageHandle depth_ = ImageHandle::kNone;
    PipelineHandle pipelines_[2][2] = {}; ///< by has_color, is_masked
};

} // namespace hone

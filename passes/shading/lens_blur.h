// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/pass/pass.h"

#include <array>

namespace hone {

/// What passes that blur do unless they are told otherwise, so that they do the same.
inline constexpr uint kBlurTaps = 441;
inline constexpr float kBlurRadiusLimit = 64; ///< pixels

/// What lens_blur.glsl.h needs to know of a frame: how far each pixel's disc of confusion reaches.
/// Owns the buffers; belongs to one pass. Throws OutOfMemory.
class LensBlur {
public:
    static constexpr uint kTile = 16; ///< side in pixels of the tiles that reach is known by
    [[nodiscard]] static uvec2 tiles(uvec2 extent) { return (extent + (kTile - 1)) / kTile; }

    /// Encodes the work on context.chosen, from the pass's ports "depth" and "camera". Discs end at
    /// `radius_limit` pixels.
    void prepare(PassContext& context, float radius_limit);
    /// To bind for a kernel that includes lens_blur.glsl.h.
    [[nodiscard]] std::array<Argument, 2> arguments() const;
    /// How many pixels would be blurred further than the limit of prepare(). The encoder must have
    /// finished.
    [[nodiscard]] std::size_t limitedPixels() const;

private:
    Buffer confusion_, tiles_, reach_, limited_;
    std::size_t tile_count_ = 0;
};

} // namespace hone

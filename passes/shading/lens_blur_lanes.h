// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/device/buffer.h"
#include "hone/core/math.h"

#include <span>
#include <vector>

namespace hone {

/// lensBlurred() of lens_blur.glsl.h for a whole frame on all of the host's cores, several pixels
/// at once (lanes.h): the same bits. Keeps its scratch memory between calls.
class LensBlurLanes {
public:
    struct Frame {
        uvec2 extent;
        uint taps;
        float radius_limit;
        BufferView confusion, reach;    ///< as LensBlur::prepare() leaves them
        std::span<const uint> wanted{}; ///< by tile of LensBlur: 0 where 0 will do; empty: all
    };
    /// Sizes are those of the frame.
    void blur(const Frame& frame, std::span<const vec3> source, std::span<vec3> blurred);
    void blur(const Frame& frame, std::span<const vec2> source, std::span<vec2> blurred);

private:
    std::vector<float> planes_;
};

} // namespace hone

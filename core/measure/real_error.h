// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/image/image.h"

#include <vector>

namespace hone {

/// How far an image is from the truth, pixel by pixel, as a screen shows both (toDisplay).
struct RealError {
    std::vector<float> max;    ///< greatest difference of a channel, in [0,1]; 0 = the same bits
    std::vector<float> square; ///< mean of the channels' squared differences; its mean is the MSE
};

/// What pass measure.error gives by default and with norm mean_square, by the same source, for
/// images of radiance that are already on the host. A channel of which either is not finite and
/// that is not the same bits differs by 1. Throws InputError if the extents differ.
[[nodiscard]] RealError realError(const RgbImage& image, const RgbImage& truth);

} // namespace hone

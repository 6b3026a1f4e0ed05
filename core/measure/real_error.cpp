// SPDX-License-Identifier: Apache-2.0
#include "hone/core/measure/real_error.h"

#include "hone/core/error.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace hone {

RealError realError(const RgbImage& image, const RgbImage& truth) {
    if (image.extent != truth.extent || image.pixels.size() != truth.pixels.size())
        throw InputError("the image and its truth have different extents");
    const RgbImage shown = toDisplay(image);
    const RgbImage aimed = toDisplay(truth);
    RealError result;
    result.max.resize(image.pixels.size());
    result.square.resize(image.pixels.size());
    for (std::size_t pixel = 0; pixel < image.pixels.size(); ++pixel) {
        float squares = 0;
        for (int channel = 0; channel < 3; ++channel) {
            const float a = image.pixels[pixel][channel];
            const float b = truth.pixels[pixel][channel];
            float difference =
                std::fabs(shown.pixels[pixel][channel] - aimed.pixels[pixel][channel]);
            if (std::bit_cast<uint>(a) == std::bit_cast<uint>(b))
                difference = 0;
            else if (!std::isfinite(a) || !std::isfinite(b))
                difference = 1;
            result.max[pixel] = std::max(result.max[pixel], difference);
            squares += difference * difference;
        }
        result.square[pixel] = squares / 3;
    }
    return result;
}

} // namespace hone

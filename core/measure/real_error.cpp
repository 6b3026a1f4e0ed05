// SPDX-License-Identifier: Apache-2.0
#include "hone/core/measure/real_error.h"

#include "hone/core/device/kernel.glsl.h"
#include "hone/core/error.h"

namespace hone {
namespace {

struct ScreenError : HostKernel {
    using HostKernel::HostKernel;
    static float shown(float radiance) { return toDisplay(radiance); }
#include "hone/core/measure/real_error.glsl.h"
};

} // namespace

RealError realError(const RgbImage& image, const RgbImage& truth) {
    if (image.extent != truth.extent || image.pixels.size() != truth.pixels.size())
        throw InputError("the image and its truth have different extents");
    HONE_ASSERT(!image.is_display && !truth.is_display, "radiance is compared");
    const Arguments no_buffers;
    ScreenError source(no_buffers, nullptr);
    RealError result;
    result.max.reserve(image.pixels.size());
    result.square.reserve(image.pixels.size());
    for (std::size_t pixel = 0; pixel < image.pixels.size(); ++pixel) {
        const vec3 errors = source.channelErrors(image.pixels[pixel], truth.pixels[pixel]);
        result.max.push_back(source.greatest(errors));
        result.square.push_back(source.meanSquare(errors));
    }
    return result;
}

} // namespace hone

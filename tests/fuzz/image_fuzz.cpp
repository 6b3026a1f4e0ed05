// SPDX-License-Identifier: Apache-2.0
//
// Hostile images: PNG and JPEG as textures, EXR as what is compared. Whatever the bytes are, they
// are decoded or refused with an InputError that names the file. Run with libFuzzer
// (tests/fuzz/CMakeLists.txt).
#include "hone/core/error.h"
#include "hone/core/image/decode.h"
#include "hone/core/image/exr.h"
#include "hone/tests/fuzz/require.h"

#include <string>

namespace hone {
namespace {

void checkTexture(std::span<const std::byte> file) {
    const Image8 image = decodeImage(file, "image");
    require(image.extent.x > 0 && image.extent.y > 0 && image.extent.x <= kMaxImageSide &&
                image.extent.y <= kMaxImageSide,
            "the extent is within limits");
    require(image.rgba.size() == std::size_t{4} * image.extent.x * image.extent.y,
            "four bytes a pixel");
}

void checkExr(std::span<const std::byte> file) {
    const LayeredImage image = decodeExr(file, "image");
    for (const ImageLayer& layer : image.layers)
        require(layer.values.size() ==
                    std::size_t{image.extent.x} * image.extent.y * layer.channel_names.size(),
                "a value for each channel of each pixel");
    const LayeredImage again = decodeExr(encodeExr(image), "image");
    require(again.extent == image.extent && again.layers.size() == image.layers.size(),
            "what was read can be written and read");
}

} // namespace
} // namespace hone

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hone;
    const std::span file(reinterpret_cast<const std::byte*>(data), size);
    try {
        if (isExr(file))
            checkExr(file);
        else
            checkTexture(file);
    } catch (const InputError& error) {
        require(std::string(error.what()).starts_with("image"), "the message names the file");
    }
    return 0;
}

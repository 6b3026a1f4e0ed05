// SPDX-License-Identifier: Apache-2.0
#include "hone/core/image/image.h"

#include "hone/core/error.h"
#include "hone/core/image/atomic_file.h"
#include "hone/core/image/exr.h"
#include "hone/core/image/jpeg.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <system_error>

namespace hone {
namespace {

std::optional<std::size_t> channelOf(const ImageLayer& layer, std::string_view name) {
    const auto found = std::find(layer.channel_names.begin(), layer.channel_names.end(), name);
    if (found == layer.channel_names.end())
        return std::nullopt;
    return static_cast<std::size_t>(found - layer.channel_names.begin());
}

/// R, G, B, or the only channel three times.
std::optional<uvec3> colorChannels(const ImageLayer& layer) {
    const auto r = channelOf(layer, "R"), g = channelOf(layer, "G"), b = channelOf(layer, "B");
    if (r && g && b)
        return uvec3(*r, *g, *b);
    if (layer.channel_names.size() == 1)
        return uvec3(0);
    return std::nullopt;
}

const ImageLayer& findColorLayer(const LayeredImage& image, std::string_view wanted,
                                 const std::string& path) {
    const auto named = [&](std::string_view name) -> const ImageLayer* {
        for (const ImageLayer& layer : image.layers)
            if (layer.name == name && colorChannels(layer))
                return &layer;
        return nullptr;
    };
    if (const ImageLayer* layer = named(wanted))
        return *layer;
    if (wanted.empty()) {
        if (const ImageLayer* layer = named("color"))
            return *layer;
        for (const ImageLayer& layer : image.layers)
            if (colorChannels(layer))
                return layer;
    }
    std::string names;
    for (const ImageLayer& layer : image.layers)
        names += (names.empty() ? "\"" : ", \"") + layer.name + "\"";
    throw InputError(path + ": has no colour layer \"" + std::string(wanted) +
                     "\" with channels R, G, B or one channel; its layers are " + names);
}

RgbImage fromLayer(const ImageLayer& layer, uvec2 extent) {
    const uvec3 channel = *colorChannels(layer);
    const std::size_t stride = layer.channel_names.size();
    RgbImage result{extent, {}, false};
    result.pixels.reserve(std::size_t(extent.x) * extent.y);
    for (std::size_t i = 0; i < layer.values.size(); i += stride)
        result.pixels.emplace_back(layer.values[i + channel.x], layer.values[i + channel.y],
                                   layer.values[i + channel.z]);
    return result;
}

RgbImage fromCodes(const Image8& image) {
    RgbImage result{image.extent, {}, true};
    result.pixels.reserve(image.rgba.size() / 4);
    for (std::size_t i = 0; i < image.rgba.size(); i += 4)
        result.pixels.push_back(vec3(image.rgba[i], image.rgba[i + 1], image.rgba[i + 2]) / 255.0f);
    return result;
}

} // namespace

std::vector<std::string> usualChannelNames(std::size_t channels) {
    switch (channels) {
    case 1:
        return {"Y"};
    case 2:
        return {"X", "Y"};
    case 3:
        return {"R", "G", "B"};
    case 4:
        return {"R", "G", "B", "A"};
    default:
        HONE_ASSERT(false, std::to_string(channels) + " channels");
        return {};
    }
}

// The sRGB transfer function (IEC 61966-2-1).
float toDisplay(float radiance) {
    const float x = radiance > 0.0f ? std::min(radiance, 1.0f) : 0.0f;
    return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
}

RgbImage toDisplay(const RgbImage& image) {
    RgbImage result = image;
    result.is_display = true;
    if (!image.is_display)
        for (vec3& pixel : result.pixels)
            pixel = vec3(toDisplay(pixel.x), toDisplay(pixel.y), toDisplay(pixel.z));
    return result;
}

Image8 quantize(uvec2 extent, std::span<const vec3> display) {
    HONE_ASSERT(display.size() == std::size_t(extent.x) * extent.y, std::to_string(display.size()));
    const auto code = [](float x) {
        return static_cast<std::uint8_t>(x > 0.0f ? std::min(x, 1.0f) * 255.0f + 0.5f : 0.0f);
    };
    Image8 image{extent, {}};
    image.rgba.reserve(4 * display.size());
    for (const vec3& pixel : display)
        image.rgba.insert(image.rgba.end(), {code(pixel.x), code(pixel.y), code(pixel.z), 255});
    return image;
}

std::vector<std::byte> readFile(const std::string& path) {
    const auto fail = [&](int error) {
        throw InputError(path + ": cannot be read: " + std::generic_category().message(error));
    };
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                               std::fclose);
    if (!file)
        fail(errno);
    // By pieces: the size that a pipe or a growing file reports means nothing.
    std::vector<std::byte> bytes;
    constexpr std::size_t kPiece = 1 << 20;
    std::size_t read = kPiece;
    while (read == kPiece) {
        const std::size_t old = bytes.size();
        bytes.resize(old + kPiece);
        errno = 0;
        read = std::fread(bytes.data() + old, 1, kPiece, file.get());
        if (std::ferror(file.get()) != 0)
            fail(errno);
        bytes.resize(old + read);
        if (bytes.size() > (std::uint64_t(4) << 30))
            throw InputError(path + ": is larger than 4 GiB; no image of hone's is");
    }
    return bytes;
}

LayeredImage readExr(const std::string& path) {
    const std::vector<std::byte> file = readFile(path);
    if (!isExr(file))
        throw InputError(path + ": is no OpenEXR file");
    return decodeExr(file, path);
}

RgbImage readRgb(const std::string& path, std::string_view layer) {
    const std::vector<std::byte> file = readFile(path);
    if (isExr(file)) {
        const LayeredImage image = decodeExr(file, path);
        return fromLayer(findColorLayer(image, layer, path), image.extent);
    }
    if (!layer.empty())
        throw InputError(path + ": only OpenEXR files have layers, and \"" + std::string(layer) +
                         "\" was asked for");
    if (!isPng(file) && !isJpeg(file))
        throw InputError(path + ": is neither OpenEXR, PNG nor JPEG; convert it to one of them");
    return fromCodes(decodeImage(file, path));
}

void writeExr(const std::string& path, const LayeredImage& image) {
    writeFileAtomically(path, encodeExr(image));
}

void writePng(const std::string& path, const Image8& image, const ImageText& text) {
    writeFileAtomically(path, encodePng(image, text));
}

} // namespace hone

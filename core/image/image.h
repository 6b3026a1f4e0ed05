// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/image/decode.h"
#include "hone/core/image/png.h"

#include <string_view>

namespace hone {

/// Channels that belong together, such as "color" with R, G, B or "error" with expect, bound.
struct ImageLayer {
    std::string name; ///< "" for the image itself: viewers show it first
    std::vector<std::string> channel_names;
    std::vector<float> values; ///< interleaved: channels of a pixel, pixels of a row, rows top down
};

/// What one OpenEXR file holds. Channels are stored as "layer.channel", which tev, Blender and Nuke
/// group again.
struct LayeredImage {
    uvec2 extent{0, 0};
    std::vector<ImageLayer> layers;
    std::vector<std::pair<std::string, std::string>> attributes; ///< text: where it came from
};

/// A colour image with three floats a pixel.
struct RgbImage {
    uvec2 extent{0, 0};
    std::vector<vec3> pixels; ///< rows top down
    bool is_display = false;  ///< sRGB-encoded in [0,1] (from PNG, JPEG); otherwise linear radiance
};

/// "Y"; "X", "Y"; "R", "G", "B"; "R", "G", "B", "A". Precondition: 1 to 4.
[[nodiscard]] std::vector<std::string> usualChannelNames(std::size_t channels);

/// Linear to display: cut to [0,1] (NaN to 0) and sRGB-encoded. A display image comes back as it
/// is.
[[nodiscard]] RgbImage toDisplay(const RgbImage& image);
/// The same for a channel of radiance.
[[nodiscard]] float toDisplay(float radiance);

/// Display values in [0,1], already encoded, rounded to 8 bits, opaque. Others are cut; NaN is 0.
[[nodiscard]] Image8 quantize(uvec2 extent, std::span<const vec3> display);

/// The bytes of a file. Throws InputError with the path and the system's reason, and for more than
/// 4 GiB.
[[nodiscard]] std::vector<std::byte> readFile(const std::string& path);

/// Reads every layer of an EXR. Throws InputError.
[[nodiscard]] LayeredImage readExr(const std::string& path);

/// Reads a colour image from EXR, PNG or JPEG, told apart by content. In an EXR: the channels R, G,
/// B (or the single channel as grey) of the layer of that name; for "" of the unnamed layer, else
/// of "color", else of the first layer that has them. Alpha is dropped. Throws InputError, for a
/// missing layer with the names there are.
[[nodiscard]] RgbImage readRgb(const std::string& path, std::string_view layer = {});

/// Writes atomically (atomic_file.h). Precondition as of encodeExr and encodePng. Throws
/// OutputError.
void writeExr(const std::string& path, const LayeredImage& image);
void writePng(const std::string& path, const Image8& image, const ImageText& text = {});

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/math.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace hone {

/// An image of 8-bit codes: colour as the file has it (sRGB by convention), alpha linear.
struct Image8 {
    uvec2 extent{0, 0};
    std::vector<std::uint8_t> rgba; ///< 4 bytes a pixel, rows top down
};

/// Larger images are refused, whatever they claim to hold.
inline constexpr uint kMaxImageSide = 16384;
inline constexpr std::uint64_t kMaxImagePixels = 1ull << 28;

/// Decodes a PNG or JPEG, told apart by their first bytes. All kinds of PNG and grey or YCbCr JPEG
/// become RGBA8; 16-bit samples are rounded; colour profiles and gamma chunks are ignored, as glTF
/// demands. `name` stands in messages only. Throws InputError on anything else, on corrupt or
/// truncated content and on more than kMaxImageSide or kMaxImagePixels.
[[nodiscard]] Image8 decodeImage(std::span<const std::byte> file, const std::string& name);

} // namespace hone

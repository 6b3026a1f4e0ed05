// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/image/decode.h"

#include <utility>

namespace hone {

/// Keyword and text, in file order. Keywords: 1 to 79 printable Latin-1 characters; texts: UTF-8.
using ImageText = std::vector<std::pair<std::string, std::string>>;

[[nodiscard]] bool isPng(std::span<const std::byte> file);

/// decodeImage for PNG. Throws InputError.
[[nodiscard]] Image8 decodePng(std::span<const std::byte> file, const std::string& name);

/// The bytes of a PNG: RGB, or RGBA where some alpha is not 255, marked as sRGB, with `text` in
/// tEXt or (where not ASCII) iTXt chunks. The same input gives the same bytes. Precondition: extent
/// not zero, rgba complete.
[[nodiscard]] std::vector<std::byte> encodePng(const Image8& image, const ImageText& text = {});

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/image/image.h"

namespace hone {

[[nodiscard]] bool isExr(std::span<const std::byte> file);

/// Decodes a single-part, flat OpenEXR file, scan lines or tiles (the top level). Channels are
/// grouped into layers by what stands before the last dot of their names; half and uint become
/// float. Throws InputError, also for deep and multi-part files, subsampled channels and images
/// larger than kMaxImageSide or 2^29 values.
[[nodiscard]] LayeredImage decodeExr(std::span<const std::byte> file, const std::string& name);

/// The bytes of an OpenEXR file: 32-bit float, ZIP, scan lines. The same input gives the same
/// bytes. Preconditions: extent not zero; every layer complete; no two channels and no two
/// attributes of one name, none of the names that OpenEXR keeps for itself ("channels", …).
[[nodiscard]] std::vector<std::byte> encodeExr(const LayeredImage& image);

} // namespace hone

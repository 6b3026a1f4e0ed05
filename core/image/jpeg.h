// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/image/decode.h"

namespace hone {

[[nodiscard]] bool isJpeg(std::span<const std::byte> file);

/// decodeImage for JPEG, baseline and progressive. Throws InputError, also for CMYK.
[[nodiscard]] Image8 decodeJpeg(std::span<const std::byte> file, const std::string& name);

} // namespace hone

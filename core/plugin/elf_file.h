// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace hone {

/// Why a file cannot be loaded as a shared library of this machine; "" if its headers are sound.
/// Asked before dlopen, which maps what a truncated file claims to have and dies where it touches
/// it, and whose reasons are terse.
[[nodiscard]] std::string whyNotLoadable(const std::filesystem::path& file);

} // namespace hone

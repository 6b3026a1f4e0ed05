// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hone {

/// What a name like "check(embree)" or "check(embree, vulkan)" asks for: check_backend.h.
struct CheckName {
    std::string_view first;
    std::string_view second; ///< "" = none
};

/// Reads a check's name; nothing if it is no such name. Whether the inner backends exist is not
/// asked.
[[nodiscard]] std::optional<CheckName> parseCheckName(std::string_view name);

/// The names that someone who wrote `name` may have meant, of a program that has `backends`: those,
/// or checks of them.
[[nodiscard]] std::vector<std::string> similarNames(std::string_view name,
                                                    std::span<const std::string> backends);

} // namespace hone

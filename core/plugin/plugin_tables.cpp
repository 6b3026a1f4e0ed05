// SPDX-License-Identifier: Apache-2.0
#include "hone/core/plugin/plugin_tables.h"

#include "hone/core/plugin/hone_pass.h"
#include "hone/core/printable.h"

#include <cmath>

namespace hone {
namespace {

constexpr std::size_t kLongestName = 64;
constexpr std::size_t kLongestText = 1024;

bool isNameByte(char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
}

} // namespace

std::string textOf(const char* text, const std::string& what) {
    if (text == nullptr)
        throw Refusal(what + " is missing (NULL)");
    const std::string_view seen(text, strnlen(text, kLongestText + 1));
    if (seen.empty())
        throw Refusal(what + " is empty");
    if (seen.size() > kLongestText)
        throw Refusal(what + " is longer than " + std::to_string(kLongestText) + " bytes");
    if (std::ranges::any_of(seen,
                            [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; }))
        throw Refusal(what + " has control bytes: \"" + printable(seen) + "\"");
    return std::string(seen);
}

std::string optionalTextOf(const char* text, const std::string& what) {
    return text != nullptr ? textOf(text, what) : "";
}

std::string nameOf(const char* text, const std::string& what) {
    std::string name = textOf(text, what);
    if (name.size() > kLongestName || name.front() < 'a' || name.front() > 'z' ||
        !std::ranges::all_of(name, [](char c) { return isNameByte(c) || c == '.'; }) ||
        name == "auto")
        throw Refusal(what + " \"" + printable(name) +
                      "\" is no name: use a-z, 0-9, _ and ., a letter first, at most " +
                      std::to_string(kLongestName) + " bytes, not \"auto\"");
    return name;
}

std::string inQuotes(std::string_view text) {
    return "\"" + printable(text) + "\"";
}

TableRange rangeOf(std::uint32_t flags, double min, double max, const std::string& what) {
    TableRange range;
    if ((flags & HONE_HAS_MIN) != 0)
        range.min = min;
    if ((flags & HONE_HAS_MAX) != 0)
        range.max = max;
    if ((range.min && !std::isfinite(min)) || (range.max && !std::isfinite(max)))
        throw Refusal(what + ": min and max must be finite; without their flags there is no limit");
    if (range.min && range.max && min > max)
        throw Refusal(what + ": min " + std::to_string(min) + " is greater than max " +
                      std::to_string(max));
    return range;
}

void checkFlags(std::uint32_t flags, std::uint32_t known, std::uint32_t abi_minor,
                const std::string& what) {
    if (abi_minor <= HONE_PLUGIN_ABI_MINOR && (flags & ~known) != 0)
        throw Refusal(what + ": flags has bits that mean nothing");
}

std::string memberNameOf(const char* text, const std::string& what) {
    std::string name = textOf(text, what);
    if (name.size() > kLongestName || name.front() < 'a' || name.front() > 'z' ||
        !std::ranges::all_of(name, isNameByte))
        throw Refusal(what + " \"" + printable(name) +
                      "\" is no name: use a-z, 0-9 and _, a letter first, at most " +
                      std::to_string(kLongestName) + " bytes");
    return name;
}

} // namespace hone

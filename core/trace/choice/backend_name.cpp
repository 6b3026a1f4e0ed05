// SPDX-License-Identifier: Apache-2.0
#include "hone/core/trace/choice/backend_name.h"

namespace hone {
namespace {

constexpr std::string_view kCheck = "check";

std::string_view trim(std::string_view text) {
    const std::size_t first = text.find_first_not_of(' ');
    if (first == std::string_view::npos)
        return {};
    return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

} // namespace

std::optional<CheckName> parseCheckName(std::string_view name) {
    if (!name.starts_with(kCheck) || !name.ends_with(')'))
        return {};
    name.remove_prefix(kCheck.size());
    if (!name.starts_with('('))
        return {};
    const std::string_view inside = name.substr(1, name.size() - 2);
    if (inside.find_first_of("()") != std::string_view::npos)
        return {};
    const std::size_t comma = inside.find(',');
    CheckName result{trim(inside.substr(0, comma)), {}};
    if (comma != std::string_view::npos) {
        result.second = trim(inside.substr(comma + 1));
        if (result.second.empty() || result.second.find(',') != std::string_view::npos)
            return {};
    }
    if (result.first.empty())
        return {};
    return result;
}

std::vector<std::string> similarNames(std::string_view name,
                                      std::span<const std::string> backends) {
    if (!name.starts_with(kCheck))
        return {backends.begin(), backends.end()};
    std::vector<std::string> names;
    for (const std::string& first : backends)
        names.push_back("check(" + first + ")");
    for (const std::string& first : backends)
        for (const std::string& second : backends)
            if (first != second)
                names.push_back("check(" + first + "," + second + ")");
    return names;
}

} // namespace hone

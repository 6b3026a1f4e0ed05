// SPDX-License-Identifier: Apache-2.0
#include "hone/core/graph/source_text.h"

#include <algorithm>

namespace hone {

SourceText::SourceText(std::string file, std::string text)
    : file_(std::move(file)), text_(std::move(text)) {
    for (std::size_t i = 0; i < text_.size(); ++i)
        if (text_[i] == '\n')
            line_begins_.push_back(static_cast<std::uint32_t>(i + 1));
}

SourceText::Position SourceText::locate(std::uint32_t offset) const {
    const auto after = std::ranges::upper_bound(line_begins_, offset);
    const std::size_t line = static_cast<std::size_t>(after - line_begins_.begin());
    return {line, offset - line_begins_[line - 1] + std::size_t{1}};
}

std::string_view SourceText::line(std::size_t number) const {
    const std::size_t begin = line_begins_[number - 1];
    const std::size_t end =
        number < line_begins_.size() ? line_begins_[number] - std::size_t{1} : text_.size();
    std::string_view result = std::string_view(text_).substr(begin, end - begin);
    if (result.ends_with('\r'))
        result.remove_suffix(1);
    return result;
}

} // namespace hone

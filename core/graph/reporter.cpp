// SPDX-License-Identifier: Apache-2.0
#include "hone/core/graph/reporter.h"

#include <algorithm>

namespace hone {
namespace {

/// More than that nobody reads; a hostile file could hold millions.
constexpr std::size_t kMaxReported = 100;

/// The part of a line that is worth printing.
struct Excerpt {
    std::string text;
    std::size_t column;
};

Excerpt excerptAround(std::string_view line, std::size_t column) {
    constexpr std::size_t kWidth = 160;
    // The place may be the end of the line, which a carriage return puts one byte further.
    column = std::min(column, line.size() + 1);
    if (line.size() <= kWidth)
        return {std::string(line), column};
    const std::size_t begin = column > kWidth / 4 ? column - kWidth / 4 : 0;
    return {std::string(line.substr(std::min(begin, line.size()), kWidth)), column - begin};
}

} // namespace

void Reporter::add(Severity severity, const char* code, const Place& place, std::string message,
                   std::string hint) {
    failed_ |= severity == Severity::kError;
    Diagnostic diagnostic;
    diagnostic.code = code;
    diagnostic.severity = severity;
    const SourceText& source = place.source != nullptr ? *place.source : *source_;
    diagnostic.file = source.file();
    diagnostic.pointer = place.pointer;
    diagnostic.message = std::move(message);
    diagnostic.hint = std::move(hint);
    if (place.source != nullptr) {
        const SourceText::Position position = source.locate(place.span.begin);
        diagnostic.line = position.line;
        diagnostic.column = position.column;
        diagnostic.length = std::max<std::size_t>(1, place.span.length);
        Excerpt excerpt = excerptAround(source.line(position.line), position.column);
        diagnostic.source = std::move(excerpt.text);
        diagnostic.source_column = excerpt.column;
    }
    const bool is_known = std::ranges::any_of(*diagnostics_, [&](const Diagnostic& other) {
        return other.code == diagnostic.code && other.file == diagnostic.file &&
               other.line == diagnostic.line && other.column == diagnostic.column &&
               other.message == diagnostic.message;
    });
    last_dropped_ = is_known || reported_ >= kMaxReported;
    if (!last_dropped_) {
        diagnostics_->push_back(std::move(diagnostic));
        ++reported_;
    }
}

void Reporter::error(const char* code, const Place& place, std::string message, std::string hint) {
    add(Severity::kError, code, place, std::move(message), std::move(hint));
}

void Reporter::warning(const char* code, const Place& place, std::string message,
                       std::string hint) {
    add(Severity::kWarning, code, place, std::move(message), std::move(hint));
}

void Reporter::note(const Place& place, std::string message) {
    if (last_dropped_ || diagnostics_->empty())
        return;
    Note note{.message = std::move(message)};
    if (place.source != nullptr) {
        const SourceText::Position position = place.source->locate(place.span.begin);
        note.file = place.source->file();
        note.line = position.line;
        note.column = position.column;
    }
    diagnostics_->back().notes.push_back(std::move(note));
}

std::string quotedList(const std::vector<std::string>& words) {
    constexpr std::size_t kShown = 8;
    std::string result;
    for (std::size_t i = 0; i < std::min(words.size(), kShown); ++i) {
        if (i > 0)
            result += i + 1 == words.size() ? " and " : ", ";
        result += "\"" + words[i] + "\"";
    }
    if (words.size() > kShown)
        result += ", ... (" + std::to_string(words.size()) + " in all)";
    return result;
}

std::string suggest(std::string_view word, const std::vector<std::string>& candidates,
                    std::string_view otherwise) {
    if (const std::string near = nearest(word, candidates); !near.empty())
        return "did you mean \"" + near + "\"?";
    if (candidates.empty())
        return "";
    return std::string(otherwise) + " " + quotedList(candidates);
}

} // namespace hone

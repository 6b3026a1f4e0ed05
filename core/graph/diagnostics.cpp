// SPDX-License-Identifier: Apache-2.0
#include "hone/core/graph/diagnostics.h"

#include <algorithm>

namespace hone {
namespace {

/// Text from a file is not trusted: a terminal must not see its control bytes.
std::string printable(std::string_view text) {
    std::string result(text);
    for (char& c : result)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            c = c == '\t' ? ' ' : '?';
    return result;
}

/// Characters, not bytes, so that carets stand below what they mean.
std::size_t characters(std::string_view utf8) {
    return static_cast<std::size_t>(std::ranges::count_if(
        utf8, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string at(const std::string& file, std::size_t line, std::size_t column) {
    if (line == 0)
        return file.empty() ? "" : file + ": ";
    return file + ":" + std::to_string(line) + ":" + std::to_string(column) + ": ";
}

/// The line of the file with carets below the place.
std::string excerpt(const Diagnostic& diagnostic) {
    const std::string line = printable(diagnostic.source);
    const std::string number = std::to_string(diagnostic.line);
    const std::string gutter(number.size() + 1, ' ');
    const std::size_t begin = std::min(diagnostic.source_column - 1, line.size());
    const std::size_t length = std::min(diagnostic.length, line.size() - begin);
    const std::string indent(characters(std::string_view(line).substr(0, begin)), ' ');
    const std::string carets(
        std::max<std::size_t>(1, characters(std::string_view(line).substr(begin, length))), '^');
    std::string result =
        gutter + "|\n" + number + " | " + line + "\n" + gutter + "| " + indent + carets;
    if (!diagnostic.pointer.empty())
        result += " in " + printable(diagnostic.pointer);
    return result + "\n";
}

} // namespace

std::string format(const Diagnostic& diagnostic) {
    const char* kind = diagnostic.severity == Severity::kError ? "error " : "warning ";
    std::string result = printable(at(diagnostic.file, diagnostic.line, diagnostic.column)) + kind +
                         diagnostic.code + ": " + printable(diagnostic.message) + "\n";
    const std::string gutter(diagnostic.line == 0 ? 2 : std::to_string(diagnostic.line).size() + 1,
                             ' ');
    if (diagnostic.line != 0)
        result += excerpt(diagnostic);
    for (const Note& note : diagnostic.notes)
        result += gutter +
                  "= note: " + printable(at(note.file, note.line, note.column) + note.message) +
                  "\n";
    if (!diagnostic.hint.empty())
        result += gutter + "= help: " + printable(diagnostic.hint) + "\n";
    return result;
}

std::string format(const std::vector<Diagnostic>& diagnostics) {
    std::string result;
    for (const Diagnostic& diagnostic : diagnostics)
        result += format(diagnostic) + "\n";
    return result;
}

namespace {

/// Edits that turn `a` into `b`: insert, delete, replace, swap neighbours (Damerau 1964, restricted
/// to one edit a place). Counted in halves: a letter of the wrong case is half an edit.
std::size_t distance(std::string_view a, std::string_view b) {
    auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
    auto cost = [&](char x, char y) -> std::size_t {
        return x == y ? 0 : lower(x) == lower(y) ? 1 : 2;
    };
    std::vector<std::size_t> before_last(b.size() + 1);
    std::vector<std::size_t> last(b.size() + 1);
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j)
        last[j] = 2 * j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = 2 * i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] =
                std::min({last[j] + 2, row[j - 1] + 2, last[j - 1] + cost(a[i - 1], b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before_last[j - 2] + 2);
        }
        std::swap(before_last, last);
        std::swap(last, row);
    }
    return last[b.size()];
}

} // namespace

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
    // Longer words are no typos; also a bound on the work that a hostile file can ask for.
    constexpr std::size_t kLongest = 256;
    if (word.empty() || word.size() > kLongest)
        return "";
    std::string best;
    std::size_t best_distance = kLongest;
    for (const std::string& candidate : candidates) {
        if (candidate.size() > kLongest)
            continue;
        // One edit for every three letters begun, as clang has it. Of four letters two are half:
        // then the first one, which is seldom wrong (Pollock and Zamora 1984), must be right.
        const bool is_half = word.size() == 4 && !candidate.starts_with(word.front());
        const std::size_t limit = is_half ? 2 : 2 * ((word.size() + 2) / 3);
        const std::size_t d = distance(word, candidate);
        // Of two as near, the longer one has more letters as they were typed.
        if (d <= limit &&
            (d < best_distance || (d == best_distance && candidate.size() > best.size()))) {
            best = candidate;
            best_distance = d;
        }
    }
    return best;
}

} // namespace hone

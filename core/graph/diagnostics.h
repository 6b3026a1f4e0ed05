// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace hone {

enum class Severity : std::uint8_t { kWarning, kError };

/// Another place that has to do with a problem: the other end of an edge, the first of two keys.
struct Note {
    std::string file{};
    std::size_t line = 0; ///< from 1; 0 = not in the file
    std::size_t column = 0;
    std::string message;
};

/// One problem in a graph file, with the place a person must look at.
struct Diagnostic {
    std::string code; ///< stable: E0301
    Severity severity = Severity::kError;
    std::string file;
    std::size_t line = 0;   ///< from 1; 0 = not in a file (an override from the command line)
    std::size_t column = 0; ///< from 1, in bytes
    std::size_t length = 1; ///< bytes to underline
    std::string pointer;    ///< JSON pointer: /passes/sort/in/error
    std::string message;    ///< one sentence: which thing, what is wrong, what was expected
    std::string hint;       ///< what to do: "did you mean ...?"; may be ""
    std::string source;     ///< the line of the file; of a long line the part around the place
    std::size_t source_column = 1; ///< where in `source` the place begins, from 1
    std::vector<Note> notes;
};

/// The report for a terminal: place, code, message, source line with carets, hint. Control bytes in
/// names are replaced.
[[nodiscard]] std::string format(const Diagnostic& diagnostic);
[[nodiscard]] std::string format(const std::vector<Diagnostic>& diagnostics);

/// The candidate that `word` was meant to be: the one that the fewest edits lead to, at most one
/// for every three letters begun; of those the longest, then the first. "" if there is none.
[[nodiscard]] std::string nearest(std::string_view word,
                                  const std::vector<std::string>& candidates);

} // namespace hone

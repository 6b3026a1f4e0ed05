// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/graph/diagnostics.h"
#include "hone/core/graph/source_text.h"

#include <string>
#include <vector>

namespace hone {

/// Collects the problems of one graph file, each once, with their places made ready for a person.
class Reporter {
public:
    /// Both must outlive the reporter.
    Reporter(const SourceText& source, std::vector<Diagnostic>& diagnostics)
        : source_(&source), diagnostics_(&diagnostics) {}

    /// Codes are stable: tests/bad_graphs holds one graph for each.
    void error(const char* code, const Place& place, std::string message, std::string hint = {});
    void warning(const char* code, const Place& place, std::string message, std::string hint = {});
    /// Adds another place to the problem reported last.
    void note(const Place& place, std::string message);

    /// Was an error reported by this reporter?
    [[nodiscard]] bool failed() const { return failed_; }

private:
    void add(Severity severity, const char* code, const Place& place, std::string message,
             std::string hint);

    const SourceText* source_;
    std::vector<Diagnostic>* diagnostics_;
    bool failed_ = false;
    bool last_dropped_ = false;
    std::size_t reported_ = 0;
};

/// "a", "b" and "c": for messages that list what there is. At most eight, then "...".
[[nodiscard]] std::string quotedList(const std::vector<std::string>& words);
/// `did you mean "x"?` for the nearest candidate, else the list of all with `otherwise` before it.
[[nodiscard]] std::string suggest(std::string_view word, const std::vector<std::string>& candidates,
                                  std::string_view otherwise);

} // namespace hone

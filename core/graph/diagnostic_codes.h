// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/graph/diagnostics.h"

#include <span>
#include <string_view>

namespace hone {

/// What a diagnostic's code stands for, whatever graph it is found in. Codes are stable: one that
/// is no longer used is not given to something else.
struct DiagnosticCode {
    std::string_view code; ///< "E0301"
    Severity severity = Severity::kError;
    std::string_view title;   ///< one line
    std::string_view meaning; ///< why it is a problem, and what to do
    std::string_view wrong;   ///< a part of a graph that has the problem; "" where none helps
    std::string_view right;   ///< the same part without it
};

/// All codes that reading and compiling a graph can report, ascending.
[[nodiscard]] std::span<const DiagnosticCode> diagnosticCodes();
/// By name, in either case ("e0301"); null if there is none.
[[nodiscard]] const DiagnosticCode* findDiagnosticCode(std::string_view code);

} // namespace hone

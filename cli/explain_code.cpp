// SPDX-License-Identifier: Apache-2.0
//
// hone explain CODE: what a diagnostic means, whatever graph it was found in.
#include "hone/cli/explain_code.h"

#include "hone/cli/json.h"
#include "hone/core/graph/diagnostic_codes.h"

#include <algorithm>
#include <ostream>
#include <sstream>

namespace hone::cli {
namespace {

const char* severityName(Severity severity) {
    return severity == Severity::kError ? "error" : "warning";
}

nlohmann::ordered_json toJson(const DiagnosticCode& code) {
    return {{"code", code.code},   {"severity", severityName(code.severity)},
            {"title", code.title}, {"meaning", code.meaning},
            {"wrong", code.wrong}, {"right", code.right}};
}

void printWrapped(std::ostream& out, std::string_view text) {
    constexpr std::size_t kWidth = 80;
    std::istringstream words{std::string(text)};
    std::size_t column = 0;
    for (std::string word; words >> word; column += word.size()) {
        const bool fits = column + 1 + word.size() <= kWidth;
        out << (column == 0 ? "  " : fits ? " " : "\n  ") << word;
        column = column != 0 && fits ? column + 1 : 2;
    }
    out << "\n";
}

void printSnippet(std::ostream& out, const char* title, std::string_view snippet) {
    if (snippet.empty())
        return;
    out << "\n  " << title << "\n";
    std::istringstream lines{std::string(snippet)};
    for (std::string line; std::getline(lines, line);)
        out << "      " << line << "\n";
}

void print(std::ostream& out, const DiagnosticCode& code) {
    out << severityName(code.severity) << " " << code.code << ": " << code.title << "\n\n";
    printWrapped(out, code.meaning);
    printSnippet(out, "wrong", code.wrong);
    printSnippet(out, "right", code.right);
}

int listCodes(bool json, const Console& console) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const DiagnosticCode& code : diagnosticCodes()) {
        all.push_back(toJson(code));
        if (!json)
            console.out << code.code << "  " << code.title << "\n";
    }
    if (json)
        cli::print(console.out, {{"codes", all}});
    return kOk;
}

/// "e301" is meant to be "E0301".
std::string spelledOut(std::string code) {
    if (code.size() == 4)
        code.insert(1, "0");
    return code;
}

} // namespace

bool looksLikeCode(std::string_view text) {
    return text.size() >= 4 && text.size() <= 6 &&
           std::string_view("EeWw").find(text[0]) != std::string_view::npos &&
           std::all_of(text.begin() + 1, text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

int explainCode(const std::string& code, bool json, const Console& console) {
    if (code.empty())
        return listCodes(json, console);
    if (const DiagnosticCode* found = findDiagnosticCode(spelledOut(code))) {
        if (json)
            cli::print(console.out, toJson(*found));
        else
            print(console.out, *found);
        return kOk;
    }
    std::vector<std::string> codes;
    for (const DiagnosticCode& known : diagnosticCodes())
        codes.emplace_back(known.code);
    console.err << "there is no code \"" << code << "\"";
    if (const DiagnosticCode* near = findDiagnosticCode(nearest(spelledOut(code), codes)))
        console.err << "; did you mean " << near->code << " (" << near->title << ")?";
    console.err << "\nhone explain lists all codes\n";
    return kUsage;
}

} // namespace hone::cli

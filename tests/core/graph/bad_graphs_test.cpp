// SPDX-License-Identifier: Apache-2.0
//
// tests/bad_graphs/NAME.json with the whole report in NAME.expected. A first line
// "// set: name=value" is an override.
#include "hone/core/graph/compiled_graph.h"
#include "hone/core/graph/diagnostic_codes.h"
#include "hone/tests/support/test_passes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

namespace hone {
namespace {

namespace fs = std::filesystem;

fs::path folder() {
    return fs::path(HONE_SOURCE_DIR) / "tests" / "bad_graphs";
}

std::string read(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

std::vector<std::string> badGraphs() {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder()))
        if (entry.path().extension() == ".json")
            names.push_back(entry.path().stem());
    std::ranges::sort(names);
    return names;
}

std::vector<Diagnostic> check(const std::string& name) {
    const TestCatalog catalog;
    const std::string text = read(folder() / (name + ".json"));
    Overrides overrides;
    const std::string mark = "// set: ";
    if (text.starts_with(mark)) {
        const std::size_t equals = text.find('=');
        overrides.emplace_back(text.substr(mark.size(), equals - mark.size()),
                               text.substr(equals + 1, text.find('\n') - equals - 1));
    }
    std::vector<Diagnostic> diagnostics;
    const GraphDesc desc = parseGraph(name + ".json", text, diagnostics,
                                      filesBeside((folder() / (name + ".json")).string()));
    (void)compile(desc, catalog.catalog(), overrides, diagnostics);
    return diagnostics;
}

class BadGraph : public testing::TestWithParam<std::string> {};

TEST_P(BadGraph, IsReportedAsExpected) {
    // For whoever changes a message: writes what is to be reviewed.
    if (std::getenv("HONE_WRITE_EXPECTED") != nullptr)
        std::ofstream(folder() / (GetParam() + ".expected")) << format(check(GetParam()));
    EXPECT_EQ(format(check(GetParam())), read(folder() / (GetParam() + ".expected")));
}

INSTANTIATE_TEST_SUITE_P(All, BadGraph, testing::ValuesIn(badGraphs()),
                         [](const auto& test) { return test.param; });

/// What is written as "E0301" in core/graph, the table of codes itself apart.
std::set<std::string> codesInTheSources() {
    std::set<std::string> codes;
    for (const fs::directory_entry& entry :
         fs::directory_iterator(fs::path(HONE_SOURCE_DIR) / "core" / "graph")) {
        if (entry.path().stem() == "diagnostic_codes")
            continue;
        const std::string text = read(entry.path());
        for (std::size_t at = 0; (at = text.find('"', at)) != std::string::npos; ++at) {
            const std::string code = text.substr(at + 1, 5);
            if (text.size() > at + 6 && text[at + 6] == '"' && (code[0] == 'E' || code[0] == 'W') &&
                std::all_of(code.begin() + 1, code.end(),
                            [](char c) { return c >= '0' && c <= '9'; }))
                codes.insert(code);
        }
    }
    return codes;
}

TEST(BadGraphs, CoverEveryCodeThatIsInTheSources) {
    std::set<std::string> covered;
    for (const std::string& name : badGraphs())
        for (const Diagnostic& diagnostic : check(name))
            covered.insert(diagnostic.code);
    // Limits whose graphs would be megabytes, and a missing file: graph_desc_test has those. A
    // program without shader compiler, a parameter set later: shader_test, switch_test.
    covered.insert({"E0104", "E0106", "E0313", "E0511"});
    for (const std::string& code : codesInTheSources())
        EXPECT_TRUE(covered.contains(code)) << code;
}

TEST(DiagnosticCodes, AreThoseThatTheSourcesReport) {
    std::set<std::string> explained;
    for (const DiagnosticCode& code : diagnosticCodes())
        explained.emplace(code.code);
    EXPECT_EQ(explained, codesInTheSources());
}

TEST(DiagnosticCodes, AreInOrderAndSayWhatTheyMean) {
    EXPECT_TRUE(std::ranges::is_sorted(diagnosticCodes(), {}, &DiagnosticCode::code));
    for (const DiagnosticCode& code : diagnosticCodes()) {
        EXPECT_EQ(code.code[0], code.severity == Severity::kError ? 'E' : 'W');
        EXPECT_FALSE(code.title.empty()) << code.code;
        EXPECT_TRUE(code.meaning.ends_with('.')) << code.code;
    }
}

TEST(DiagnosticCodes, HaveTheSeverityThatIsReported) {
    for (const std::string& name : badGraphs())
        for (const Diagnostic& diagnostic : check(name)) {
            const DiagnosticCode* code = findDiagnosticCode(diagnostic.code);
            ASSERT_NE(code, nullptr) << diagnostic.code;
            EXPECT_EQ(code->severity, diagnostic.severity) << diagnostic.code;
        }
}

} // namespace
} // namespace hone

// SPDX-License-Identifier: Apache-2.0
//
// tests/bad_graphs/NAME.json with the whole report in NAME.expected. A first line
// "// set: name=value" is an override.
#include "hone/core/graph/compiled_graph.h"
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

TEST(BadGraphs, CoverEveryCodeThatIsInTheSources) {
    std::set<std::string> covered;
    for (const std::string& name : badGraphs())
        for (const Diagnostic& diagnostic : check(name))
            covered.insert(diagnostic.code);
    // Limits whose graphs would be megabytes, and a missing file: graph_desc_test has those. A
    // program without shader compiler, a parameter set later: shader_test, switch_test.
    covered.insert({"E0104", "E0106", "E0313", "E0511"});
    for (const fs::directory_entry& entry :
         fs::directory_iterator(fs::path(HONE_SOURCE_DIR) / "core" / "graph")) {
        const std::string text = read(entry.path());
        for (std::size_t at = 0; (at = text.find('"', at)) != std::string::npos; ++at) {
            const std::string code = text.substr(at + 1, 5);
            const bool is_code = text.size() > at + 6 && text[at + 6] == '"' &&
                                 (code[0] == 'E' || code[0] == 'W') &&
                                 std::all_of(code.begin() + 1, code.end(),
                                             [](char c) { return c >= '0' && c <= '9'; });
            if (is_code && !covered.contains(code))
                ADD_FAILURE() << code << " in " << entry.path().filename();
        }
    }
}

} // namespace
} // namespace hone

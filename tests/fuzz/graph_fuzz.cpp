// SPDX-License-Identifier: Apache-2.0
//
// Hostile graph files: whatever the bytes are, reading, compiling and reporting end, and what they
// say is true of the text. Run with libFuzzer (tests/fuzz/CMakeLists.txt).
#include "hone/core/graph/compiled_graph.h"
#include "hone/tests/fuzz/require.h"
#include "hone/tests/support/test_passes.h"

#include <algorithm>
#include <cstdint>
#include <optional>

namespace hone {
namespace {

constexpr const char* kFile = "graph.json";

/// What a fuzzed graph may use as a pass: { "graph": "part.json" }.
std::optional<std::string> readPart(const std::string& name) {
    if (name != "part.json")
        return std::nullopt;
    return R"({ "hone": 2, "params": { "amount": { "type": "float", "default": 1 } },
                "inputs": { "color": "Radiance" },
                "passes": { "add": { "type": "add", "in": { "color": "$color" },
                                     "params": { "amount": "$amount" } } },
                "outputs": { "color": "add.result" } })";
}

std::string textOfLine(const std::string& text, std::size_t line) {
    std::size_t begin = 0;
    for (std::size_t i = 1; i < line; ++i) {
        begin = text.find('\n', begin);
        require(begin != std::string::npos, "the line is one of the file's");
        ++begin;
    }
    return text.substr(begin, text.find('\n', begin) - begin);
}

void requirePlace(const std::string& text, const Diagnostic& diagnostic) {
    require(diagnostic.code.size() == 5 && !diagnostic.message.empty(), "a code and a message");
    if (diagnostic.line == 0 || diagnostic.file != kFile)
        return;
    const std::string line = textOfLine(text, diagnostic.line);
    require(diagnostic.column >= 1 && diagnostic.column <= line.size() + 1,
            "the column is one of the line's");
    require(diagnostic.source_column >= 1 &&
                diagnostic.source_column <= diagnostic.source.size() + 1,
            "the caret stands below the excerpt");
    for (const Note& note : diagnostic.notes)
        if (note.line != 0 && note.file == kFile)
            require(note.column <= textOfLine(text, note.line).size() + 1, "a note's place");
}

void requireReport(const std::string& report) {
    require(std::ranges::none_of(report,
                                 [](char c) {
                                     return (static_cast<unsigned char>(c) < 0x20 && c != '\n') ||
                                            c == 0x7f;
                                 }),
            "no control byte reaches the terminal");
}

void checkGraph(const std::string& text) {
    static const TestCatalog catalog;
    std::vector<Diagnostic> diagnostics;
    const GraphDesc desc = parseGraph(kFile, text, diagnostics, readPart);
    const CompiledGraph graph = compile(desc, catalog.catalog(), {}, diagnostics);
    for (const Diagnostic& diagnostic : diagnostics)
        requirePlace(text, diagnostic);
    requireReport(format(diagnostics));
    const bool failed = std::ranges::any_of(
        diagnostics, [](const Diagnostic& d) { return d.severity == Severity::kError; });
    require(failed || !graph.outputs.empty(), "a graph without errors has outputs");
    if (!failed)
        require(!dump(graph).empty(), "a graph without errors has a plan");
}

} // namespace
} // namespace hone

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    hone::checkGraph(std::string(reinterpret_cast<const char*>(data), size));
    return 0;
}

// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/backends.h"
#include "hone/core/graph/compiled_graph.h"
#include "hone/passes/passes.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <tuple>

namespace hone {
namespace {

TEST(ShippedGraphs, AreWithoutAnyProblem) {
    PassRegistry passes;
    registerPasses(passes);
    TraceBackendRegistry tracers;
    registerTraceBackends(tracers);
    std::size_t graphs = 0;
    for (const auto& file :
         std::filesystem::recursive_directory_iterator(HONE_SOURCE_DIR "/graphs")) {
        if (file.path().extension() != ".json" || file.path().string().ends_with(".schema.json"))
            continue;
        ++graphs;
        std::vector<Diagnostic> diagnostics;
        const CompiledGraph graph = compile(parseGraphFile(file.path().string(), diagnostics),
                                            {&passes, &tracers}, {}, diagnostics);
        EXPECT_TRUE(diagnostics.empty()) << format(diagnostics);
        EXPECT_EQ(graph.name, file.path().stem().string());
        EXPECT_NE(graph.doc, "") << file.path();
    }
    EXPECT_GE(graphs, 4u);
}

TEST(ShippedGraphs, ReadmesFirstGraphIsWithoutAnyProblem) {
    std::ifstream file(HONE_SOURCE_DIR "/README.md");
    const std::string readme((std::istreambuf_iterator<char>(file)), {});
    const std::size_t begin = readme.find("```json\n") + 8;
    ASSERT_GT(begin, 8u);
    PassRegistry passes;
    registerPasses(passes);
    TraceBackendRegistry tracers;
    std::vector<Diagnostic> diagnostics;
    const std::string text = readme.substr(begin, readme.find("```", begin) - begin);
    std::ignore =
        compile(parseGraph("mine.json", text, diagnostics), {&passes, &tracers}, {}, diagnostics);
    EXPECT_TRUE(diagnostics.empty()) << format(diagnostics);
}

} // namespace
} // namespace hone

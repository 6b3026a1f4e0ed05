// SPDX-License-Identifier: Apache-2.0
//
// graphs/README.md teaches by whole files. Each is what stands between ```json (or ```glsl) and
// ```, under a line that names it; they are saved beside each other, as a reader would.
#include "hone/backends/backends.h"
#include "hone/core/graph/compiled_graph.h"
#include "hone/passes/glsl/glsl.h"
#include "hone/passes/passes.h"
#include "hone/tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

namespace hone {
namespace {

struct Example {
    std::string name; ///< "first.json"
    std::string text;
};

std::vector<Example> examples(const std::string& language) {
    std::ifstream file(HONE_SOURCE_DIR "/graphs/README.md");
    const std::string readme((std::istreambuf_iterator<char>(file)), {});
    std::vector<Example> found;
    const std::string fence = "```" + language + "\n";
    for (std::size_t at = readme.find(fence); at != std::string::npos;
         at = readme.find(fence, at + 1)) {
        const std::size_t name_end = readme.rfind('`', at - 1);
        const std::size_t name_begin = readme.rfind('`', name_end - 1) + 1;
        const std::size_t begin = at + fence.size();
        found.push_back({readme.substr(name_begin, name_end - name_begin),
                         readme.substr(begin, readme.find("```", begin) - begin)});
    }
    return found;
}

TEST(GraphsReadme, HasOnlyExamplesWithoutAnyProblem) {
    PassRegistry passes;
    registerPasses(passes);
    TraceBackendRegistry tracers;
    registerTraceBackends(tracers);
    const ShaderCompiler shaders = glslCompiler(passes);
    const test::TemporaryFolder folder;
    for (const Example& shader : examples("glsl"))
        static_cast<void>(folder.write(shader.name, shader.text));
    const std::vector<Example> all = examples("json");
    EXPECT_GE(all.size(), 5u);
    for (const Example& example : all) {
        ASSERT_TRUE(example.name.ends_with(".json")) << example.name;
        static_cast<void>(folder.write(example.name, example.text));
    }
    for (const Example& example : all) {
        std::vector<Diagnostic> diagnostics;
        const GraphDesc desc =
            parseGraphFile(folder.path(example.name), diagnostics, HONE_SOURCE_DIR "/graphs");
        const CompiledGraph graph = compile(desc, {&passes, &tracers, &shaders}, {}, diagnostics);
        EXPECT_TRUE(diagnostics.empty()) << format(diagnostics);
        for (const PlannedNode& node : graph.nodes)
            EXPECT_EQ(node.culled, "") << example.name << ": " << node.name;
    }
}

} // namespace
} // namespace hone

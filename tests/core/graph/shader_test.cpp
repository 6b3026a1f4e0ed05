// SPDX-License-Identifier: Apache-2.0
//
// Passes of type "glsl", as the compiler of graphs sees them.
#include "hone/tests/support/graph_fixture.h"

namespace hone {
namespace {

class ShaderTest : public GraphTest {
protected:
    CompiledGraph compileWith(const Catalog& known, std::vector<Diagnostic>& diagnostics) {
        const GraphDesc desc = parseGraph(
            "test.json", R"({ "hone": 2,
            "inputs": { "scene": "scene", "camera": "camera" },
            "passes": {
              "raster": { "type": "raster", "in": { "scene": "$scene", "camera": "$camera" } },
              "own": { "type": "glsl", "shader": "own.comp", "in": { "color": "raster.color" },
                       "params": { "amount": 5 } },
              "same": { "type": "glsl", "shader": "own.comp", "in": { "color": "own.result" } }
            },
            "outputs": { "color": "same.result" } })",
            diagnostics, [](const std::string&) { return std::optional<std::string>("good"); });
        return compile(desc, known, {}, diagnostics);
    }
};

TEST_F(ShaderTest, IsAPassWithPortsAndParameters) {
    std::vector<Diagnostic> diagnostics;
    auto executor = start(compileWith(catalog.catalog(), diagnostics));
    ASSERT_TRUE(diagnostics.empty()) << format(diagnostics);
    executor->run();
    EXPECT_EQ(executor->output("color").as<vec3>()[0].x, 10 + 5 + 1);
}

TEST_F(ShaderTest, IsCompiledOnceForAllThatUseTheFile) {
    std::vector<Diagnostic> diagnostics;
    const CompiledGraph graph = compileWith(catalog.catalog(), diagnostics);
    EXPECT_EQ(graph.shader_types.size(), 1u);
    EXPECT_EQ(graph.findNode("own")->type, graph.findNode("same")->type);
}

TEST_F(ShaderTest, NeedsAProgramThatHasAShaderCompiler) {
    Catalog known = catalog.catalog();
    known.shaders = nullptr;
    std::vector<Diagnostic> diagnostics;
    (void)compileWith(known, diagnostics);
    ASSERT_EQ(diagnostics.size(), 2u);
    EXPECT_EQ(diagnostics[0].code, "E0313");
}

} // namespace
} // namespace hone

// SPDX-License-Identifier: Apache-2.0
//
// Shader files as passes, as a person meets them.
#include "hone/tests/cli/command_run.h"

#include <gtest/gtest.h>

namespace hone::cli {
namespace {

constexpr const char* kExample = HONE_SOURCE_DIR "/examples/glsl_metric/edges.json";

const std::vector<std::string> kSmall{"--scene", "builtin:cornell", "--size", "33x21",
                                      "--set",   "samples=3",       "-o"};

std::vector<std::string> renderOf(const std::string& graph, const std::string& folder) {
    std::vector<std::string> arguments{"render", graph};
    arguments.insert(arguments.end(), kSmall.begin(), kSmall.end());
    arguments.push_back(folder);
    return arguments;
}

TEST(Glsl, CheckFindsNothingWrongWithTheExample) {
    const CommandRun run = runHone({"check", kExample});
    EXPECT_EQ(run.code, 0) << run.err;
}

TEST(Glsl, CheckShowsAShadersLine) {
    const TemporaryFolder folder;
    (void)folder.write("bad.comp", "#pragma hone in Radiance color\n"
                                   "#pragma hone out Error error\n"
                                   "void main() {\n"
                                   "    error = vec2(colour[index].x);\n"
                                   "}\n");
    const std::string graph = folder.write(
        "bad.json", R"({ "hone": 2, "inputs": { "scene": "scene", "camera": "camera" }, "passes": {
            "raster": { "type": "raster", "in": { "scene": "$scene", "camera": "$camera" } },
            "bad": { "type": "glsl", "shader": "bad.comp", "in": { "color": "raster.color" } } },
            "outputs": { "error": "bad.error" } })");
    const CommandRun run = runHone({"check", graph});
    EXPECT_EQ(run.code, 3);
    EXPECT_NE(run.err.find("bad.comp:4:18: "), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("did you mean \"color\"?"), std::string::npos) << run.err;
}

TEST(Glsl, TheExamplesImageIsThePurelyRayTracedOne) {
    if (const std::string why = whyNoRaster(); !why.empty())
        GTEST_SKIP() << why;
    const TemporaryFolder folder;
    const CommandRun refined = runHone(renderOf(kExample, folder.path("refined")));
    ASSERT_EQ(refined.code, 0) << refined.err;
    ASSERT_EQ(runHone(renderOf("prt", folder.path("traced"))).code, 0);
    const CommandRun compared = runHone(
        {"compare", folder.path("refined/color.png"), folder.path("traced/color.png"), "--json"});
    EXPECT_EQ(compared.json()["differing_bits"], 0);
}

TEST(Glsl, WithoutADeviceAShaderPassIsRefused) {
    const TemporaryFolder folder;
    std::vector<std::string> arguments = renderOf(kExample, folder.path("out"));
    arguments.insert(arguments.end(), {"--device", "none", "--set", "visibility=rays"});
    const CommandRun run = runHone(arguments);
    EXPECT_EQ(run.code, 5) << run.err;
}

} // namespace
} // namespace hone::cli

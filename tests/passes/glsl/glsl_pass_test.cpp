// SPDX-License-Identifier: Apache-2.0
//
// What shader passes compute, on the Vulkan device with validation.
#include "hone/passes/glsl/glsl.h"
#include "hone/passes/passes.h"
#include "hone/tests/support/run_pass.h"
#include "hone/tests/support/vulkan_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

namespace hone {
namespace {

class GlslPassTest : public VulkanTest {
protected:
    static PassType compileText(const std::string& text) {
        static const PassRegistry registry;
        ShaderPass pass = glslCompiler(registry)("test.comp", text);
        for (const ShaderProblem& problem : pass.problems)
            ADD_FAILURE() << problem.line << ": " << problem.message;
        return pass.type.value();
    }
};

TEST_F(GlslPassTest, ComputesAPixelOfOneByOne) {
    PassRun run(compileText("#pragma hone in Radiance color\n#pragma hone out Error error\n"
                            "void main() { error = vec2(luminance(color[index]), 2); }\n"),
                device());
    run.extent({1, 1}).plane<vec3>("color", {{0, 1, 0}}).execute();
    EXPECT_EQ(run.output<vec2>("error"), (std::vector<vec2>{{0.7152f, 2.0f}}));
}

TEST_F(GlslPassTest, VectorsOfThreeLieTight) {
    PassRun run(compileText("#pragma hone in Radiance color\n#pragma hone out Radiance reversed\n"
                            "void main() { reversed = color[count - 1u - index].zyx; }\n"),
                device());
    run.extent({3, 1}).plane<vec3>("color", {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}).execute();
    EXPECT_EQ(run.output<vec3>("reversed"), (std::vector<vec3>{{9, 8, 7}, {6, 5, 4}, {3, 2, 1}}));
}

TEST_F(GlslPassTest, PixelsCountRowByRowOnOddExtents) {
    PassRun run(compileText("#pragma hone out Error place\n#pragma hone out Depth number\n"
                            "void main() { place = vec2(pixel) * 100.0 + vec2(extent);\n"
                            "number = float(index * count); }\n"),
                device());
    run.extent({67, 3}).execute(); // more than one workgroup, the last not full
    const std::vector<vec2> place = run.output<vec2>("place");
    const std::vector<float> number = run.output<float>("number");
    ASSERT_EQ(place.size(), 201u);
    for (std::size_t i = 0; i < place.size(); ++i) {
        EXPECT_EQ(place[i], vec2(float(i % 67) * 100 + 67, float(i / 67) * 100 + 3)) << i;
        EXPECT_EQ(number[i], float(i) * 201) << i;
    }
}

TEST_F(GlslPassTest, NeighboursStayInThePicture) {
    PassRun run(compileText("#pragma hone in Depth depth\n#pragma hone out Error around\n"
                            "void main() { around = vec2(depth[neighbour(-1, -1)], "
                            "depth[neighbour(1, 2)]); }\n"),
                device());
    run.extent({2, 2}).plane<float>("depth", {1, 2, 3, 4}).execute();
    EXPECT_EQ(run.output<vec2>("around"), (std::vector<vec2>{{1, 4}, {1, 4}, {1, 4}, {1, 4}}));
}

constexpr const char* kWithParameters =
    "#pragma hone out Error error\n"
    "#pragma hone param float gain = 0.5\n"
    "#pragma hone param uint steps = 3\n"
    "#pragma hone param bool is_negative = false\n"
    "#pragma hone param enum mode = sum | product\n"
    "void main() {\n"
    "    float value = mode == mode_sum ? gain + float(steps) : gain * float(steps);\n"
    "    error = vec2(is_negative ? -value : value, float(mode));\n"
    "}\n";

TEST_F(GlslPassTest, ParametersHaveTheirDefaults) {
    PassRun run(compileText(kWithParameters), device());
    run.extent({1, 1}).execute();
    EXPECT_EQ(run.output<vec2>("error"), (std::vector<vec2>{{3.5f, 0}})); // 0.5 + 3
}

TEST_F(GlslPassTest, ParametersReachTheShader) {
    PassRun run(compileText(kWithParameters), device());
    run.extent({1, 1}).param("gain", 4.0f).param("steps", 7u).param("is_negative", true);
    run.param("mode", std::string("product")).execute();
    EXPECT_EQ(run.output<vec2>("error"), (std::vector<vec2>{{-28, 1}}));
}

TEST_F(GlslPassTest, AnOptionalInputThatIsNotConnectedIsZero) {
    const PassType type =
        compileText("#pragma hone in optional Error guess\n#pragma hone out Error error\n"
                    "void main() { error = guess[index + 5u] + (has_guess ? 1.0 : 0.25); }\n");
    PassRun without(type, device());
    without.extent({2, 1}).execute();
    EXPECT_EQ(without.output<vec2>("error"), (std::vector<vec2>{{0.25f, 0.25f}, {0.25f, 0.25f}}));
    PassRun with(type, device());
    with.extent({1, 1}).plane<vec2>("guess", {{3, 4}}).execute();
    EXPECT_EQ(with.output<vec2>("error"), (std::vector<vec2>{{4, 5}}));
}

TEST_F(GlslPassTest, ListsHaveTheirCount) {
    const PassType type =
        compileText("#pragma hone in PixelList order\n#pragma hone out Depth rank\n"
                    "void main() {\n"
                    "    rank = -1.0;\n"
                    "    for (uint i = 0u; i < order_count; ++i)\n"
                    "        if (order[i] == index) rank = float(i);\n"
                    "}\n");
    PassRun run(type, device());
    run.extent({3, 1}).list<uint>("order", {2, 0}, 8).execute();
    EXPECT_EQ(run.output<float>("rank"), (std::vector<float>{1, -1, 0}));
    PassRun empty(type, device());
    empty.extent({1, 1}).list<uint>("order", {}).execute();
    EXPECT_EQ(empty.output<float>("rank"), (std::vector<float>{-1}));
}

TEST_F(GlslPassTest, AnOutputThatIsNotAssignedIsZeroForEveryPixel) {
    PassRun run(compileText("#pragma hone out Depth depth\n"
                            "void main() { if (index == 1u) depth = 5.0; }\n"),
                device());
    run.extent({3, 1}).execute();
    EXPECT_EQ(run.output<float>("depth"), (std::vector<float>{0, 5, 0}));
}

TEST_F(GlslPassTest, ReturningEarlyKeepsWhatWasAssigned) {
    PassRun run(compileText("#pragma hone out Depth depth\n"
                            "void main() { depth = 5.0; if (index == 0u) return; depth = 6.0; }\n"),
                device());
    run.extent({2, 1}).execute();
    EXPECT_EQ(run.output<float>("depth"), (std::vector<float>{5, 6}));
}

TEST_F(GlslPassTest, AnIndexOutsideMeansTheNearestElement) {
    PassRun run(compileText("#pragma hone in Depth depth\n#pragma hone out Error error\n"
                            "void main() { error = vec2(depth[index - 5u], "
                            "depth[index + 1000000000u]); }\n"),
                device());
    run.extent({2, 1}).plane<float>("depth", {7, 9}).execute();
    EXPECT_EQ(run.output<vec2>("error"), (std::vector<vec2>{{7, 9}, {7, 9}}));
}

TEST_F(GlslPassTest, AnIndexBeyondTheEndOfALocalArrayDoesNoHarm) {
    PassRun run(compileText("#pragma hone in Depth depth\n#pragma hone out Depth last\n"
                            "void main() {\n"
                            "    float local[4] = float[4](1, 2, 3, 4);\n"
                            "    local[uint(depth[index])] = 8.0;\n"
                            "    last = local[3] + local[int(-depth[index])];\n"
                            "}\n"),
                device());
    run.extent({2, 1}).plane<float>("depth", {1e9f, 3e5f}).execute();
    EXPECT_EQ(run.output<float>("last")[0] >= 8.0f, true); // the write went to the last element
}

TEST_F(GlslPassTest, LoopsMayBeLong) {
    PassRun run(compileText("#pragma hone param uint rounds = 60000\n#pragma hone out Depth depth\n"
                            "void main() { uint n = 0u;\n"
                            "for (uint i = 0u; i < rounds; ++i) n += (n ^ i) & 1u;\n"
                            "depth = float(n); }\n"),
                device());
    run.extent({1, 1}).execute();
    EXPECT_EQ(run.output<float>("depth")[0], 59999.0f); // one a round but the first
}

TEST_F(GlslPassTest, TheExampleFindsEdges) {
    std::ifstream file(HONE_SOURCE_DIR "/examples/glsl_metric/edges.comp");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    ASSERT_FALSE(text.empty());
    EXPECT_LT(std::count(text.begin(), text.end(), '\n'), 20);
    PassRun run(compileText(text), device());
    // Luminances 0.25 0.25 0.25 1: the last two see the step of 0.75.
    run.extent({4, 1}).param("share", 0.5f);
    run.plane<vec3>("color", {vec3(0.25f), vec3(0.25f), vec3(0.25f), vec3(1.0f)}).execute();
    const std::vector<vec2> error = run.output<vec2>("error");
    EXPECT_EQ(error[0], vec2(0));
    EXPECT_EQ(error[1], vec2(0));
    EXPECT_NEAR(error[2].x, 0.375f, 1e-6f);
    EXPECT_NEAR(error[2].y, 0.75f, 1e-6f);
    EXPECT_EQ(error[3], error[2]);
}

TEST_F(GlslPassTest, TwoShadersOfTheSameNameAreTwo) {
    const auto constant = [](const char* value) {
        return compileText(
            "#pragma hone out Depth depth\nvoid main() { depth = " + std::string(value) + "; }\n");
    };
    // One after the other, so that the second may lie where the first lay.
    for (const float value : {1.0f, 2.0f, 3.0f}) {
        PassRun run(constant(std::to_string(value).c_str()), device());
        run.extent({1, 1}).execute();
        EXPECT_EQ(run.output<float>("depth"), std::vector<float>{value});
    }
}

} // namespace
} // namespace hone

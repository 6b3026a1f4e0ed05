// SPDX-License-Identifier: Apache-2.0
//
// What the compiler of shader passes says of shaders, without a device.
#include "hone/passes/glsl/glsl.h"
#include "hone/passes/passes.h"

#include <gtest/gtest.h>

namespace hone {
namespace {

const PassRegistry& registry() {
    static const PassRegistry instance = [] {
        PassRegistry passes;
        registerPasses(passes);
        return passes;
    }();
    return instance;
}

ShaderPass compileText(const std::string& text) {
    return glslCompiler(registry())("test.comp", text);
}

/// The only problem of a shader whose first lines declare color and error; `body` begins in line 3.
ShaderProblem problemOf(const std::string& body) {
    const ShaderPass pass = compileText("#pragma hone in Radiance color\n"
                                        "#pragma hone out Error error\n" +
                                        body);
    EXPECT_FALSE(pass.type.has_value());
    EXPECT_EQ(pass.problems.size(), 1u);
    for (std::size_t i = 1; i < pass.problems.size(); ++i)
        ADD_FAILURE() << pass.problems[i].line << ": " << pass.problems[i].message;
    return pass.problems.empty() ? ShaderProblem{} : pass.problems.front();
}

constexpr const char* kGood = "void main() { error = vec2(luminance(color[index])); }\n";

TEST(GlslCompile, ADeclarationBecomesAPassType) {
    const ShaderPass pass = compileText(
        "#pragma hone doc \"Twice as bright.\"\n"
        "#pragma hone in Radiance color \"what\"\n"
        "#pragma hone in optional Error guess\n"
        "#pragma hone out Radiance twice\n"
        "#pragma hone param float gain = 2 min 0 max 4 \"how much\"\n"
        "void main() { twice = color[index] * gain + (has_guess ? guess[index].x : 0.0); }\n");
    ASSERT_TRUE(pass.type.has_value()) << pass.problems.front().message;
    const PassType& type = *pass.type;
    EXPECT_EQ(type.name, "test.comp");
    EXPECT_EQ(type.doc, "Twice as bright.");
    EXPECT_EQ(type.domain, Domain::kDevice);
    ASSERT_EQ(type.inputs.size(), 2u);
    EXPECT_EQ(type.inputs[0].name, "color");
    EXPECT_FALSE(type.inputs[0].optional);
    EXPECT_TRUE(type.inputs[1].optional);
    ASSERT_EQ(type.outputs.size(), 1u);
    EXPECT_EQ(type.outputs[0].type, types::kRadiance);
    ASSERT_EQ(type.params.size(), 1u);
    EXPECT_EQ(type.params[0].max, 4.0);
}

struct BadShader {
    const char* name;
    const char* body; ///< begins in line 3
    std::size_t line;
    std::size_t column;
    std::size_t length;
    const char* message; ///< a part of it
    const char* hint;    ///< a part of it
};

class BadShaderTest : public testing::TestWithParam<BadShader> {};

TEST_P(BadShaderTest, IsToldAtItsLine) {
    const BadShader& bad = GetParam();
    const ShaderProblem problem = problemOf(bad.body);
    EXPECT_EQ(problem.line, bad.line);
    EXPECT_EQ(problem.column, bad.column);
    EXPECT_EQ(problem.length, bad.length);
    EXPECT_NE(problem.message.find(bad.message), std::string::npos) << problem.message;
    EXPECT_NE(problem.hint.find(bad.hint), std::string::npos) << problem.hint;
}

const BadShader kBadShaders[] = {
    {"Undeclared", "void main() {\n\n    error = vec2(colour[index].x);\n}\n", 5, 18, 6,
     "\"colour\": undeclared identifier", "did you mean \"color\"?"},
    {"UnknownFunction", "void main() {\n    error = vec2(luminence(color[index]));\n}\n", 4, 18, 9,
     "no matching overloaded function", "did you mean \"luminance\"?"},
    {"WrongType", "void main() {\n    error = color[index];\n}\n", 4, 0, 1,
     "cannot convert from 'vec3' to 'vec2'", ""},
    {"InputWritten", "void main() {\n    error = vec2(1);\n    color[index] = vec3(0);\n}\n", 5, 0,
     1, "l-value required", "cannot be written"},
    {"SyntaxError", "void main() {\n    error = = vec2(color[index].x);\n}\n", 4, 0, 1,
     "syntax error", ""},
    {"MissingBrace", "void main() {\n    error = vec2(color[index].x);\n", 4, 0, 1, "syntax error",
     "is a } or a ; missing?"},
    {"MissingMain", "void run() { error = vec2(color[index].x); }\n", 0, 0, 1, "main",
     "void main()"},
    {"MissingEndif", "#if 1\nvoid main() { error = vec2(color[index].x); }\n", 4, 0, 1,
     "missing #endif", ""},
    {"Recursion",
     "float f(int n) { return f(n - 1) * color[index].x; }\nvoid main() { error = vec2(f(9)); }\n",
     0, 0, 1, "ecursion", ""},
    {"Version", "#version 450\nvoid main() { error = vec2(color[index].x); }\n", 3, 1, 12,
     "no #version", "4.60"},
    {"Extension",
     "  #extension GL_EXT_debug_printf : enable\nvoid main() { error = vec2(color[index].x); }\n",
     3, 3, 39, "no #extension", "every device"},
    {"Include", "#include \"/etc/passwd\"\nvoid main() { error = vec2(color[index].x); }\n", 3, 1,
     22, "no #include", "one file"},
    {"Line", "#line 7\nvoid main() { error = vec2(color[index].x); }\n", 3, 1, 7, "no #line", ""},
    {"Pragma", "#pragma hnoe in Error e\nvoid main() { error = vec2(color[index].x); }\n", 3, 1, 23,
     "no #pragma", "#pragma hone"},
    {"NameOfHone", "void main() { error = vec2(color[index].x + hone_row); }\n", 3, 45, 8,
     "hone's own", "another"},
    {"OwnBuffer",
     "buffer more_buffer { float more[]; };\n"
     "void main() { error = vec2(color[index].x + more[0]); }\n",
     3, 0, 1, "layout(binding=X)", ""},
    {"OwnBoundBuffer",
     "layout(binding = 7) buffer more_buffer { float more[]; };\n"
     "void main() { error = vec2(color[index].x + more[0]); }\n",
     3, 28, 11, "\"more_buffer\" is no port", "#pragma hone in"},
    {"Image",
     "layout(binding = 7, rgba32f) uniform image2D picture;\n"
     "void main() { error = imageLoad(picture, ivec2(0)).xy + color[index].x; }\n",
     3, 46, 7, "image", "declared"},
    {"SharedVariable",
     "shared float sum;\nvoid main() { sum = color[index].x; error = vec2(sum); }\n", 3, 1, 6,
     "shared variable", ""},
    {"Barrier", "void main() { barrier(); error = vec2(color[index].x); }\n", 3, 15, 7, "barrier",
     ""},
    {"Double", "void main() { double d = color[index].x; error = vec2(d); }\n", 3, 15, 6, "double",
     ""},
    {"SpecConstant",
     "layout(constant_id = 0) const uint n = 3;\n"
     "void main() { error = vec2(color[n].x); }\n",
     3, 8, 11, "a constant that", ""},
    {"HugeArray",
     "void main() { float big[1000000]; big[index] = color[index].x; error = vec2(big[3]); }\n", 0,
     0, 1, "16 KiB", ""},
    {"HugeArrays",
     "void main() { float big[60000][60000][60000]; big[index][0][0] = color[index].x;\n"
     "error = vec2(big[3][0][0]); }\n",
     0, 0, 1, "16 KiB", ""},
    {"InputUnread", "void main() { error = vec2(1); }\n", 1, 26, 5, "\"color\" is never read",
     "remove"},
    {"OutputUnwritten", "float x;\nvoid main() { x = color[index].x; }\n", 2, 24, 5,
     "\"error\" is never written", "error = ..."},
    {"ParameterUnread",
     "#pragma hone param float gain = 1\nvoid main() { error = vec2(color[index].x); }\n", 3, 26, 4,
     "\"gain\" is never read", "remove"},
    {"ReservedName",
     "#pragma hone in Error sample\nvoid main() { error = sample[index] + color[index].x; }\n", 3,
     23, 6, "no place for the name \"sample\"", "another"},
};

INSTANTIATE_TEST_SUITE_P(GlslCompile, BadShaderTest, testing::ValuesIn(kBadShaders),
                         [](const auto& bad) { return std::string(bad.param.name); });

TEST(GlslCompile, TellsSeveralErrorsEachAtItsLine) {
    const ShaderPass pass = compileText("#pragma hone out Error error\n"
                                        "void main() {\n"
                                        "    error = vec2(first);\n"
                                        "    error = vec2(second);\n"
                                        "}\n");
    ASSERT_EQ(pass.problems.size(), 2u);
    EXPECT_EQ(pass.problems[0].line, 3u);
    EXPECT_EQ(pass.problems[1].line, 4u);
}

TEST(GlslCompile, AnUnusedOptionalIsNoErrorOfItsFlag) {
    EXPECT_TRUE(compileText("#pragma hone in Radiance color\n#pragma hone in optional Error guess\n"
                            "#pragma hone out Error error\n"
                            "void main() { error = guess[index] + color[index].x; }\n")
                    .problems.empty());
}

TEST(GlslCompile, TheEmptyFileIsRefused) {
    EXPECT_EQ(compileText("").problems.size(), 1u);
}

TEST(GlslCompile, AFileThatIsTooLargeIsRefused) {
    const ShaderProblem problem = problemOf(kGood + std::string(70000, ' '));
    EXPECT_NE(problem.message.find("at most 65536"), std::string::npos) << problem.message;
}

TEST(GlslCompile, AFileThatIsNoTextIsRefused) {
    const ShaderProblem problem = problemOf(kGood + std::string(1, '\0'));
    EXPECT_NE(problem.message.find("zero byte"), std::string::npos) << problem.message;
}

TEST(GlslCompile, AMacroThatDoublesForeverEndsInAnError) {
    std::string text = "#define a0 1.0 + 1.0\n";
    for (int i = 1; i < 40; ++i) {
        const std::string before = "a" + std::to_string(i - 1);
        text += "#define a" + std::to_string(i) + " " + before + " + " + before + "\n";
    }
    const ShaderProblem problem =
        problemOf(text + "void main() { error = vec2(color[index].x + a39); }\n");
    EXPECT_NE(problem.message.find("cannot be compiled"), std::string::npos) << problem.message;
}

TEST(GlslCompile, DeepNestingIsAnErrorAndNoCrash) {
    for (const auto& [open, close] :
         {std::pair("(", ")"), std::pair("-(", ")"), std::pair("-", ""), std::pair("1.0+", "")}) {
        std::string sum;
        for (int i = 0; i < 12000; ++i)
            sum += open;
        sum += "1.0";
        for (int i = 0; i < 12000; ++i)
            sum += close;
        const ShaderPass pass = compileText("#pragma hone out Error error\n"
                                            "void main() { error = vec2(" +
                                            sum + "); }\n");
        EXPECT_NE(pass.type.has_value(), !pass.problems.empty());
    }
}

TEST(GlslCompile, HostileTextsNeverThrow) {
    const std::string seed = "#pragma hone doc \"What it does.\"\n"
                             "#pragma hone in Radiance color \"what\"\n"
                             "#pragma hone in optional PixelList order\n"
                             "#pragma hone out Error error\n"
                             "#pragma hone param float gain = 2 min 0 max 4\n"
                             "#pragma hone param enum mode = a | b\n"
                             "/* a comment */\n"
                             "#define TWICE(x) ((x) + (x))\n"
                             "float f(vec3 c) { return mode == mode_a ? c.x : TWICE(c.y); }\n"
                             "void main() {\n"
                             "    for (int i = 0; i < 3; ++i)\n"
                             "        error += vec2(gain * f(color[neighbour(i, -i)]));\n"
                             "    if (has_order && order_count > 2u) error.x = float(order[1]);\n"
                             "}\n";
    ASSERT_TRUE(compileText(seed).problems.empty()) << compileText(seed).problems[0].message;
    const std::string pieces[] = {"#",       "{",    "}",    "(",     ")",  "\"",          "/*",
                                  "*/",      "\\\n", ";",    "##",    "=",  "|",           "0x",
                                  "#pragma", "\n",   "\xff", "1e999", "[",  "]",           "!",
                                  "uint",    "main", "#if",  "hone",  "''", "999999999999"};
    std::uint32_t state = 1;
    const auto random = [&](std::size_t below) {
        state = state * 1664525u + 1013904223u;
        return (state >> 8) % below;
    };
    for (int round = 0; round < 300; ++round) {
        std::string text = seed;
        for (std::size_t edits = 1 + random(4); edits > 0; --edits) {
            const std::size_t at = random(text.size());
            switch (random(4)) {
            case 0:
                text.erase(at, 1 + random(20));
                break;
            case 1:
                text[at] = static_cast<char>(random(256));
                break;
            case 2:
                text.insert(at, text.substr(random(text.size()), random(30)));
                break;
            default:
                text.insert(at, pieces[random(std::size(pieces))]);
            }
        }
        const ShaderPass pass = compileText(text);
        EXPECT_NE(pass.type.has_value(), !pass.problems.empty()) << text;
        const auto lines = 1 + static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
        for (const ShaderProblem& problem : pass.problems)
            EXPECT_LE(problem.line, lines) << problem.message << "\n" << text;
    }
}

} // namespace
} // namespace hone

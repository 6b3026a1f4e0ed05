// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/glsl/shader_header.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace hone {
namespace {

ShaderHeader parse(const std::string& text) {
    return parseShaderHeader(text, types::kAll);
}

TEST(ShaderHeader, ReadsPortsInTheOrderOfTheFile) {
    const ShaderHeader header = parse("#pragma hone doc \"What it does.\"\n"
                                      "#pragma hone in Radiance color \"what is looked at\"\n"
                                      "#pragma hone in optional Error guess\n"
                                      "#pragma hone out Error error \"what comes out\"\n");
    ASSERT_TRUE(header.problems.empty()) << header.problems.front().message;
    EXPECT_EQ(header.doc, "What it does.");
    ASSERT_EQ(header.ports.size(), 3u);
    EXPECT_EQ(header.ports[0].name, "color");
    EXPECT_EQ(header.ports[0].type, types::kRadiance);
    EXPECT_EQ(header.ports[0].doc, "what is looked at");
    EXPECT_FALSE(header.ports[0].is_optional);
    EXPECT_EQ(header.ports[1].name, "guess");
    EXPECT_TRUE(header.ports[1].is_optional);
    EXPECT_EQ(header.ports[2].name, "error");
    EXPECT_TRUE(header.ports[2].is_output);
}

TEST(ShaderHeader, ReadsParametersWithDefaultRangeUnitAndText) {
    const ShaderHeader header =
        parse("#pragma hone param float gain = 1.5 min -2 max 1e3 unit \"px\" \"how much\"\n"
              "#pragma hone param uint radius = 3 max 9\n"
              "#pragma hone param bool is_strict = true \"or not\"\n"
              "#pragma hone param enum curve = linear | square \"which\"\n"
              "#pragma hone out Error error\n");
    ASSERT_TRUE(header.problems.empty()) << header.problems.front().message;
    ASSERT_EQ(header.params.size(), 4u);
    const ParamDecl& gain = header.params[0].decl;
    EXPECT_EQ(gain.name, "gain");
    EXPECT_EQ(std::get<float>(gain.fallback), 1.5f);
    EXPECT_EQ(gain.min, -2.0);
    EXPECT_EQ(gain.max, 1000.0);
    EXPECT_EQ(gain.unit, "px");
    EXPECT_EQ(gain.doc, "how much");
    const ParamDecl& radius = header.params[1].decl;
    EXPECT_EQ(std::get<uint>(radius.fallback), 3u);
    EXPECT_FALSE(radius.min.has_value());
    EXPECT_EQ(radius.max, 9.0);
    EXPECT_EQ(std::get<bool>(header.params[2].decl.fallback), true);
    EXPECT_EQ(header.params[3].decl.choices, (std::vector<std::string>{"linear", "square"}));
    EXPECT_EQ(std::get<std::string>(header.params[3].decl.fallback), "linear");
}

TEST(ShaderHeader, LeavesTheBodysLinesWhereTheyAre) {
    const ShaderHeader header = parse("// first\n#pragma hone out Error error\nvoid main() {}");
    EXPECT_EQ(header.body, "// first\n\nvoid main() {}\n");
}

TEST(ShaderHeader, AnnotationsMayHaveBlanksAndCommentsAndCarriageReturns) {
    const ShaderHeader header =
        parse("  #  pragma\thone  out Error error \"http://x\" // said\r\n");
    ASSERT_TRUE(header.problems.empty()) << header.problems.front().message;
    EXPECT_EQ(header.ports.at(0).doc, "http://x");
}

TEST(ShaderHeader, WhatIsInACommentIsNoAnnotation) {
    const ShaderHeader header = parse("/*\n#pragma hone in Radiance color\n*/\n"
                                      "// #pragma hone in Radiance color\n"
                                      "#pragma hone out Error error\n");
    EXPECT_TRUE(header.problems.empty());
    EXPECT_EQ(header.ports.size(), 1u);
}

TEST(ShaderHeader, KeepsThePlaceOfNames) {
    const ShaderHeader header = parse("\n#pragma hone out Error error\n");
    EXPECT_EQ(header.ports.at(0).place.line, 2u);
    EXPECT_EQ(header.ports.at(0).place.column, 24u);
    EXPECT_EQ(header.ports.at(0).place.length, 5u);
}

TEST(ShaderHeader, TellsAllProblemsAtOnce) {
    const ShaderHeader header = parse("#pragma hone in Radiant color\n"
                                      "#pragma hone out Error error\n"
                                      "#pragma hone param float gain\n");
    ASSERT_EQ(header.problems.size(), 2u);
    EXPECT_EQ(header.problems[0].line, 1u);
    EXPECT_EQ(header.problems[1].line, 3u);
}

struct BadLine {
    const char* name;
    const char* line; ///< the second of the file, whose first has an output
    std::size_t column;
    std::size_t length;
    const char* message; ///< a part of it
    const char* hint;    ///< a part of it
};

class BadAnnotation : public testing::TestWithParam<BadLine> {};

TEST_P(BadAnnotation, IsToldWithItsPlace) {
    const BadLine& bad = GetParam();
    const ShaderHeader header =
        parse("#pragma hone out Error error\n" + std::string(bad.line) + "\n");
    ASSERT_EQ(header.problems.size(), 1u);
    const ShaderProblem& problem = header.problems.front();
    EXPECT_EQ(problem.line, 2u);
    EXPECT_EQ(problem.column, bad.column);
    EXPECT_EQ(problem.length, bad.length);
    EXPECT_NE(problem.message.find(bad.message), std::string::npos) << problem.message;
    EXPECT_NE(problem.hint.find(bad.hint), std::string::npos) << problem.hint;
}

const BadLine kBadLines[] = {
    {"Nothing", "#pragma hone", 13, 1, "the line ends where an annotation", "one of \"doc\""},
    {"UnknownKind", "#pragma hone inn Error e", 14, 3, "\"inn\" where an annotation",
     "did you mean \"in\"?"},
    {"UnknownType", "#pragma hone in Eror e", 17, 4, "no port type \"Eror\"",
     "did you mean \"Error\"?"},
    {"MissingType", "#pragma hone in", 16, 1, "the line ends where a port type", "in [optional]"},
    {"MissingName", "#pragma hone in Error", 22, 1, "the line ends where a name", "NAME"},
    {"NumberForName", "#pragma hone in Error 7", 23, 1, "\"7\" where a name", "NAME"},
    {"BadName", "#pragma hone in Error Guess", 23, 5, "\"Guess\" is no name", "lower-case"},
    {"NameOfHone", "#pragma hone in Error hone_x", 23, 6, "a meaning of its own", "another"},
    {"NameOfTheVocabulary", "#pragma hone in Error index", 23, 5, "a meaning of its own",
     "another"},
    {"NameTwice", "#pragma hone in Error error", 23, 5, "has \"error\" already", "must differ"},
    {"SceneType", "#pragma hone in Scene scene", 17, 5, "no Scene ports", "numbers"},
    {"OutputList", "#pragma hone out PixelList list", 18, 9, "is no plane", "C++"},
    {"OptionalOutput", "#pragma hone out optional Error e", 18, 8, "no port type \"optional\"", ""},
    {"WordAfterPort", "#pragma hone in Error e maybe", 25, 5, "\"maybe\" is more", "in [optional]"},
    {"OpenText", "#pragma hone in Error e \"what", 25, 5, "no closing quote", "end it"},
    {"DocWithoutText", "#pragma hone doc What it does", 18, 4, "\"What\" where a text", "doc \""},
    {"UnknownParameterType", "#pragma hone param int n = 1", 20, 3, "where a parameter's type",
     "uint"},
    {"NoDefault", "#pragma hone param float gain", 30, 1, "\"gain\" has no default", "= DEFAULT"},
    {"DefaultNoNumber", "#pragma hone param float gain = much", 33, 4, "\"much\" where a float",
     "0.5"},
    {"DefaultWithSuffix", "#pragma hone param float gain = 1.0f", 33, 4, "\"1.0f\" where a float",
     "without an f"},
    {"DefaultInfinite", "#pragma hone param float gain = inf", 33, 3, "where a float", ""},
    {"NegativeUint", "#pragma hone param uint n = -1", 29, 2, "\"-1\" where a uint", ""},
    {"DefaultOutOfRange", "#pragma hone param float gain = 5 max 4", 33, 1,
     "default of \"gain\" lies outside", "at most"},
    {"RangeWithoutNumber", "#pragma hone param float gain = 5 max", 38, 1,
     "the line ends where a float", ""},
    {"BoolNoBool", "#pragma hone param bool is_on = 1", 33, 1, "where true or false", ""},
    {"EnumWithoutChoice", "#pragma hone param enum mode = a |", 35, 1, "where a choice's name", ""},
    {"ChoiceTwice", "#pragma hone param enum mode = a | a", 36, 1, "has \"mode_a\" already", ""},
};

INSTANTIATE_TEST_SUITE_P(ShaderHeader, BadAnnotation, testing::ValuesIn(kBadLines),
                         [](const auto& bad) { return std::string(bad.param.name); });

TEST(ShaderHeader, AShaderWithoutOutputIsRefused) {
    const ShaderHeader header = parse("#pragma hone in Radiance color\n");
    ASSERT_EQ(header.problems.size(), 1u);
    EXPECT_EQ(header.problems[0].message, "the shader declares no output");
}

TEST(ShaderHeader, NamesThatHoneMakesOfAPortAreTaken) {
    const ShaderHeader header = parse("#pragma hone out Error error\n"
                                      "#pragma hone in optional Error guess\n"
                                      "#pragma hone param bool has_guess = true\n");
    ASSERT_EQ(header.problems.size(), 1u);
    EXPECT_EQ(header.problems[0].line, 3u);
}

TEST(ShaderHeader, MorePortsThanThereIsRoomForAreRefused) {
    std::string text = "#pragma hone out Error error\n";
    for (std::size_t i = 1; i < kMaxShaderPorts; ++i)
        text += "#pragma hone in Error e" + std::to_string(i) + "\n";
    EXPECT_TRUE(parse(text).problems.empty());
    text += "#pragma hone in Error one_more\n";
    ASSERT_EQ(parse(text).problems.size(), 1u);
    EXPECT_EQ(parse(text).problems[0].line, kMaxShaderPorts + 1);
}

TEST(ShaderHeader, MoreParametersThanThereIsRoomForAreRefused) {
    std::string text = "#pragma hone out Error error\n";
    for (std::size_t i = 0; i < kMaxShaderConstants; ++i)
        text += "#pragma hone param float p" + std::to_string(i) + " = 0\n";
    EXPECT_TRUE(parse(text).problems.empty());
    EXPECT_EQ(parse(text + "#pragma hone in optional Error guess\n").problems.size(), 1u);
}

} // namespace
} // namespace hone

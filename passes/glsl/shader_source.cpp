// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/glsl/shader_source.h"

namespace hone {
namespace {

constexpr const char* kBegin = R"(#version 460
#extension GL_EXT_scalar_block_layout : require
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform HoneParams {
    uint hone_count;
    uint hone_row;
    uvec2 extent;
)";

constexpr const char* kVocabulary = R"(
uint count;
uint index;
uvec2 pixel;
uint neighbour(int dx, int dy) {
    ivec2 p = clamp(ivec2(pixel) + ivec2(dx, dy), ivec2(0), ivec2(extent) - 1);
    return uint(p.y) * extent.x + uint(p.x);
}
float luminance(vec3 color) { return dot(color, vec3(0.2126, 0.7152, 0.0722)); }
#define main hone_main
void main();
)";

constexpr const char* kMain = R"(
#undef main
void main() {
    count = hone_count;
    index = gl_GlobalInvocationID.y * hone_row + gl_GlobalInvocationID.x;
    if (index >= count)
        return;
    pixel = uvec2(index % extent.x, index / extent.x);
)";

std::string lineMark(std::size_t line, std::size_t string) {
    return "#line " + std::to_string(line) + " " + std::to_string(string) + "\n";
}

/// GLSL's zero of a port's elements: "vec2(0)".
std::string zero(const ShaderPort& port) {
    return std::string(port.type.format) + "(0)";
}

} // namespace

std::string wholeSource(const ShaderHeader& header) {
    // What is written for an annotation counts to its line, so that the compiler's word about a
    // name (a reserved one, say) is told there.
    const auto declaration = [](const ShaderPlace& place, const std::string& text) {
        return lineMark(place.line, kInShader) + text + "\n" + lineMark(1, kAroundShader);
    };
    std::string source = kBegin;
    for (const ShaderParam& param : header.params) {
        const bool is_enum = param.decl.type == ParamType::kEnum;
        source += declaration(param.place, std::string(is_enum ? "uint" : name(param.decl.type)) +
                                               " " + param.decl.name + ";");
    }
    for (const ShaderPort& port : header.ports) {
        if (port.is_optional)
            source += "bool " + hasMember(port) + ";\n";
        if (port.type.shape != Shape::kPlane)
            source += "uint " + countMember(port) + ";\n";
    }
    source += "};\n";

    std::size_t binding = 0;
    for (const ShaderPort& port : header.ports) {
        const std::string type(port.type.format);
        const std::string layout =
            "layout(scalar, binding = " + std::to_string(binding++) + ") restrict ";
        if (port.is_output)
            source +=
                declaration(port.place, layout + "writeonly buffer " + port.name + "_buffer { " +
                                            type + " hone_" + port.name + "[]; };\n" +
                                            lineMark(port.place.line, kInShader) + type + " " +
                                            port.name + " = " + zero(port) + ";");
        else
            source += declaration(port.place, layout + "readonly buffer " + port.name +
                                                  "_buffer { " + type + " " + port.name + "[]; };");
    }
    for (const ShaderParam& param : header.params)
        for (std::size_t i = 0; i < param.decl.choices.size(); ++i)
            source += "const uint " + param.decl.name + "_" + param.decl.choices[i] + " = " +
                      std::to_string(i) + "u;\n";

    source +=
        kVocabulary + lineMark(1, kInShader) + header.body + lineMark(1, kAfterShader) + kMain;
    for (const ShaderPort& port : header.ports)
        if (port.is_output)
            source += "    " + port.name + " = " + zero(port) + ";\n";
    source += "    hone_main();\n";
    for (const ShaderPort& port : header.ports)
        if (port.is_output)
            source += "    hone_" + port.name + "[index] = " + port.name + ";\n";
    return source + "}\n";
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/pass/shader_pass.h"

#include <string>
#include <string_view>
#include <vector>

namespace hone {

/// A line of a shader file.
struct ShaderLine {
    std::size_t number = 0; ///< from 1
    std::string_view text;  ///< as written, without its end
    std::string code;       ///< the same with blanks for comments
};

/// The lines of a text, which must outlive them. An annotation keeps its comments: they may be in
/// a "text".
[[nodiscard]] std::vector<ShaderLine> linesOf(std::string_view text);

/// Where, in a line that begins with `#pragma hone`, the rest begins; 0 for other lines.
[[nodiscard]] std::size_t annotationIn(const ShaderLine& line);

/// What a shader file may not have because hone writes it or because it would reach outside of the
/// file: #version, #extension, #include, #line, other pragmas, names of hone's own.
[[nodiscard]] std::vector<ShaderProblem> findForbidden(const std::vector<ShaderLine>& lines);

/// Where in a shader file something stands.
struct ShaderPlace {
    std::size_t line = 0;   ///< from 1; 0 = nowhere
    std::size_t column = 0; ///< from 1; 0 = the whole line
    std::size_t length = 1; ///< bytes
};

/// Where `word` stands for the first time in the code of the lines.
[[nodiscard]] ShaderPlace firstPlaceOf(std::string_view word, const std::vector<ShaderLine>& lines);

/// Where `word` stands in the code of a line, from 1; 0 if it does not or does so several times.
[[nodiscard]] std::size_t columnOf(std::string_view word, std::string_view code);

[[nodiscard]] constexpr bool isBlank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}
[[nodiscard]] constexpr bool isWordByte(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

} // namespace hone

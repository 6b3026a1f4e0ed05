// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/glsl/shader_text.h"

#include "hone/core/graph/reporter.h"

#include <array>

namespace hone {
namespace {

/// Passes a word and the blanks around it; false, and stays, if another one is there.
bool skipWord(std::string_view text, std::string_view word, std::size_t& at) {
    std::size_t begin = at;
    while (begin < text.size() && isBlank(text[begin]))
        ++begin;
    std::size_t end = begin + word.size();
    if (text.substr(begin, word.size()) != word ||
        (isWordByte(word.back()) && end < text.size() && isWordByte(text[end])))
        return false;
    while (end < text.size() && isBlank(text[end]))
        ++end;
    at = end;
    return true;
}

std::size_t annotationBegin(std::string_view text) {
    std::size_t at = 0;
    return skipWord(text, "#", at) && skipWord(text, "pragma", at) && skipWord(text, "hone", at)
               ? at
               : 0;
}

/// Replaces comments by blanks; `is_inside` a /* comment */ at the begin, and then at the end.
std::string withoutComments(std::string_view text, bool& is_inside) {
    std::string code(text);
    for (std::size_t i = 0; i < code.size(); ++i) {
        const std::string_view pair = text.substr(i, 2);
        if (!is_inside && pair == "//")
            return code.substr(0, i) + std::string(code.size() - i, ' ');
        if (pair == (is_inside ? "*/" : "/*")) {
            is_inside = !is_inside;
            code[i] = code[i + 1] = ' ';
            ++i;
        } else if (is_inside) {
            code[i] = ' ';
        }
    }
    return code;
}

/// What a forbidden directive's line is told.
std::string hintFor(std::string_view directive) {
    if (directive == "version")
        return "remove the line: shaders of hone are GLSL 4.60";
    if (directive == "include")
        return "a shader is one file: copy what you need into it";
    if (directive == "extension")
        return "remove the line: a shader runs on every device, so it has GLSL 4.60 and no more";
    if (directive == "pragma")
        return "annotations are written: #pragma hone ...";
    return "remove the line";
}

} // namespace

std::vector<ShaderLine> linesOf(std::string_view text) {
    std::vector<ShaderLine> lines;
    bool is_in_comment = false;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        ShaderLine line{lines.size() + 1, text.substr(begin, end - begin), ""};
        const bool is_annotation = !is_in_comment && annotationBegin(line.text) > 0;
        line.code = is_annotation ? line.text : withoutComments(line.text, is_in_comment);
        lines.push_back(std::move(line));
        begin = end + 1;
    }
    return lines;
}

std::size_t annotationIn(const ShaderLine& line) {
    return annotationBegin(line.code);
}

std::vector<ShaderProblem> findForbidden(const std::vector<ShaderLine>& lines) {
    constexpr std::array<std::string_view, 5> kDirectives{"version", "extension", "include", "line",
                                                          "pragma"};
    std::vector<ShaderProblem> problems;
    for (const ShaderLine& line : lines) {
        if (annotationIn(line) > 0)
            continue;
        const std::size_t first = line.code.find_first_not_of(" \t");
        std::size_t at = 0;
        if (skipWord(line.code, "#", at))
            for (const std::string_view directive : kDirectives)
                if (std::size_t after = at; skipWord(line.code, directive, after))
                    problems.push_back(
                        {line.number, first + 1, line.code.find_last_not_of(" \t\r") - first + 1,
                         "a shader of hone has no #" + std::string(directive), hintFor(directive)});

        // Names of what hone writes around the shader.
        for (std::size_t i = line.code.find("hone_"); i != std::string::npos;
             i = line.code.find("hone_", i + 1)) {
            if (i > 0 && isWordByte(line.code[i - 1]))
                continue;
            std::size_t end = i;
            while (end < line.code.size() && isWordByte(line.code[end]))
                ++end;
            problems.push_back({line.number, i + 1, end - i,
                                "\"" + line.code.substr(i, end - i) +
                                    "\": names that begin with hone_ are hone's own",
                                "choose another name"});
        }
    }
    return problems;
}

namespace {
/// Where `word` stands as a whole word at or after `from`; npos = nowhere.
std::size_t findWord(std::string_view word, std::string_view code, std::size_t from) {
    for (std::size_t i = code.find(word, from); i != std::string_view::npos;
         i = code.find(word, i + 1)) {
        const std::size_t end = i + word.size();
        const bool begins = i == 0 || !isWordByte(code[i - 1]) || !isWordByte(word.front());
        const bool ends = end == code.size() || !isWordByte(code[end]) || !isWordByte(word.back());
        if (begins && ends)
            return i;
    }
    return std::string_view::npos;
}
} // namespace

std::size_t columnOf(std::string_view word, std::string_view code) {
    constexpr std::size_t kNowhere = std::string_view::npos;
    const std::size_t first = word.empty() ? kNowhere : findWord(word, code, 0);
    const bool is_once = first != kNowhere && findWord(word, code, first + 1) == kNowhere;
    return is_once ? first + 1 : 0;
}

ShaderPlace firstPlaceOf(std::string_view word, const std::vector<ShaderLine>& lines) {
    if (!word.empty())
        for (const ShaderLine& line : lines)
            if (const std::size_t at = findWord(word, line.code, 0); at != std::string::npos)
                return {line.number, at + 1, word.size()};
    return {};
}

} // namespace hone

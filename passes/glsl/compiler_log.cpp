// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/glsl/compiler_log.h"

#include "hone/core/graph/diagnostics.h"
#include "hone/passes/glsl/shader_source.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

namespace hone {
namespace {

/// "1:12: rest": string 1, line 12. Takes it off `text`.
struct Place {
    std::size_t string = 0;
    std::size_t line = 0;
};
std::optional<Place> takePlace(std::string_view& text) {
    Place place;
    const char* const end = text.data() + text.size();
    const auto string = std::from_chars(text.data(), end, place.string);
    if (string.ec != std::errc{} || string.ptr == end || *string.ptr != ':')
        return std::nullopt;
    const auto line = std::from_chars(string.ptr + 1, end, place.line);
    if (line.ec != std::errc{} || line.ptr == end || *line.ptr != ':')
        return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(line.ptr + 1 - text.data()));
    return place;
}

std::string trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos)
        return "";
    return std::string(text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1));
}

/// "'radince' : undeclared identifier": the token and the message.
struct Statement {
    std::string token;
    std::string message;
};
Statement split(std::string_view text) {
    const std::string whole = trimmed(text);
    const std::size_t end = whole.find("' : ");
    if (!whole.starts_with('\'') || end == std::string::npos)
        return {"", whole};
    return {whole.substr(1, end - 1), trimmed(std::string_view(whole).substr(end + 4))};
}

void replaceAll(std::string& text, std::string_view what, std::string_view by) {
    for (std::size_t i = text.find(what); i != std::string::npos;
         i = text.find(what, i + by.size()))
        text.replace(i, what.size(), by);
}

/// A type as an author writes it: of "layout( column_major scalar offset=0) restrict readonly temp
/// highp 3-component vector of float" only "vec3".
std::string plainType(std::string_view type) {
    if (const std::size_t layout = type.find("layout("); layout != std::string_view::npos)
        type.remove_prefix(std::min(type.find(')', layout), type.size() - 1) + 1);
    std::string text = " " + trimmed(type) + " ";
    for (const char* qualifier :
         {" restrict ", " readonly ", " writeonly ", " temp ", " global ", " const ", " in ",
          " out ", " inout ", " uniform ", " buffer ", " lowp ", " mediump ", " highp "})
        replaceAll(text, qualifier, " ");
    text = trimmed(text);
    for (const auto& [scalar, prefix] : {std::pair("float", ""), std::pair("int", "i"),
                                         std::pair("uint", "u"), std::pair("bool", "b")})
        for (const char* count : {"2", "3", "4"})
            if (text == std::string(count) + "-component vector of " + scalar)
                return std::string(prefix) + "vec" + count;
    return text;
}

/// The message in the author's words: types as they are written, main() by its name.
std::string inAuthorsWords(std::string_view message) {
    std::string text;
    while (!message.empty()) {
        const std::size_t open = message.find('\'');
        const std::size_t close =
            open == std::string_view::npos ? open : message.find('\'', open + 1);
        text += message.substr(0, std::min(open, message.size()));
        if (close == std::string_view::npos) {
            text += open == std::string_view::npos ? "" : message.substr(open);
            break;
        }
        text += '\'' + plainType(message.substr(open + 1, close - open - 1)) + '\'';
        message.remove_prefix(close + 1);
    }
    replaceAll(text, "hone_main", "main");
    replaceAll(text, "Linking compute stage: ", "");
    return trimmed(text);
}

class LogReader {
public:
    LogReader(const std::vector<ShaderLine>& lines, const std::vector<std::string>& names)
        : lines_(lines), names_(names) {}

    ShaderProblem problem(std::string_view text) const {
        const std::optional<Place> place = takePlace(text);
        auto [token, message] = split(text);
        message = inAuthorsWords(message);
        ShaderProblem result;
        if (message.find("undeclared identifier") != std::string::npos ||
            message.find("no matching overloaded function found") != std::string::npos)
            if (const std::string near = nearest(token, names_); !near.empty() && near != token)
                result.hint = "did you mean \"" + near + "\"?";
        if (message.find("can't modify a readonly buffer") != std::string::npos)
            result.hint = "an input cannot be written; declare an output";
        if (message.find("No function definition") != std::string::npos)
            result.hint = "is void main() missing?";
        const bool is_syntax = message.find("syntax error") != std::string::npos;
        if (!token.empty() && token != "assign")
            message = "\"" + token + "\": " + message;
        result.message = std::move(message);
        if (!place || place->string == kAroundShader || lines_.empty())
            return result;

        // What hone writes after the shader cannot be wrong unless the shader does not end.
        if (place->string == kAfterShader) {
            result.line = lastLineWithCode();
            if (is_syntax)
                result.hint = "the file ends too early: is a } or a ; missing?";
            return result;
        }
        result.line = std::clamp<std::size_t>(place->line, 1, lines_.size());
        const std::string& code = lines_[result.line - 1].code;
        result.column = columnOf(token, code);
        if (result.column > 0)
            result.length = token.size();
        return result;
    }

private:
    std::size_t lastLineWithCode() const {
        for (std::size_t i = lines_.size(); i > 0; --i)
            if (lines_[i - 1].code.find_first_not_of(" \t\r") != std::string::npos)
                return i;
        return lines_.size();
    }

    const std::vector<ShaderLine>& lines_;
    const std::vector<std::string>& names_;
};

} // namespace

std::vector<ShaderProblem> readCompilerLog(const std::string& log,
                                           const std::vector<ShaderLine>& lines,
                                           const std::vector<std::string>& names) {
    constexpr std::string_view kError = "ERROR: ";
    const LogReader reader(lines, names);
    std::vector<ShaderProblem> problems;
    bool is_error = false;
    for (const ShaderLine& said : linesOf(log)) {
        if (said.text.starts_with(kError)) {
            ShaderProblem problem = reader.problem(said.text.substr(kError.size()));
            is_error = said.text.find("No code generated.") == std::string_view::npos &&
                       said.text.find("compilation terminated") == std::string_view::npos;
            // Of a line's errors the first counts; the others mostly follow from it.
            is_error = is_error && (problem.line == 0 ||
                                    std::ranges::find(problems, problem.line,
                                                      &ShaderProblem::line) == problems.end());
            if (is_error)
                problems.push_back(std::move(problem));
        } else if (said.text.starts_with("WARNING: ")) {
            is_error = false;
        } else if (is_error && !trimmed(said.text).empty()) {
            problems.back().message =
                trimmed(problems.back().message + " " + inAuthorsWords(said.text));
        }
    }
    return problems;
}

} // namespace hone

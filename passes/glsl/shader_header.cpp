// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/glsl/shader_header.h"

#include "hone/core/graph/reporter.h"
#include "hone/passes/glsl/shader_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace hone {
namespace {

/// A piece of an annotation: a word, a number, a "text", = or |.
struct Token {
    enum class Kind : std::uint8_t { kWord, kNumber, kText, kSymbol, kEnd };
    Kind kind = Kind::kEnd;
    std::string text; ///< of a kText without its quotes
    ShaderPlace place;
};

/// The bytes that an element of a GLSL type takes in a buffer of hone (scalar layout); 0 = a type
/// that no port can have.
std::uint32_t bytesOf(std::string_view format) {
    struct Format {
        std::string_view name;
        std::uint32_t bytes;
    };
    constexpr std::array kFormats{Format{"float", 4}, Format{"int", 4},    Format{"uint", 4},
                                  Format{"vec2", 8},  Format{"ivec2", 8},  Format{"uvec2", 8},
                                  Format{"vec3", 12}, Format{"ivec3", 12}, Format{"uvec3", 12},
                                  Format{"vec4", 16}, Format{"ivec4", 16}, Format{"uvec4", 16}};
    const auto found = std::ranges::find(kFormats, format, &Format::name);
    return found != kFormats.end() ? found->bytes : 0;
}

bool isName(std::string_view text) {
    const auto is_good = [](char c) { return isWordByte(c) && !(c >= 'A' && c <= 'Z'); };
    return !text.empty() && text.front() >= 'a' && text.front() <= 'z' && text.size() <= 40 &&
           std::ranges::all_of(text, is_good) && text.find("__") == std::string_view::npos;
}

class HeaderParser {
public:
    HeaderParser(ShaderHeader& header, std::span<const PortType> types)
        : header_(header), types_(types) {}

    /// One annotation: `line` of the file, of which the first `begin` bytes are "#pragma hone".
    void parse(std::string_view line, std::size_t begin, std::size_t number) {
        if (!tokenize(line, begin, number))
            return;
        const Token kind = take();
        if (kind.text == "doc")
            parseDoc();
        else if (kind.text == "in" || kind.text == "out")
            parsePort(kind.text == "out");
        else if (kind.text == "param")
            parseParam();
        else
            problem(kind.place, found(kind) + " where an annotation says what it declares",
                    suggest(kind.text, {"doc", "in", "out", "param"}, "one of"));
    }

    /// What can only be told at the end of the file.
    void finish() {
        std::vector<ShaderProblem>& problems = header_.problems;
        const auto outputs = std::ranges::count_if(header_.ports, &ShaderPort::is_output);
        if (outputs == 0 && problems.empty())
            problems.push_back({.message = "the shader declares no output",
                                .hint = "add a line like: #pragma hone out Error error"});
        if (header_.ports.size() > kMaxShaderPorts)
            problem(header_.ports[kMaxShaderPorts].place,
                    "a shader has at most " + std::to_string(kMaxShaderPorts) + " ports",
                    "make two passes of it");
        if (constants_ > kMaxShaderConstants)
            problems.push_back({.message = "parameters, lists and optional inputs are " +
                                           std::to_string(constants_) + " together; at most " +
                                           std::to_string(kMaxShaderConstants) + " are possible",
                                .hint = "make two passes of it"});
    }

private:
    void problem(ShaderPlace place, std::string message, std::string hint) {
        header_.problems.push_back(
            {place.line, place.column, place.length, std::move(message), std::move(hint)});
        is_broken_ = true;
    }

    static std::string found(const Token& token) {
        return token.kind == Token::Kind::kEnd ? "the line ends" : "\"" + token.text + "\"";
    }

    bool tokenize(std::string_view line, std::size_t at, std::size_t number) {
        tokens_.clear();
        next_ = 0;
        is_broken_ = false;
        while (at < line.size()) {
            const char c = line[at];
            if (isBlank(c)) {
                ++at;
                continue;
            }
            if (line.substr(at).starts_with("//"))
                break;
            std::size_t end = at + 1;
            Token token{Token::Kind::kSymbol, "", {number, at + 1, 1}};
            if (c == '"') {
                end = line.find('"', at + 1);
                if (end == std::string_view::npos) {
                    problem({number, at + 1, line.size() - at}, "the text has no closing quote",
                            "end it with \" on the same line");
                    return false;
                }
                token.kind = Token::Kind::kText;
                token.text = line.substr(at + 1, end++ - at - 1);
            } else if (c != '=' && c != '|') {
                while (end < line.size() && !isBlank(line[end]) && line[end] != '"' &&
                       line[end] != '=' && line[end] != '|')
                    ++end;
                const bool is_word = isWordByte(c) && !(c >= '0' && c <= '9');
                token.kind = is_word ? Token::Kind::kWord : Token::Kind::kNumber;
            }
            if (token.kind != Token::Kind::kText)
                token.text = line.substr(at, end - at);
            token.place.length = end - at;
            tokens_.push_back(std::move(token));
            at = end;
        }
        end_ = {Token::Kind::kEnd, "", {number, line.size() + 1, 1}};
        return true;
    }

    const Token& peek() const { return next_ < tokens_.size() ? tokens_[next_] : end_; }
    Token take() { return next_ < tokens_.size() ? tokens_[next_++] : end_; }
    bool takeIf(std::string_view word) {
        const bool is_it = peek().kind != Token::Kind::kText && peek().text == word;
        next_ += is_it ? 1 : 0;
        return is_it;
    }
    std::string takeText() { return peek().kind == Token::Kind::kText ? take().text : ""; }
    void expectEnd(std::string_view grammar) {
        if (peek().kind != Token::Kind::kEnd && !is_broken_)
            problem(peek().place, "\"" + peek().text + "\" is more than was expected here",
                    "write: #pragma hone " + std::string(grammar));
    }

    void parseDoc() {
        if (peek().kind != Token::Kind::kText)
            return problem(peek().place, found(peek()) + " where a text is expected",
                           "write: #pragma hone doc \"what the pass does\"");
        const ShaderPlace place = peek().place;
        std::string text = takeText();
        expectEnd("doc \"what the pass does\"");
        if (!header_.doc.empty())
            return problem(place, "the shader has a second doc", "make one text of both");
        header_.doc = std::move(text);
    }

    /// A name that is new; "" after a problem.
    std::string takeName(const char* grammar) {
        const Token token = take();
        const auto refuse = [&](const std::string& what, std::string hint) {
            problem(token.place, what, std::move(hint));
            return "";
        };
        if (token.kind != Token::Kind::kWord)
            return refuse(found(token) + " where a name is expected",
                          std::string("write: #pragma hone ") + grammar);
        if (!isName(token.text))
            return refuse("\"" + token.text + "\" is no name of a port or parameter",
                          "use lower-case letters, digits and single _, a letter first, at most "
                          "40");
        if (!reserve(token))
            return "";
        place_ = token.place;
        return token.text;
    }

    /// Takes a name for the shader's own; a problem if it has another meaning already.
    bool reserve(const Token& name) {
        constexpr std::array<std::string_view, 7> kVocabulary{
            "index", "pixel", "extent", "count", "neighbour", "luminance", "main"};
        if (std::ranges::find(kVocabulary, name.text) != kVocabulary.end() ||
            name.text.starts_with("hone_") || name.text.starts_with("gl_")) {
            problem(name.place, "\"" + name.text + "\" has a meaning of its own in shaders of hone",
                    "choose another name");
            return false;
        }
        if (std::ranges::find(names_, name.text) != names_.end()) {
            problem(name.place, "the shader has \"" + name.text + "\" already",
                    "names of inputs, outputs and parameters (also has_NAME, NAME_count and "
                    "NAME_CHOICE) must differ");
            return false;
        }
        names_.push_back(name.text);
        return true;
    }

    const PortType* takeType(const char* grammar) {
        const Token token = take();
        if (token.kind != Token::Kind::kWord) {
            problem(token.place, found(token) + " where a port type is expected",
                    std::string("write: #pragma hone ") + grammar);
            return nullptr;
        }
        std::vector<std::string> names;
        for (const PortType& type : types_) {
            if (type.name == token.text)
                return &type;
            names.emplace_back(type.name);
        }
        problem(token.place, "there is no port type \"" + token.text + "\"",
                suggest(token.text, names, "one of"));
        return nullptr;
    }

    void parsePort(bool is_output) {
        const char* const grammar =
            is_output ? "out TYPE NAME \"doc\"" : "in [optional] TYPE NAME \"doc\"";
        ShaderPort port;
        port.is_output = is_output;
        port.is_optional = !is_output && takeIf("optional");
        const ShaderPlace type_place = peek().place;
        const PortType* const type = takeType(grammar);
        if (type == nullptr)
            return;
        if (bytesOf(type->format) == 0 || bytesOf(type->format) != type->stride)
            return problem(type_place,
                           "a shader has no " + std::string(type->name) +
                               " ports: such a value is no array of numbers",
                           "use a type whose values are planes, lists or records of numbers");
        if (is_output && type->shape != Shape::kPlane)
            return problem(type_place,
                           "\"" + std::string(type->name) +
                               "\" is no plane; a shader writes one element a pixel",
                           "write a plane and let a pass in C++ make the list of it");
        port.type = *type;
        port.name = takeName(grammar);
        port.place = place_;
        if (port.name.empty())
            return;
        if (port.is_optional && !reserve({Token::Kind::kWord, "has_" + port.name, place_}))
            return;
        const bool is_counted = type->shape != Shape::kPlane;
        if (is_counted && !reserve({Token::Kind::kWord, port.name + "_count", place_}))
            return;
        port.doc = takeText();
        expectEnd(grammar);
        if (is_broken_)
            return;
        constants_ += (port.is_optional ? 1u : 0u) + (is_counted ? 1u : 0u);
        header_.ports.push_back(std::move(port));
    }

    void parseParam() {
        constexpr const char* kGrammar =
            "param TYPE NAME = DEFAULT [min A] [max B] [unit \"px\"] \"doc\"";
        ShaderParam param;
        const Token type = take();
        if (type.text == "float")
            param.decl.type = ParamType::kFloat;
        else if (type.text == "uint")
            param.decl.type = ParamType::kUint;
        else if (type.text == "bool")
            param.decl.type = ParamType::kBool;
        else if (type.text == "enum")
            param.decl.type = ParamType::kEnum;
        else
            return problem(type.place, found(type) + " where a parameter's type is expected",
                           suggest(type.text, {"float", "uint", "bool", "enum"}, "one of"));
        param.decl.name = takeName(kGrammar);
        param.place = place_;
        if (param.decl.name.empty())
            return;
        if (!takeIf("="))
            return problem(peek().place, "parameter \"" + param.decl.name + "\" has no default",
                           std::string("write: #pragma hone ") + kGrammar);
        if (param.decl.type == ParamType::kEnum)
            parseChoices(param.decl);
        else
            parseDefault(param.decl);
        if (is_broken_)
            return;
        if (takeIf("unit"))
            param.decl.unit = takeText();
        param.decl.doc = takeText();
        expectEnd(kGrammar);
        if (is_broken_)
            return;
        ++constants_;
        header_.params.push_back(std::move(param));
    }

    void parseChoices(ParamDecl& decl) {
        do {
            const Token choice = take();
            if (choice.kind != Token::Kind::kWord || !isName(choice.text))
                return problem(choice.place, found(choice) + " where a choice's name is expected",
                               "write: #pragma hone param enum NAME = FIRST | SECOND | ...");
            if (!reserve({Token::Kind::kWord, decl.name + "_" + choice.text, choice.place}))
                return;
            decl.choices.push_back(choice.text);
        } while (takeIf("|"));
        decl.fallback = decl.choices.front();
    }

    void parseDefault(ParamDecl& decl) {
        const Token token = take();
        if (decl.type == ParamType::kBool) {
            if (token.text != "true" && token.text != "false")
                return problem(token.place, found(token) + " where true or false is expected", "");
            decl.fallback = token.text == "true";
            return;
        }
        const std::optional<double> fallback = number(token, decl.type);
        const bool has_min = takeIf("min");
        decl.min = has_min ? number(take(), decl.type) : std::nullopt;
        const bool has_max = takeIf("max");
        decl.max = has_max ? number(take(), decl.type) : std::nullopt;
        if (is_broken_)
            return;
        if (decl.min.value_or(*fallback) > *fallback || decl.max.value_or(*fallback) < *fallback)
            return problem(token.place,
                           "the default of \"" + decl.name + "\" lies outside of its range",
                           "min must be at most the default, and max at least");
        if (decl.type == ParamType::kUint)
            decl.fallback = static_cast<uint>(*fallback);
        else
            decl.fallback = static_cast<float>(*fallback);
    }

    std::optional<double> number(const Token& token, ParamType type) {
        const char* const end = token.text.data() + token.text.size();
        if (type == ParamType::kUint) {
            uint value = 0;
            const auto read = std::from_chars(token.text.data(), end, value);
            if (!token.text.empty() && read.ec == std::errc{} && read.ptr == end)
                return value;
        } else {
            float value = 0;
            const auto read = std::from_chars(token.text.data(), end, value);
            if (!token.text.empty() && read.ec == std::errc{} && read.ptr == end &&
                std::isfinite(value))
                return value;
        }
        problem(token.place,
                found(token) + " where a " + (type == ParamType::kUint ? "uint" : "float") +
                    " is expected",
                type == ParamType::kUint ? "like 4" : "like 0.5, without an f");
        return std::nullopt;
    }

    ShaderHeader& header_;
    std::span<const PortType> types_;
    std::vector<Token> tokens_; ///< of the line that is read
    std::size_t next_ = 0;
    Token end_;
    bool is_broken_ = false; ///< the line has a problem
    ShaderPlace place_;      ///< of the name that was taken last
    std::vector<std::string> names_;
    std::size_t constants_ = 0;
};

} // namespace

ShaderHeader parseShaderHeader(const std::string& text, std::span<const PortType> types) {
    ShaderHeader header;
    HeaderParser parser(header, types);
    for (const ShaderLine& line : linesOf(text)) {
        if (const std::size_t begin = annotationIn(line); begin > 0)
            parser.parse(line.text, begin, line.number);
        else
            header.body += line.text;
        header.body += '\n';
    }
    parser.finish();
    return header;
}

} // namespace hone

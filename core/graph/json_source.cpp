// SPDX-License-Identifier: Apache-2.0
#include "hone/core/graph/json_source.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <unordered_map>

namespace hone {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{16} << 20;
constexpr std::size_t kMaxDepth = 64;
constexpr std::size_t kMaxValues = std::size_t{1} << 18;
constexpr std::size_t kMaxName = 256;

/// Walks over the text in step with the parser: each event of the parser is one token, so its place
/// is found by skipping what lies between tokens and measuring one.
class TokenWalk {
public:
    explicit TokenWalk(std::string_view text) : text_(text) {
        if (text.starts_with("\xEF\xBB\xBF"))
            at_ = 3;
    }

    /// Where the next token begins.
    std::size_t peek() const {
        std::size_t i = at_;
        while (i < text_.size()) {
            if (std::string_view(" \t\r\n:,").find(text_[i]) != std::string_view::npos)
                ++i;
            else if (text_.substr(i).starts_with("//"))
                i = std::min(text_.find('\n', i), text_.size());
            else if (text_.substr(i).starts_with("/*"))
                i = std::min(text_.find("*/", i + 2), text_.size() - 2) + 2;
            else
                break;
        }
        return i;
    }

    TextSpan next() {
        const std::size_t begin = peek();
        std::size_t end = begin + 1;
        const char first = begin < text_.size() ? text_[begin] : ' ';
        if (first == '"') {
            while (end < text_.size() && text_[end] != '"')
                end += text_[end] == '\\' ? 2 : 1;
            ++end;
        } else if (std::string_view("{}[]").find(first) == std::string_view::npos) {
            while (end < text_.size() &&
                   std::string_view(" \t\r\n:,{}[]\"/").find(text_[end]) == std::string_view::npos)
                ++end;
        }
        at_ = std::min(end, text_.size());
        return {static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(at_ - begin)};
    }

private:
    std::string_view text_;
    std::size_t at_ = 0;
};

/// What went wrong, in plain words, from the parser's own.
struct SyntaxError {
    std::string message;
    std::string hint;
};

SyntaxError explain(std::string what, std::string_view before) {
    const auto after = [&](std::string_view mark) {
        const std::size_t at = what.find(mark);
        return at == std::string::npos ? std::string() : what.substr(at + mark.size());
    };
    const char last = before.empty() ? ' ' : before.back();
    if (what.find("unexpected end of input") != std::string::npos)
        return {"the file ends too early", "a closing \"}\", \"]\" or quote is missing; the last "
                                           "one opened is the first to look at"};
    if (what.find("unexpected '}'") != std::string::npos && last == ',')
        return {"there is a comma before this \"}\"", "remove the comma"};
    if (what.find("unexpected ']'") != std::string::npos && last == ',')
        return {"there is a comma before this \"]\"", "remove the comma"};
    if (what.find("unexpected string literal; expected '}'") != std::string::npos ||
        what.find("expected ']'") != std::string::npos)
        return {"a comma is missing before this", "separate members and elements with commas"};
    if (what.find("expected end of input") != std::string::npos)
        return {"the graph ended before this", "remove what follows the last \"}\""};
    if (what.find("invalid literal") != std::string::npos)
        return {"this is no JSON value",
                "strings and names need double quotes; literals are true, false and null"};
    if (const std::string string_problem = after("invalid string: "); !string_problem.empty())
        return {"this string is broken: " + string_problem.substr(0, string_problem.find("; last")),
                what.find("control character") != std::string::npos
                    ? "is the closing quote missing?"
                    : ""};
    if (const std::string number_problem = after("invalid number; "); !number_problem.empty())
        return {"this number is broken: " + number_problem.substr(0, number_problem.find("; last")),
                ""};
    if (const std::string comment = after("invalid comment; "); !comment.empty())
        return {"this comment is broken: " + comment.substr(0, comment.find("; last")), ""};
    if (what.find("number overflow") != std::string::npos)
        return {"this number is too large", ""};
    if (const std::string unexpected = after("unexpected "); !unexpected.empty())
        return {"this is not expected here: " + unexpected, ""};
    return {"this is not valid JSON", ""};
}

/// Receives the parser's events and builds the tree.
class TreeBuilder : public nlohmann::json_sax<nlohmann::json> {
public:
    TreeBuilder(const SourceText& source, Reporter& reporter, JsonValue& root)
        : source_(&source), reporter_(&reporter), root_(&root), walk_(source.text()) {}

    bool null() override { return leaf(empty(JsonValue::Kind::kNull)); }
    bool boolean(bool flag) override {
        JsonValue value = empty(JsonValue::Kind::kBool);
        value.flag = flag;
        return leaf(std::move(value));
    }
    bool number_integer(std::int64_t number) override {
        return addNumber(static_cast<double>(number));
    }
    bool number_unsigned(std::uint64_t number) override {
        return addNumber(static_cast<double>(number));
    }
    bool number_float(double number, const std::string&) override { return addNumber(number); }
    bool string(std::string& text) override {
        JsonValue value = empty(JsonValue::Kind::kString);
        value.text = std::move(text);
        return leaf(std::move(value));
    }
    bool binary(nlohmann::json::binary_t&) override { return false; }

    bool start_object(std::size_t) override { return open(JsonValue::Kind::kObject); }
    bool end_object() override { return close(); }
    bool start_array(std::size_t) override { return open(JsonValue::Kind::kArray); }
    bool end_array() override { return close(); }

    bool key(std::string& name) override {
        Level& level = levels_.back();
        const TextSpan span = walk_.next();
        const Place place{span, pointerTo(pointer(levels_.size() - 1), name), source_};
        if (name.size() > kMaxName) {
            reporter_->error("E0105", {span, pointer(levels_.size() - 1), source_},
                             "this name has " + std::to_string(name.size()) +
                                 " bytes; a name may have 256");
            return false;
        }
        const auto [first, is_new] = level.keys.emplace(name, span);
        if (!is_new) {
            reporter_->error("E0102", place, "the key \"" + name + "\" is written twice",
                             "remove or rename one of them");
            reporter_->note({first->second, place.pointer, source_}, "the first is here");
        }
        level.key = {std::move(name), span, {}};
        return true;
    }

    bool parse_error(std::size_t position, const std::string&,
                     const nlohmann::detail::exception& problem) override {
        const std::string_view text = source_->text();
        const std::size_t last_read = std::min(position > 0 ? position - 1 : 0, text.size());
        const std::size_t begin = std::min(walk_.peek(), last_read);
        const std::string what = problem.what();
        const bool is_inside_token = what.find("invalid") != std::string::npos;
        const std::size_t place =
            is_inside_token || begin + 1 > text.size() || text[begin] != '"' ? last_read : begin;
        // What stands before the token, comments and spaces apart, tells a trailing comma.
        std::string_view before = text.substr(0, place);
        while (!before.empty() &&
               std::string_view(" \t\r\n").find(before.back()) != std::string_view::npos)
            before.remove_suffix(1);
        const SyntaxError error = explain(what, before);
        reporter_->error("E0101", {{static_cast<std::uint32_t>(place), 1}, "", source_},
                         error.message, error.hint);
        return false;
    }

private:
    struct Level {
        JsonValue value;
        JsonMember key; ///< of the member that is being read
        std::unordered_map<std::string, TextSpan> keys;
    };

    static JsonValue empty(JsonValue::Kind kind) {
        JsonValue value;
        value.kind = kind;
        return value;
    }

    bool addNumber(double number) {
        JsonValue value = empty(JsonValue::Kind::kNumber);
        value.number = number;
        return leaf(std::move(value));
    }

    bool leaf(JsonValue value) {
        value.span = walk_.next();
        return attach(std::move(value));
    }

    bool open(JsonValue::Kind kind) {
        Level& level = levels_.emplace_back();
        level.value.kind = kind;
        level.value.span = walk_.next();
        if (levels_.size() <= kMaxDepth)
            return true;
        reporter_->error("E0103", {level.value.span, "", source_},
                         "this is nested more than 64 levels deep");
        return false;
    }

    bool close() {
        (void)walk_.next();
        JsonValue value = std::move(levels_.back().value);
        levels_.pop_back();
        return attach(std::move(value));
    }

    bool attach(JsonValue value) {
        if (++values_ > kMaxValues) {
            reporter_->error("E0104", {value.span, "", source_},
                             "the file holds more than 262144 values");
            return false;
        }
        if (levels_.empty()) {
            *root_ = std::move(value);
            return true;
        }
        Level& level = levels_.back();
        if (level.value.kind == JsonValue::Kind::kArray) {
            level.value.elements.push_back(std::move(value));
        } else {
            level.key.value = std::move(value);
            level.value.members.push_back(std::move(level.key));
        }
        return true;
    }

    /// JSON pointer of the value on level `count` - 1's inside.
    std::string pointer(std::size_t count) const {
        std::string result;
        for (std::size_t i = 0; i < count; ++i) {
            const Level& level = levels_[i];
            result = pointerTo(result, level.value.kind == JsonValue::Kind::kArray
                                           ? std::to_string(level.value.elements.size())
                                           : level.key.key);
        }
        return result;
    }

    const SourceText* source_;
    Reporter* reporter_;
    JsonValue* root_;
    TokenWalk walk_;
    std::vector<Level> levels_;
    std::size_t values_ = 0;
};

} // namespace

const JsonMember* JsonValue::find(std::string_view key) const {
    const auto found = std::ranges::find(members, key, &JsonMember::key);
    return found != members.end() ? &*found : nullptr;
}

const char* JsonValue::kindName() const {
    switch (kind) {
    case Kind::kNull:
        return "null";
    case Kind::kBool:
        return "a boolean";
    case Kind::kNumber:
        return "a number";
    case Kind::kString:
        return "a string";
    case Kind::kArray:
        return "a list";
    case Kind::kObject:
        return "an object";
    }
    return "?";
}

std::string pointerTo(const std::string& pointer, std::string_view key) {
    std::string result = pointer + "/";
    for (const char c : key) {
        if (c == '~')
            result += "~0";
        else if (c == '/')
            result += "~1";
        else
            result += c;
    }
    return result;
}

bool parseJson(const SourceText& source, Reporter& reporter, JsonValue& root) {
    if (source.text().size() > kMaxBytes) {
        reporter.error("E0104", {},
                       "the file has " + std::to_string(source.text().size()) +
                           " bytes; a graph may have 16 MiB");
        return false;
    }
    TreeBuilder builder(source, reporter, root);
    return nlohmann::json::sax_parse(source.text(), &builder, nlohmann::json::input_format_t::json,
                                     true, true);
}

} // namespace hone

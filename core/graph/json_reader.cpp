// SPDX-License-Identifier: Apache-2.0
#include "hone/core/graph/json_reader.h"

namespace hone {

bool JsonReader::expect(const JsonNode& node, JsonValue::Kind kind, const std::string& what) const {
    if (node.value->kind == kind)
        return true;
    JsonValue wanted;
    wanted.kind = kind;
    reporter_->error("E0202", node.place(),
                     what + " must be " + wanted.kindName() + ", not " + node.value->kindName());
    return false;
}

std::string JsonReader::text(const JsonNode& node, const std::string& what) const {
    return expect(node, JsonValue::Kind::kString, what) ? node.value->text : std::string();
}

Word JsonReader::word(const JsonNode& node, const std::string& what) const {
    if (node.value->kind == JsonValue::Kind::kString && node.value->text.empty())
        reporter_->error("E0202", node.place(), what + " must not be empty");
    return {text(node, what), node.place()};
}

Word JsonReader::name(const JsonNode& parent, const JsonMember& member,
                      const std::string& what) const {
    Word result{member.key, parent.keyPlace(member)};
    const auto is_word = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '_' || c == '-';
    };
    if (member.key.empty() || !std::ranges::all_of(member.key, is_word))
        reporter_->error("E0205", result.place,
                         "\"" + member.key + "\" cannot be the name of " + what,
                         "use letters, digits, \"_\" and \"-\"; \".\", \"$\", \"~\" and \"@\" have "
                         "a meaning in references");
    return result;
}

void JsonReader::unknownKey(const JsonNode& node, const JsonMember& member,
                            const std::vector<std::string>& known, const std::string& what) const {
    reporter_->error("E0201", node.keyPlace(member), what + " has no key \"" + member.key + "\"",
                     suggest(member.key, known, "it has"));
}

const JsonMember* JsonReader::misspelt(const JsonNode& node, const std::string& key,
                                       const std::vector<std::string>& known,
                                       const std::string& what) const {
    for (const JsonMember& member : node.value->members) {
        if (std::ranges::find(known, member.key) != known.end() ||
            nearest(member.key, known) != key)
            continue;
        unknownKey(node, member, known, what);
        return &member;
    }
    return nullptr;
}

} // namespace hone

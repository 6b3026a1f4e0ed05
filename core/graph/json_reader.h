// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/graph/graph_desc.h"
#include "hone/core/graph/json_source.h"

#include <algorithm>
#include <string>
#include <vector>

namespace hone {

/// A JSON value together with where it is.
struct JsonNode {
    const JsonValue* value = nullptr;
    std::string pointer;
    const SourceText* source = nullptr;

    [[nodiscard]] Place place() const { return {value->span, pointer, source}; }
    [[nodiscard]] Place keyPlace(const JsonMember& member) const {
        return {member.key_span, pointerTo(pointer, member.key), source};
    }
    [[nodiscard]] JsonNode child(const JsonMember& member) const {
        return {&member.value, pointerTo(pointer, member.key), source};
    }
    [[nodiscard]] JsonNode child(std::size_t index) const {
        return {&value->elements[index], pointerTo(pointer, std::to_string(index)), source};
    }
};

/// What is read of a JSON value; anything that has no meaning is reported.
class JsonReader {
public:
    explicit JsonReader(Reporter& reporter) : reporter_(&reporter) {}

    bool expect(const JsonNode& node, JsonValue::Kind kind, const std::string& what) const;
    [[nodiscard]] std::string text(const JsonNode& node, const std::string& what) const;
    /// A text that names something, and so must not be empty.
    [[nodiscard]] Word word(const JsonNode& node, const std::string& what) const;
    /// A name given in the file: a word that needs no quoting in references.
    [[nodiscard]] Word name(const JsonNode& parent, const JsonMember& member,
                            const std::string& what) const;
    /// Reports keys of an object that are not in `known`.
    void unknownKey(const JsonNode& node, const JsonMember& member,
                    const std::vector<std::string>& known, const std::string& what) const;
    /// The member whose key was meant to be `key`, which is not there; reported. Null if there is
    /// none.
    const JsonMember* misspelt(const JsonNode& node, const std::string& key,
                               const std::vector<std::string>& known,
                               const std::string& what) const;

    /// Calls `visit` for every member; keys that are not in `known` are errors.
    template <class Visit>
    void forEach(const JsonNode& node, const std::vector<std::string>& known,
                 const std::string& what, const Visit& visit) const {
        for (const JsonMember& member : node.value->members) {
            if (std::ranges::find(known, member.key) != known.end())
                visit(member);
            else
                unknownKey(node, member, known, what);
        }
    }

    [[nodiscard]] Reporter& reporter() const { return *reporter_; }

private:
    Reporter* reporter_;
};

/// Reads a graph parameter's declaration: { "type": "uint", "default": 1, "min": 1, "doc": ... }.
void readGraphParam(const JsonReader& reader, const JsonNode& node, GraphParamDesc& param);

/// The version that a graph says it is of; nothing, with a report, for one that cannot be read.
[[nodiscard]] std::optional<int> readVersion(const JsonReader& reader, const JsonNode& root);

/// How much of a graph was read, against the limits of a hostile file.
struct ReadCounts {
    std::size_t passes = 0;
    std::size_t edges = 0;
};

/// Reads "passes": { ... }, of the graph or of a loop.
void readPasses(const JsonReader& reader, ReadCounts& counts, const JsonNode& node,
                std::vector<PassDesc>& passes);

} // namespace hone

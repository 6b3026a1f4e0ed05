// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/graph/reporter.h"
#include "hone/core/graph/source_text.h"

#include <string>
#include <string_view>
#include <vector>

namespace hone {

struct JsonMember;

/// A JSON value that remembers where it was written. Members keep the order of the file.
struct JsonValue {
    enum class Kind : std::uint8_t { kNull, kBool, kNumber, kString, kArray, kObject };
    Kind kind = Kind::kNull;
    bool flag = false;
    double number = 0;
    std::string text{};
    std::vector<JsonValue> elements{};
    std::vector<JsonMember> members;
    TextSpan span{}; ///< objects and arrays: the opening bracket

    [[nodiscard]] const JsonMember* find(std::string_view key) const;
    /// "a string", "an object": for messages.
    [[nodiscard]] const char* kindName() const;
};

struct JsonMember {
    std::string key;
    TextSpan key_span;
    JsonValue value;
};

/// `pointer` with one more step (RFC 6901: "~" and "/" are escaped).
[[nodiscard]] std::string pointerTo(const std::string& pointer, std::string_view key);

/// Reads JSON (comments allowed) with the limits of a graph file: 16 MiB, depth 64, 2^18 values,
/// names of 256 bytes. Reports syntax errors (E0101), duplicate keys (E0102) and passed limits
/// (E0103, E0104, E0105); returns false if there is no tree to go on with.
[[nodiscard]] bool parseJson(const SourceText& source, Reporter& reporter, JsonValue& root);

} // namespace hone

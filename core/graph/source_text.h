// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace hone {

/// A stretch of a text, in bytes.
struct TextSpan {
    std::uint32_t begin = 0;
    std::uint32_t length = 0;
};

class SourceText;

/// Where something in a graph file was written.
struct Place {
    TextSpan span;
    std::string pointer;                ///< JSON pointer; "" in a shader
    const SourceText* source = nullptr; ///< null: it was never written (an override)
};

/// A file's text with its name, which knows where its lines begin.
class SourceText {
public:
    SourceText() = default;
    /// At most 2^32 - 1 bytes.
    SourceText(std::string file, std::string text);

    struct Position {
        std::size_t line = 1;   ///< from 1
        std::size_t column = 1; ///< from 1, in bytes
    };
    [[nodiscard]] Position locate(std::uint32_t offset) const;
    /// A line without its end, from 1.
    [[nodiscard]] std::string_view line(std::size_t number) const;
    [[nodiscard]] std::size_t lineCount() const { return line_begins_.size(); }
    /// Offset of a line's first byte; lines count from 1.
    [[nodiscard]] std::uint32_t begin(std::size_t number) const { return line_begins_[number - 1]; }
    [[nodiscard]] const std::string& file() const { return file_; }
    [[nodiscard]] const std::string& text() const { return text_; }

private:
    std::string file_;
    std::string text_;
    std::vector<std::uint32_t> line_begins_{0};
};

} // namespace hone

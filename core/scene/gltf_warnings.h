// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace hone {

/// Warnings about one file, each kind once: "NAME: WHAT: first (and 8 more)".
class GltfWarnings {
public:
    explicit GltfWarnings(std::string file) : file_(std::move(file)) {}

    void add(const std::string& what, const std::string& subject) {
        for (Entry& entry : entries_)
            if (entry.what == what) {
                ++entry.count;
                return;
            }
        entries_.push_back({what, subject, 1});
    }

    [[nodiscard]] std::vector<std::string> texts() const {
        std::vector<std::string> texts;
        for (const Entry& entry : entries_)
            texts.push_back(
                file_ + ": " + entry.what + ": " + entry.first +
                (entry.count == 1 ? "" : " (and " + std::to_string(entry.count - 1) + " more)"));
        return texts;
    }

private:
    struct Entry {
        std::string what;
        std::string first;
        std::size_t count;
    };
    std::string file_;
    std::vector<Entry> entries_;
};

} // namespace hone

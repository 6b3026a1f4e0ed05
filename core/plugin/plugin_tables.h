// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace hone {

/// Why a plug-in is refused; who loads it adds which plug-in.
struct Refusal : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// What follows throws Refusal that begins with `what`: "its name", "its pass \"blur\": doc".

/// A text of a table: there, not empty, not long, printable.
[[nodiscard]] std::string textOf(const char* text, const std::string& what);
/// The same where NULL stands for "".
[[nodiscard]] std::string optionalTextOf(const char* text, const std::string& what);

/// What is to be typed into graphs: a-z, 0-9, "_" and ".", a letter first, not "auto".
[[nodiscard]] std::string nameOf(const char* text, const std::string& what);
/// A name that stands behind a dot: without one.
[[nodiscard]] std::string memberNameOf(const char* text, const std::string& what);

/// Text of a plug-in in a sentence.
[[nodiscard]] std::string inQuotes(std::string_view text);

/// The limits that a table's HONE_HAS_... flags say it has: finite, in order.
struct TableRange {
    std::optional<double> min, max;
};
[[nodiscard]] TableRange rangeOf(std::uint32_t flags, double min, double max,
                                 const std::string& what);

/// No bits that mean nothing, unless a newer minor version may have given them a meaning.
void checkFlags(std::uint32_t flags, std::uint32_t known, std::uint32_t abi_minor,
                const std::string& what);

/// `kind`: "inputs".
template <class Declared>
void checkIsNew(const std::vector<Declared>& others, const std::string& name,
                const std::string& what, const char* kind) {
    if (std::ranges::find(others, name, &Declared::name) != others.end())
        throw Refusal(what + " has two " + kind + " called " + inQuotes(name));
}

template <class Function> void require(Function function, const std::string& what) {
    if (function == nullptr)
        throw Refusal(what + " is missing (NULL)");
}

/// The table as this hone knows it: members that the plug-in does not have are 0, members that hone
/// does not know are left out. `least_bytes`: what its first version had.
template <class Table>
[[nodiscard]] Table copyTable(const Table& table, std::size_t least_bytes,
                              const std::string& what) {
    if (table.struct_size < least_bytes)
        throw Refusal(what + " is short: struct_size is " + std::to_string(table.struct_size) +
                      ", at least " + std::to_string(least_bytes) + " is expected");
    Table copy{};
    std::memcpy(&copy, &table, std::min<std::size_t>(table.struct_size, sizeof copy));
    return copy;
}

/// Calls read(entry, number) for every entry of a list of pointers, which may be NULL where it is
/// empty. `what`: "its list of passes"; `one`: "its pass".
template <class Table, class Read>
void readList(const Table* const* list, std::size_t count, std::size_t most,
              const std::string& what, const std::string& one, const Read& read) {
    if (count > most)
        throw Refusal(what + " has " + std::to_string(count) + " entries; at most " +
                      std::to_string(most) + " are believed");
    if (count > 0)
        require(list, what);
    for (std::size_t i = 0; i < count; ++i) {
        require(list[i], one + " " + std::to_string(i));
        read(*list[i], i);
    }
}

} // namespace hone

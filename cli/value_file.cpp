// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/value_file.h"

#include <charconv>
#include <cstring>
#include <sstream>

namespace hone::cli {
namespace {

enum class Number : std::uint8_t { kFloat, kUint, kInt };

/// One number of an element.
struct Column {
    std::string name;
    Number number;
};

/// What the numbers of an element are: by the type's format, and by name where one format does not
/// tell all.
std::vector<Column> columnsOf(const PortType& type) {
    constexpr Number kFloat = Number::kFloat;
    constexpr Number kUint = Number::kUint;
    if (type == types::kError)
        return {{"expect", kFloat}, {"bound", kFloat}};
    if (type == types::kHits)
        return {{"instance", kUint}, {"primitive", kUint}};
    if (type == types::kAccumulation)
        return {{"R", kFloat}, {"G", kFloat}, {"B", kFloat}, {"samples", kUint}};
    if (type == types::kSamples)
        return {{"R", kFloat}, {"G", kFloat}, {"B", kFloat}, {"pixel", kUint}};
    if (type == types::kRequestList)
        return {{"pixel", kUint}, {"first_sample", kUint}, {"samples", kUint}};
    if (type == types::kPixelList)
        return {{"pixel", kUint}};
    const Number number = type.format.starts_with('u')   ? kUint
                          : type.format.starts_with('i') ? Number::kInt
                                                         : kFloat;
    std::vector<Column> columns;
    const std::size_t count = type.stride / 4;
    for (std::size_t i = 0; i < count; ++i)
        columns.push_back({count > 4 ? "c" + std::to_string(i)
                           : count == 1 && type.shape != Shape::kPlane
                               ? "value"
                               : usualChannelNames(count)[i],
                           number});
    return columns;
}

template <class T> T wordOf(const std::byte* bytes) {
    T word;
    std::memcpy(&word, bytes, sizeof word);
    return word;
}

template <class T> void append(std::string& text, T number) {
    char digits[32];
    const auto [end, error] = std::to_chars(digits, std::end(digits), number);
    text.append(digits, end);
}

std::string toCsv(const Curve& curve) {
    std::ostringstream text;
    text << "iteration,pixels,rays,ms,worst_expect\n";
    for (const LoopRecord& record : curve.records)
        text << record.iteration << ',' << record.pixels << ',' << record.rays << ',' << record.ms
             << ',' << record.worst_expect << '\n';
    return text.str();
}

} // namespace

ImageLayer toLayer(const std::string& name, const Value& value) {
    const std::vector<Column> columns = columnsOf(*value.type);
    ImageLayer layer{name, {}, {}};
    for (const Column& column : columns)
        layer.channel_names.push_back(column.name);
    layer.values.reserve(value.count * columns.size());
    for (std::size_t i = 0; i < value.count; ++i) {
        const std::byte* word = value.buffer.data + i * value.type->stride;
        for (const Column& column : columns) {
            layer.values.push_back(column.number == Number::kFloat ? wordOf<float>(word)
                                   : column.number == Number::kUint
                                       ? static_cast<float>(wordOf<uint>(word))
                                       : static_cast<float>(wordOf<int>(word)));
            word += sizeof(float);
        }
    }
    return layer;
}

std::string toCsv(const Value& value) {
    if (value.curve != nullptr)
        return toCsv(*value.curve);
    const std::vector<Column> columns = columnsOf(*value.type);
    std::string text;
    for (const Column& column : columns)
        text += (text.empty() ? "" : ",") + column.name;
    text += '\n';
    for (std::size_t i = 0; i < value.count; ++i) {
        const std::byte* word = value.buffer.data + i * value.type->stride;
        for (std::size_t c = 0; c < columns.size(); ++c, word += sizeof(float)) {
            if (c > 0)
                text += ',';
            if (columns[c].number == Number::kFloat)
                append(text, wordOf<float>(word));
            else if (columns[c].number == Number::kUint)
                append(text, wordOf<uint>(word));
            else
                append(text, wordOf<int>(word));
        }
        text += '\n';
    }
    return text;
}

} // namespace hone::cli

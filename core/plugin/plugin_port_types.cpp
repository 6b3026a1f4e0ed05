// SPDX-License-Identifier: Apache-2.0
#include "hone/core/plugin/plugin_pass_tables.h"

#include "hone/core/plugin/plugin_tables.h"

#include <array>
#include <limits>

namespace hone {
namespace {

constexpr std::size_t kMostTypes = 256;
constexpr std::uint32_t kMostBytes = 1024; // of an element

struct Format {
    const char* name;
    std::uint32_t bytes;
    bool is_float;
};
constexpr std::array kFormats{
    Format{"float", 4, true},   Format{"vec2", 8, true},    Format{"vec3", 12, true},
    Format{"vec4", 16, true},   Format{"uint", 4, false},   Format{"uvec2", 8, false},
    Format{"uvec3", 12, false}, Format{"uvec4", 16, false}, Format{"int", 4, false},
    Format{"ivec2", 8, false},  Format{"ivec3", 12, false}, Format{"ivec4", 16, false}};

void checkFormat(const std::string& format, const hone_port_type& table, const std::string& what) {
    const bool has_range = (table.flags & (HONE_HAS_MIN | HONE_HAS_MAX)) != 0;
    const auto found = std::ranges::find(kFormats, format, &Format::name);
    if (!format.empty() && found == kFormats.end())
        throw Refusal(what + ": format " + inQuotes(format) +
                      " is none; use float, uint or int, vec2 to vec4, uvec2 … or ivec2 …");
    if (!format.empty() && found->bytes != table.stride)
        throw Refusal(what + ": stride is " + std::to_string(table.stride) + ", but a " + format +
                      " has " + std::to_string(found->bytes) + " bytes");
    if (has_range && (format.empty() || !found->is_float))
        throw Refusal(what + ": only formats float, vec2, vec3 and vec4 have a range");
}

std::string typeNameOf(const char* text, const std::string& what) {
    std::string name = textOf(text, what);
    const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    if (name.size() > 64 || name.front() < 'A' || name.front() > 'Z' ||
        !std::ranges::all_of(name, [&](char c) { return is_letter(c) || (c >= '0' && c <= '9'); }))
        throw Refusal(what + " " + inQuotes(name) +
                      " is no name of a type: use letters and digits, one of A-Z first, at most 64 "
                      "bytes");
    return name;
}

Shape shapeOf(std::uint32_t shape, const std::string& what) {
    switch (shape) {
    case HONE_SHAPE_PLANE:
        return Shape::kPlane;
    case HONE_SHAPE_LIST:
        return Shape::kList;
    case HONE_SHAPE_RECORD:
        return Shape::kRecord;
    default:
        throw Refusal(what + ": shape " + std::to_string(shape) +
                      " is none; use HONE_SHAPE_PLANE, _LIST or _RECORD");
    }
}

void readPortType(const hone_port_type& offered, std::size_t index, PluginLibrary& library) {
    std::string what = "port type " + std::to_string(index);
    const hone_port_type table =
        copyTable(offered, sizeof(hone_port_type), "the table of its " + what);
    PluginPortType texts;
    texts.name = typeNameOf(table.name, "the name of its " + what);
    what = "its port type " + inQuotes(texts.name);
    texts.doc = textOf(table.doc, what + ": doc");
    texts.format = optionalTextOf(table.format, what + ": format");
    texts.unit = optionalTextOf(table.unit, what + ": unit");
    const Shape shape = shapeOf(table.shape, what);
    if (table.stride == 0 || table.stride % 4 != 0 || table.stride > kMostBytes)
        throw Refusal(what + ": stride " + std::to_string(table.stride) +
                      " is none: an element has a multiple of 4 bytes, at most " +
                      std::to_string(kMostBytes));
    checkFlags(table.flags, HONE_HAS_MIN | HONE_HAS_MAX, library.info.abi_minor, what);
    checkFormat(texts.format, table, what);
    const TableRange range = rangeOf(table.flags, table.min, table.max, what);
    for (const PluginPortType& other : library.port_types)
        if (other.name == texts.name)
            throw Refusal("it has two port types called " + inQuotes(texts.name));
    if (const PortType* own = findOwnType(texts.name);
        own != nullptr && (own->shape != shape || own->stride != table.stride))
        throw Refusal(what + " has the name of one of hone's, whose elements lie otherwise");

    PluginPortType& kept = library.port_types.emplace_back(std::move(texts));
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    kept.type = {.name = kept.name,
                 .shape = shape,
                 .stride = table.stride,
                 .doc = kept.doc,
                 .format = kept.format,
                 .unit = kept.unit,
                 .min = static_cast<float>(range.min.value_or(-kInfinity)),
                 .max = static_cast<float>(range.max.value_or(kInfinity))};
}

} // namespace

const PortType* findOwnType(std::string_view name) {
    const auto found = std::ranges::find(types::kAll, name, &PortType::name);
    return found != std::end(types::kAll) ? &*found : nullptr;
}

void readPortTypes(const hone_plugin& plugin, PluginLibrary& library) {
    readList(plugin.port_types, plugin.port_type_count, kMostTypes, "its list of port types",
             "its port type",
             [&](const hone_port_type& type, std::size_t i) { readPortType(type, i, library); });
}

} // namespace hone

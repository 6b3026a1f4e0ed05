// SPDX-License-Identifier: Apache-2.0
//
// Declarations of graph parameters.
#include "hone/core/graph/json_reader.h"

#include <cmath>
#include <limits>

namespace hone {
namespace {

using Kind = JsonValue::Kind;

void readType(const JsonReader& reader, const JsonNode& node, GraphParamDesc& param) {
    const JsonMember* member = node.value->find("type");
    if (member == nullptr) {
        reader.reporter().error("E0203", node.place(),
                                "parameter \"" + param.decl.name + "\" has no \"type\"",
                                "add \"type\": \"bool\", \"uint\", \"float\" or \"enum\"");
        return;
    }
    const std::string type = reader.text(node.child(*member), "a parameter's type");
    for (const ParamType candidate :
         {ParamType::kBool, ParamType::kUint, ParamType::kFloat, ParamType::kEnum})
        if (type == name(candidate)) {
            param.decl.type = candidate;
            return;
        }
    if (member->value.kind == Kind::kString)
        reader.reporter().error("E0507", node.child(*member).place(),
                                "there is no parameter type \"" + type + "\"",
                                suggest(type, {"bool", "uint", "float", "enum"}, "there are"));
}

void readChoicesSource(const JsonReader& reader, const JsonNode& node, ParamDecl& decl) {
    const std::string source = reader.text(node, "\"from\"");
    decl.from_trace_backends = source == "trace_backends";
    if (!decl.from_trace_backends && node.value->kind == Kind::kString)
        reader.reporter().error("E0507", node.place(),
                                "choices cannot come from \"" + source + "\"",
                                "write \"trace_backends\", or list them under \"choices\"");
}

void readDefault(const JsonReader& reader, const JsonNode& node, ParamDecl& decl) {
    const double number = node.value->number;
    if (decl.type == ParamType::kBool && reader.expect(node, Kind::kBool, "a bool's default"))
        decl.fallback = node.value->flag;
    else if (decl.type == ParamType::kEnum &&
             reader.expect(node, Kind::kString, "an enum's default"))
        decl.fallback = node.value->text;
    else if (decl.type == ParamType::kFloat &&
             reader.expect(node, Kind::kNumber, "a float's default"))
        decl.fallback = static_cast<float>(number);
    else if (decl.type == ParamType::kUint &&
             reader.expect(node, Kind::kNumber, "a uint's default")) {
        if (number == std::floor(number) && number >= 0 &&
            number <= std::numeric_limits<uint>::max())
            decl.fallback = static_cast<uint>(number);
        else
            reader.reporter().error("E0502", node.place(),
                                    "parameter \"" + decl.name +
                                        "\" is a uint: a whole number from 0 to 4294967295");
    }
}

} // namespace

void readGraphParam(const JsonReader& reader, const JsonNode& node, GraphParamDesc& param) {
    param.default_place = node.place();
    if (!reader.expect(node, Kind::kObject, "a parameter's declaration"))
        return;
    readType(reader, node, param);
    ParamDecl& decl = param.decl;
    bool has_default = false;
    reader.forEach(
        node, {"type", "from", "default", "min", "max", "unit", "choices", "doc"}, "a parameter",
        [&](const JsonMember& member) {
            const JsonNode child = node.child(member);
            if (member.key == "doc")
                decl.doc = reader.text(child, "a parameter's documentation");
            else if (member.key == "unit")
                decl.unit = reader.text(child, "a parameter's unit");
            else if (member.key == "min" && reader.expect(child, Kind::kNumber, "\"min\""))
                decl.min = child.value->number;
            else if (member.key == "max" && reader.expect(child, Kind::kNumber, "\"max\""))
                decl.max = child.value->number;
            else if (member.key == "choices" && reader.expect(child, Kind::kArray, "\"choices\""))
                for (std::size_t i = 0; i < child.value->elements.size(); ++i)
                    decl.choices.push_back(reader.text(child.child(i), "a choice"));
            else if (member.key == "from")
                readChoicesSource(reader, child, decl);
            else if (member.key == "default") {
                has_default = true;
                param.default_place = child.place();
                readDefault(reader, child, decl);
            }
        });
    if (!has_default)
        reader.reporter().error("E0203", node.place(),
                                "parameter \"" + decl.name + "\" has no \"default\"",
                                "add one: a graph must run without being told anything");
    if (decl.type == ParamType::kEnum && decl.choices.empty() && !decl.from_trace_backends)
        reader.reporter().error("E0203", node.place(),
                                "parameter \"" + decl.name + "\" is an enum without choices",
                                "add \"choices\": [\"...\"], or \"from\": \"trace_backends\"");
}

} // namespace hone

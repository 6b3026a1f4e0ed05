// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/pass_schema.h"

#include "hone/core/graph/parameters.h"

#include <limits>

namespace hone::cli {
namespace {

using Json = nlohmann::ordered_json;

std::string docOf(const ParamDecl& decl) {
    return decl.doc + (decl.unit.empty() ? "" : " [" + decl.unit + "]");
}

Json toJson(const ParamValue& value) {
    return std::visit([](const auto& known) { return Json(known); }, value);
}

/// Backends come from plug-ins, too: any name may be one.
Json backendSchema(const ParamDecl& decl, const Catalog& catalog) {
    const std::string name = "[A-Za-z_][A-Za-z0-9_.-]*";
    return {{"anyOf",
             {{{"enum", choicesOf(decl, catalog)}},
              textLike(name),
              textLike("check\\( *(" + name + ")( *, *" + name + ")? *\\)")}}};
}

Json literalSchema(const ParamDecl& decl, const Catalog& catalog) {
    if (decl.type == ParamType::kBool)
        return {{"type", "boolean"}};
    if (decl.type == ParamType::kEnum)
        return decl.from_trace_backends ? backendSchema(decl, catalog)
                                        : Json{{"enum", decl.choices}};
    // What is beyond the type's own range is refused as well.
    const bool is_uint = decl.type == ParamType::kUint;
    const double most = is_uint ? std::numeric_limits<uint>::max()
                                : static_cast<double>(std::numeric_limits<float>::max());
    return {{"type", is_uint ? "integer" : "number"},
            {"minimum", decl.min.value_or(is_uint ? 0 : -most)},
            {"maximum", decl.max.value_or(most)}};
}

/// "in": the type's inputs, those that must be fed required.
Json inputsSchema(const PassType& type, const Catalog& catalog) {
    Json ports = Json::object();
    Json required = Json::array();
    for (const InPort& port : type.inputs) {
        Json edge =
            port.edge_params.empty() ? refTo("edge") : edgeSchema(port.edge_params, catalog);
        Json schema{{"description", port.doc + "\n" + describe(port.type)}};
        if (port.variadic) {
            Json list{{"type", "array"}, {"items", edge}, {"maxItems", InPort::kMaxEdges}};
            if (!port.optional)
                list["minItems"] = 1;
            schema["anyOf"] = Json::array({list, edge});
        } else {
            schema["allOf"] = Json::array({edge});
        }
        ports[port.name] = std::move(schema);
        if (!port.optional)
            required.push_back(port.name);
    }
    Json result{{"type", "object"}, {"properties", ports}, {"additionalProperties", false}};
    if (!required.empty())
        result["required"] = required;
    return result;
}

Json paramsSchema(const std::vector<ParamDecl>& decls, const Catalog& catalog) {
    Json params = Json::object();
    for (const ParamDecl& decl : decls)
        params[decl.name] = paramSchema(decl, catalog);
    return {{"type", "object"}, {"properties", params}, {"additionalProperties", false}};
}

} // namespace

Json refTo(const std::string& definition) {
    return {{"$ref", "#/definitions/" + definition}};
}

Json textLike(const std::string& expression) {
    return {{"type", "string"}, {"pattern", "^" + expression + "$"}};
}

Json paramSchema(const ParamDecl& decl, const Catalog& catalog) {
    return {{"description", docOf(decl)},
            {"default", toJson(decl.fallback)},
            {"anyOf", {literalSchema(decl, catalog), refTo("parameter_reference")}}};
}

Json edgeSchema(const std::vector<ParamDecl>& params, const Catalog& catalog) {
    Json properties{{"from", refTo("source_or_history")}, {"initial", refTo("initial")}};
    for (const ParamDecl& decl : params)
        properties[decl.name] = paramSchema(decl, catalog);
    // A value of the last frame needs one for the first, and no other value has one.
    return {{"anyOf",
             {refTo("source"),
              {{"type", "object"},
               {"properties", properties},
               {"required", {"from"}},
               {"additionalProperties", false},
               {"if", {{"required", {"initial"}}}},
               {"then", {{"properties", {{"from", refTo("history")}}}}},
               {"else", {{"properties", {{"from", refTo("source")}}}}}}}}};
}

Json passSchema(const PassType& type, const Catalog& catalog) {
    Json places = Json::array();
    if (type.domain != Domain::kDevice)
        places.push_back("host");
    if (type.domain != Domain::kHost)
        places.push_back("device");
    places.push_back("auto");
    Json result{{"properties",
                 {{"in", inputsSchema(type, catalog)},
                  {"params", paramsSchema(type.params, catalog)},
                  {"on", {{"enum", places}}}}}};
    if (std::ranges::any_of(type.inputs, [](const InPort& port) { return !port.optional; }))
        result["required"] = Json::array({"in"});
    return result;
}

} // namespace hone::cli

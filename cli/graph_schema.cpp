// SPDX-License-Identifier: Apache-2.0
//
// The grammar of graph files. An object with keys of its own is object(); a map from names that the
// author chooses is named().
#include "hone/cli/graph_schema.h"

#include "hone/cli/pass_schema.h"

#include <limits>

namespace hone::cli {
namespace {

using Json = nlohmann::ordered_json;

Json described(std::string doc, Json schema) {
    Json result{{"description", std::move(doc)}};
    result.update(schema);
    return result;
}

/// Where a value comes from. `$ref` stands alone in draft 07: what is beside it does not count.
Json source(std::string doc) {
    return described(std::move(doc), Json{{"allOf", Json::array({refTo("source")})}});
}

Json text(std::string doc) {
    return described(std::move(doc), Json{{"type", "string"}});
}

/// An object with these keys, `required` among them.
Json object(Json properties, Json required = Json::array()) {
    Json result{
        {"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
    if (!required.empty())
        result["required"] = std::move(required);
    return result;
}

/// An object whose keys are names that the author gives.
Json named(Json value) {
    return {{"type", "object"},
            {"propertyNames", {{"pattern", "^" + pattern::kName + "$"}, {"maxLength", 256}}},
            {"additionalProperties", std::move(value)}};
}

Json when(const char* key, Json value, Json then) {
    return {{"if", {{"properties", {{key, {{"const", std::move(value)}}}}}, {"required", {key}}}},
            {"then", std::move(then)}};
}

/// A graph parameter's declaration; its type says what "default" is.
Json declarationSchema() {
    const double most = std::numeric_limits<float>::max();
    const auto fallback = [](Json schema) { return Json{{"properties", {{"default", schema}}}}; };
    Json result =
        object({{"type", {{"enum", {"bool", "uint", "float", "enum"}}}},
                {"default", Json{{"description", "the value where nobody sets another"}}},
                {"min", described("the least value allowed", Json{{"type", "number"}})},
                {"max", described("the greatest value allowed", Json{{"type", "number"}})},
                {"unit", text("of its value: \"px\", \"ms\"")},
                {"choices", {{"type", "array"}, {"items", {{"type", "string"}}}}},
                {"from", described("choices of an enum that the program knows",
                                   Json{{"const", "trace_backends"}})},
                {"doc", text("what it does, and what special values mean")}},
               {"type", "default"});
    result["allOf"] = {
        when("type", "bool", fallback({{"type", "boolean"}})),
        when("type", "uint",
             fallback({{"type", "integer"},
                       {"minimum", 0},
                       {"maximum", std::numeric_limits<uint>::max()}})),
        when("type", "float",
             fallback({{"type", "number"}, {"minimum", -most}, {"maximum", most}})),
        when("type", "enum",
             {{"properties", {{"default", {{"type", "string"}}}}},
              {"anyOf",
               {{{"required", {"choices"}}, {"properties", {{"choices", {{"minItems", 1}}}}}},
                {{"required", {"from"}}}}}})};
    return result;
}

Json whenSchema() {
    const std::string reference = "\\$" + pattern::kName;
    const Json choices = {{"anyOf",
                           {{{"type", "string"}, {"minLength", 1}},
                            {{"type", "array"},
                             {"items", {{"type", "string"}, {"minLength", 1}}},
                             {"minItems", 1}}}}};
    return described("runs only if a parameter of the graph says so: \"$flag\", \"!$flag\" or "
                     "{\"$mode\": [\"choice\", ...]}",
                     Json{{"anyOf",
                           {textLike("!?" + reference),
                            {{"type", "object"},
                             {"minProperties", 1},
                             {"maxProperties", 1},
                             {"propertyNames", {{"pattern", "^" + reference + "$"}}},
                             {"additionalProperties", choices}}}}});
}

/// What passes of every kind may say.
Json common(Json properties) {
    properties["doc"] = text("what it is for");
    properties["when"] = whenSchema();
    properties["bypass"] = described(
        "by output: what stands in for it where \"when\" switches the pass off",
        Json{{"type", "object"},
             {"additionalProperties",
              {{"anyOf", {refTo("source"), object({{"from", refTo("source")}}, {"from"})}}}}});
    return properties;
}

/// A pass whose ports the schema does not know: of a shader, of another graph.
Json openInputs() {
    const Json edge = {
        {"anyOf",
         {refTo("source"),
          {{"type", "object"},
           {"properties", {{"from", refTo("source_or_history")}, {"initial", refTo("initial")}}},
           {"required", {"from"}},
           {"additionalProperties", refTo("literal")}}}}};
    return {{"type", "object"},
            {"additionalProperties", {{"anyOf", {edge, {{"type", "array"}, {"items", edge}}}}}}};
}

Json openParams() {
    return {{"type", "object"}, {"additionalProperties", refTo("literal")}};
}

Json typedPassSchema(const Catalog& catalog) {
    Json types = Json::array();
    Json docs = Json::array();
    Json rules = Json::array();
    for (const PassType& type : catalog.passes->all()) {
        types.push_back(type.name);
        docs.push_back(type.doc);
        rules.push_back(when("type", type.name, refTo("pass." + type.name)));
    }
    types.push_back("glsl");
    docs.push_back("a shader file beside the graph is the pass");
    Json glsl = when("type", "glsl",
                     {{"properties", {{"in", openInputs()}, {"params", openParams()}}},
                      {"required", {"shader"}}});
    glsl["else"] = {{"not", {{"required", {"shader"}}}}};
    rules.push_back(std::move(glsl));
    Json result = object(
        common(
            {{"type",
              {{"description", "which pass it is; hone passes lists them"},
               {"enum", types},
               {"enumDescriptions", docs}}},
             {"in", described("by input: where its value comes from", Json{{"type", "object"}})},
             {"params", described("by parameter: its value, or \"$name\" for that of a "
                                  "parameter of the graph",
                                  Json{{"type", "object"}})},
             {"on", described("where its kernels run", Json{{"enum", {"host", "device", "auto"}}})},
             {"shader", described("file of a pass of type \"glsl\", in the graph's folder",
                                  Json{{"type", "string"}, {"minLength", 1}})}}),
        {"type"});
    result["allOf"] = std::move(rules);
    return result;
}

Json graphPassSchema() {
    return object(
        common({{"graph", described("file of a graph, in this one's folder, that is used as a pass",
                                    Json{{"type", "string"}, {"minLength", 1}})},
                {"in", openInputs()},
                {"params", openParams()}}),
        {"graph"});
}

/// Rules that end a loop whatever its passes do.
Json limitSchema(const char* doc) {
    const double most = std::numeric_limits<float>::max();
    return described(doc, Json{{"anyOf",
                                {{{"type", "number"}, {"minimum", 0}, {"maximum", most}},
                                 refTo("parameter_reference")}}});
}

Json stopSchema() {
    Json bounds = Json::array();
    for (const char* rule : {"iterations", "rays", "ms"})
        bounds.push_back(
            {{"required", {rule}}, {"properties", {{rule, {{"not", {{"const", 0}}}}}}}});
    const Json rule = {
        {"if", {{"required", {"below"}}}},
        {"then", object({{"below", limitSchema("ends the loop when \"of\" is below it")},
                         {"of", source("an output of type Scalar")}},
                        {"below", "of"})},
        {"else", object({{"empty", source("ends the loop when this list is empty")},
                         {"below", Json{{"description", "ends the loop when \"of\" is below it"}}},
                         {"iterations", limitSchema("ends the loop after so many; 0 = no limit")},
                         {"rays", limitSchema("ends the loop after so many rays; 0 = no limit")},
                         {"ms", limitSchema("ends the loop after so long; 0 = no limit")}})},
        {"type", "object"}};
    return {{"description", "the loop ends when one of these holds; one must be a limit above 0"},
            {"type", "array"},
            {"items", rule},
            {"contains", {{"type", "object"}, {"anyOf", bounds}}}};
}

Json loopPassSchema() {
    Json carry = named(refTo("carried_value"));
    carry["propertyNames"]["not"] = {{"const", "stats"}};
    const Json body = object(
        {{"carry", described("values that go from iteration to iteration, and what they begin "
                             "with; inside \"~name\", afterwards the loop's outputs",
                             carry)},
         {"passes", named(refTo("pass"))},
         {"next", described("by carried value: what it is in the next iteration",
                            Json{{"type", "object"}, {"additionalProperties", refTo("source")}})},
         {"stop", stopSchema()},
         {"check_every",
          described(
              "iterations from one look at the stop rules to the next",
              Json{{"type", "integer"}, {"minimum", 1}, {"maximum", 1000000}, {"default", 1}})}},
        {"stop"});
    return object(common({{"loop", body}}), {"loop"});
}

/// Which kind of pass it is shows in one key; "properties" is what an editor offers before that.
Json passKindsSchema() {
    const auto kind = [](const char* key, Json otherwise) {
        return Json{{"if", {{"required", {key}}}},
                    {"then", refTo(std::string(key) + "_pass")},
                    {"else", std::move(otherwise)}};
    };
    Json result{{"type", "object"},
                {"properties",
                 {{"type", Json{{"description", "a pass: which"}}},
                  {"loop", Json{{"description", "a loop: passes that run again and again"}}},
                  {"graph", Json{{"description", "a graph of another file, used as a pass"}}}}}};
    result.update(kind("loop", kind("graph", refTo("typed_pass"))));
    return result;
}

void addWords(Json& definitions, const Catalog& catalog) {
    definitions["source"] =
        described("\"pass.output\", \"loop.value\", \"$input\" or, in a loop, \"~carried\"",
                  textLike(pattern::kSource));
    definitions["history"] = described("\"pass.output@-1\": its value of the last frame",
                                       textLike(pattern::kSource + "@-1"));
    definitions["source_or_history"] =
        described("\"pass.output\", or \"pass.output@-1\" for its value of the last frame",
                  textLike(pattern::kSource + "(@-1)?"));
    definitions["parameter_reference"] =
        described("the value of a parameter of the graph", textLike("\\$" + pattern::kName));
    definitions["literal"] = {{"type", {"boolean", "number", "string"}}};

    Json filled = Json::array(); // types that can be made of zeroes
    for (const PortType& type : graphTypes(*catalog.passes))
        if (type.stride != 0)
            filled.push_back(type.name);
    const Json zero =
        object({{"zero", described("zeroes of this type", Json{{"enum", filled}})}}, {"zero"});
    definitions["initial"] = described(
        "what it is in the first frame",
        Json{{"anyOf", {refTo("source"), object({{"from", refTo("source")}}, {"from"}), zero}}});
    definitions["edge"] = edgeSchema({}, catalog);
    definitions["carried_value"] = {{"anyOf", {refTo("edge"), zero}}};
}

} // namespace

Json graphSchema(const Catalog& catalog) {
    Json types = Json::array({"scene", "camera", "extent"});
    for (const PortType& type : graphTypes(*catalog.passes))
        types.push_back(type.name);
    const Json output = {
        {"anyOf",
         {refTo("source"),
          object({{"from", refTo("source")},
                  {"type", described("what it is, checked", Json{{"enum", types}})},
                  {"doc", text("what it shows")}},
                 {"from"})}}};
    Json outputs = named(output);
    Json versions = Json::array(); // the present one first: editors offer it first
    for (int version = kGraphVersion; version >= 1; --version)
        versions.push_back(version);
    outputs["minProperties"] = 1;
    const Json plugin = {{"type", "array"}, {"items", {{"type", "string"}, {"minLength", 1}}}};

    Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"},
                {"title", "hone graph"},
                {"description", "A render graph: passes, the edges between them, and the outputs "
                                "that are asked for."},
                {"allowComments", true}};
    schema.update(
        object({{"$schema", text("this file, for editors")},
                {"hone", described("version of the graph language", Json{{"enum", versions}})},
                {"name", text("the file's name without .json, as a rule")},
                {"doc", text("what the graph does")},
                {"plugins", described("by plug-in: the pass types that the graph takes from it",
                                      Json{{"type", "object"}, {"additionalProperties", plugin}})},
                {"params", described("what can be set from outside; passes take it as \"$name\"",
                                     named(refTo("declaration")))},
                {"inputs", described("what the graph is given; passes take it as \"$name\"",
                                     named({{"enum", types}}))},
                {"passes", described("by name; their order does not matter", named(refTo("pass")))},
                {"outputs",
                 described("what is asked for; passes that no output needs do not run", outputs)},
                {"meta", Json{{"description", "for editors; not read"}}}},
               {"hone", "outputs"}));

    Json& definitions = schema["definitions"];
    addWords(definitions, catalog);
    definitions["declaration"] = declarationSchema();
    definitions["pass"] = passKindsSchema();
    definitions["typed_pass"] = typedPassSchema(catalog);
    definitions["loop_pass"] = loopPassSchema();
    definitions["graph_pass"] = graphPassSchema();
    for (const PassType& type : catalog.passes->all())
        definitions["pass." + type.name] = passSchema(type, catalog);
    return schema;
}

} // namespace hone::cli

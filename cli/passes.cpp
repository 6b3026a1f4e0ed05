// SPDX-License-Identifier: Apache-2.0
//
// hone passes: what passes there are and how each is wired, from their declarations.
#include "hone/cli/commands.h"
#include "hone/cli/json.h"
#include "hone/cli/session.h"

#include "hone/core/graph/diagnostics.h"

#include <iomanip>
#include <ostream>

namespace hone::cli {
namespace {

using Json = nlohmann::ordered_json;

std::string rangeOf(const ParamDecl& decl, const Session& session) {
    if (decl.type == ParamType::kEnum) {
        std::vector<std::string> choices = decl.choices;
        if (decl.from_trace_backends)
            for (const std::string& name : session.traceBackends().names())
                choices.push_back(name);
        std::string text;
        for (const std::string& choice : choices)
            text += (text.empty() ? "" : " | ") + choice;
        return text;
    }
    std::string text = name(decl.type);
    const auto number = [](double value) {
        return toString(ParamValue(static_cast<float>(value)));
    };
    if (decl.min)
        text += " >= " + number(*decl.min);
    if (decl.max)
        text += std::string(decl.min ? "," : "") + " <= " + number(*decl.max);
    return text;
}

Json describe(const PassType& type, const Session& session) {
    Json inputs = Json::array(), outputs = Json::array(), params = Json::array();
    Json promises = Json::array();
    for (const InPort& port : type.inputs)
        inputs.push_back({{"name", port.name},
                          {"type", port.type.name},
                          {"optional", port.optional},
                          {"variadic", port.variadic},
                          {"doc", port.doc}});
    for (const OutPort& port : type.outputs)
        outputs.push_back({{"name", port.name},
                           {"type", port.type.name},
                           {"in_place_of", port.in_place_of},
                           {"doc", port.doc}});
    for (const ParamDecl& decl : type.params)
        params.push_back({{"name", decl.name},
                          {"type", name(decl.type)},
                          {"range", rangeOf(decl, session)},
                          {"default", toString(decl.fallback)},
                          {"doc", decl.doc}});
    for (Promise promise : type.promised)
        promises.push_back(describe(promise));
    return {{"name", type.name},  {"doc", type.doc},  {"plugin", type.plugin}, {"inputs", inputs},
            {"outputs", outputs}, {"params", params}, {"promises", promises}};
}

std::string broughtBy(const PassType& type) {
    return type.plugin.empty() ? "" : " (plug-in " + type.plugin + ")";
}

void printManual(const PassType& type, const Session& session, std::ostream& out) {
    out << type.name << " - " << type.doc << broughtBy(type) << "\n";
    const auto line = [&](const std::string& what, std::string_view kind, const std::string& doc) {
        out << "    " << std::left << std::setw(18) << what << " " << std::setw(18) << kind << " "
            << doc << "\n";
    };
    if (!type.inputs.empty())
        out << "\n  inputs\n";
    for (const InPort& port : type.inputs) {
        line(port.name, port.type.name,
             port.doc + (port.variadic ? " (several edges)" : "") +
                 (port.optional ? " (optional)" : ""));
        for (const ParamDecl& decl : port.edge_params)
            line("  on each edge: " + decl.name, rangeOf(decl, session),
                 decl.doc + " [" + toString(decl.fallback) + "]");
    }
    out << "\n  outputs\n";
    for (const OutPort& port : type.outputs)
        line(port.name, port.type.name, port.doc);
    if (!type.params.empty())
        out << "\n  params\n";
    for (const ParamDecl& decl : type.params)
        line(decl.name, rangeOf(decl, session), decl.doc + " [" + toString(decl.fallback) + "]");
    if (!type.promised.empty())
        out << "\n  promises\n";
    for (Promise promise : type.promised)
        out << "    " << describe(promise) << "\n";
}

} // namespace

int passes(const PassesArguments& arguments, const Console& console) {
    const Session session(arguments.plugins);
    if (arguments.name.empty()) {
        Json all = Json::array();
        for (const PassType& type : session.passes().all()) {
            all.push_back(describe(type, session));
            if (!arguments.json)
                console.out << std::left << std::setw(22) << type.name << " " << type.doc
                            << broughtBy(type) << "\n";
        }
        if (arguments.json)
            print(console.out, {{"passes", all}});
        return kOk;
    }
    const PassType* type = session.passes().find(arguments.name);
    if (type == nullptr) {
        std::vector<std::string> names;
        for (const PassType& known : session.passes().all())
            names.push_back(known.name);
        const std::string meant = nearest(arguments.name, names);
        console.err << "no pass is called \"" << arguments.name << "\""
                    << (meant.empty() ? "; hone passes lists them"
                                      : "; did you mean \"" + meant + "\"?")
                    << "\n";
        return kUsage;
    }
    if (arguments.json)
        print(console.out, describe(*type, session));
    else
        printManual(*type, session, console.out);
    return kOk;
}

} // namespace hone::cli

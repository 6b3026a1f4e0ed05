// SPDX-License-Identifier: Apache-2.0
#include "hone/core/graph/parameters.h"

#include "hone/core/graph/reporter.h"
#include "hone/core/trace/choice/backend_name.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace hone {
namespace {

std::string toText(double number) {
    char buffer[32];
    const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, number);
    return {buffer, end};
}

std::string toText(const ParamLiteral& literal) {
    if (const bool* flag = std::get_if<bool>(&literal))
        return *flag ? "true" : "false";
    if (const double* number = std::get_if<double>(&literal))
        return toText(*number);
    return "\"" + std::get<std::string>(literal) + "\"";
}

std::string rangeText(const ParamDecl& decl) {
    if (decl.min && decl.max)
        return "from " + toText(*decl.min) + " to " + toText(*decl.max);
    if (decl.min)
        return "at least " + toText(*decl.min);
    return "at most " + toText(*decl.max);
}

const char* expectation(ParamType type) {
    switch (type) {
    case ParamType::kBool:
        return "true or false";
    case ParamType::kUint:
        return "a whole number from 0 to 4294967295";
    case ParamType::kFloat:
        return "a number";
    case ParamType::kEnum:
        return "one of its choices, as a string";
    }
    return "?";
}

/// A value on the command line has no quotes: its declaration says what it is.
ParamLiteral literalFrom(const ParamDecl& decl, const std::string& text) {
    if (decl.type == ParamType::kBool && (text == "true" || text == "false"))
        return text == "true";
    if (decl.type == ParamType::kUint || decl.type == ParamType::kFloat) {
        double number = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
        if (error == std::errc() && end == text.data() + text.size())
            return number;
    }
    return text;
}

ParamLiteral literalFrom(const ParamValue& value) {
    if (const bool* flag = std::get_if<bool>(&value))
        return *flag;
    if (const uint* number = std::get_if<uint>(&value))
        return static_cast<double>(*number);
    if (const float* number = std::get_if<float>(&value))
        return static_cast<double>(*number);
    return std::get<std::string>(value);
}

} // namespace

std::vector<std::string> choicesOf(const ParamDecl& decl, const Catalog& catalog) {
    if (!decl.from_trace_backends)
        return decl.choices;
    std::vector<std::string> result{"auto"};
    if (catalog.trace_backends != nullptr)
        for (std::string& name : catalog.trace_backends->names())
            result.push_back(std::move(name));
    return result;
}

std::variant<ParamValue, ParamProblem> readParam(const ParamDecl& decl, const ParamLiteral& literal,
                                                 const Catalog& catalog, const std::string& whose) {
    const auto wrong_type = [&] {
        return ParamProblem{
            "E0502", whose + " must be " + expectation(decl.type) + ", not " + toText(literal), ""};
    };
    if (decl.type == ParamType::kBool) {
        if (const bool* flag = std::get_if<bool>(&literal))
            return ParamValue(*flag);
        return wrong_type();
    }
    if (decl.type == ParamType::kEnum) {
        const std::string* choice = std::get_if<std::string>(&literal);
        if (choice == nullptr)
            return wrong_type();
        const std::vector<std::string> choices = choicesOf(decl, catalog);
        const bool is_backend = decl.from_trace_backends && catalog.trace_backends != nullptr &&
                                catalog.trace_backends->contains(*choice);
        if (is_backend || std::ranges::find(choices, *choice) != choices.end())
            return ParamValue(*choice);
        if (decl.from_trace_backends)
            return ParamProblem{"E0510",
                                whose + ": this program has no trace backend \"" + *choice + "\"",
                                suggest(*choice, similarNames(*choice, choices), "it has")};
        return ParamProblem{"E0504", whose + " has no choice \"" + *choice + "\"",
                            suggest(*choice, choices, "choose one of")};
    }
    const double* number = std::get_if<double>(&literal);
    if (number == nullptr || !std::isfinite(*number))
        return wrong_type();
    const bool is_whole = *number == std::floor(*number) && *number >= 0 &&
                          *number <= std::numeric_limits<uint>::max();
    if (decl.type == ParamType::kUint && !is_whole)
        return wrong_type();
    if ((decl.min && *number < *decl.min) || (decl.max && *number > *decl.max))
        return ParamProblem{"E0503",
                            whose + " must be " + rangeText(decl) + ", not " + toText(*number), ""};
    if (decl.type == ParamType::kUint)
        return ParamValue(static_cast<uint>(*number));
    if (std::abs(*number) > std::numeric_limits<float>::max())
        return wrong_type();
    return ParamValue(static_cast<float>(*number));
}

std::variant<ParamValue, ParamProblem> convertParam(const PlannedParam& from, const ParamDecl& to,
                                                    const Catalog& catalog,
                                                    const std::string& whose) {
    const bool widens = from.decl.type == ParamType::kUint && to.type == ParamType::kFloat;
    if (from.decl.type != to.type && !widens)
        return ParamProblem{"E0508",
                            whose + " is a " + name(to.type) + "; graph parameter \"" +
                                from.decl.name + "\" is a " + name(from.decl.type),
                            "declare the graph parameter as a " + std::string(name(to.type))};
    auto value = readParam(to, literalFrom(from.value), catalog, whose);
    if (ParamProblem* problem = std::get_if<ParamProblem>(&value); problem && problem->hint.empty())
        problem->hint = "it takes the value of graph parameter \"" + from.decl.name + "\"";
    return value;
}

namespace {

std::string describe(const CompiledGraph& graph, NodeId node, const std::string& param) {
    return "parameter \"" + param + "\" of pass \"" + graph.nodes[node].name + "\"";
}

/// Hands a graph parameter's value to what it feeds.
std::optional<ParamProblem> feed(CompiledGraph& graph, const Catalog& catalog,
                                 const PlannedParam& param, std::vector<NodeId>& changed) {
    for (const ParamUse& use : param.uses) {
        if (use.graph_param != kNoId) {
            PlannedParam& fed = graph.params[use.graph_param];
            auto value =
                convertParam(param, fed.decl, catalog, "graph parameter \"" + fed.decl.name + "\"");
            if (ParamProblem* problem = std::get_if<ParamProblem>(&value))
                return *problem;
            fed.value = std::get<ParamValue>(value);
            if (auto problem = feed(graph, catalog, fed, changed))
                return problem;
            continue;
        }
        PlannedNode& node = graph.nodes[use.node];
        changed.push_back(use.node);
        if (use.stop_rule != kNoId) {
            const ParamLiteral literal = literalFrom(param.value);
            graph.loops[node.loop].stop[use.stop_rule].limit = std::get<double>(literal);
            if (!isBounded(graph.loops[node.loop]))
                return ParamProblem{"E0601", "loop \"" + node.name + "\" would have no bound",
                                    "a rule for iterations, rays or ms must stay above 0"};
            continue;
        }
        const bool is_edge = use.edge != kNoId;
        const ParamDecl& decl =
            is_edge ? node.type->inputs[node.inputs[use.edge].port].edge_params[use.edge_param]
                    : node.type->params[use.param];
        auto value = convertParam(param, decl, catalog, describe(graph, use.node, decl.name));
        if (ParamProblem* problem = std::get_if<ParamProblem>(&value))
            return *problem;
        if (is_edge)
            node.inputs[use.edge].params[use.edge_param] = std::get<ParamValue>(value);
        else
            node.params.set(decl.name, std::get<ParamValue>(value));
    }
    return std::nullopt;
}

/// Do passes come and go with the parameter, or with one that it feeds?
bool isSwitch(const CompiledGraph& graph, const PlannedParam& param) {
    return param.is_switch || std::ranges::any_of(param.uses, [&](const ParamUse& use) {
               return use.graph_param != kNoId && isSwitch(graph, graph.params[use.graph_param]);
           });
}

std::optional<ParamProblem> assignGraphParam(CompiledGraph& graph, const Catalog& catalog,
                                             PlannedParam& param, const std::string& text,
                                             std::vector<NodeId>& changed) {
    auto value = readParam(param.decl, literalFrom(param.decl, text), catalog,
                           "graph parameter \"" + param.decl.name + "\"");
    if (ParamProblem* problem = std::get_if<ParamProblem>(&value))
        return *problem;
    // From now on the parameter of the graph around that fed it has no say.
    const auto id = static_cast<std::uint32_t>(&param - graph.params.data());
    for (PlannedParam& outer : graph.params)
        std::erase_if(outer.uses, [&](const ParamUse& use) { return use.graph_param == id; });
    if (param.value == std::get<ParamValue>(value))
        return std::nullopt;
    if (isSwitch(graph, param))
        return ParamProblem{"E0511",
                            "graph parameter \"" + param.decl.name +
                                "\" switches passes on and off, which a compiled graph cannot do",
                            "compile the graph anew with this value"};
    const ParamValue before = std::exchange(param.value, std::get<ParamValue>(value));
    std::optional<ParamProblem> problem = feed(graph, catalog, param, changed);
    if (problem) {
        // The value before was good everywhere: handing it out again undoes what was done.
        param.value = before;
        changed.clear();
        std::vector<NodeId> undone;
        (void)feed(graph, catalog, param, undone);
    }
    return problem;
}

std::optional<ParamProblem> assignPassParam(CompiledGraph& graph, const Catalog& catalog,
                                            NodeId node, std::size_t param, const std::string& text,
                                            std::vector<NodeId>& changed) {
    const ParamDecl& decl = graph.nodes[node].type->params[param];
    auto value =
        readParam(decl, literalFrom(decl, text), catalog, describe(graph, node, decl.name));
    if (ParamProblem* problem = std::get_if<ParamProblem>(&value))
        return *problem;
    if (graph.nodes[node].params.value(decl.name) != std::get<ParamValue>(value))
        changed.push_back(node);
    graph.nodes[node].params.set(decl.name, std::get<ParamValue>(value));
    // From now on the graph parameter that fed it has no say.
    for (PlannedParam& fed : graph.params)
        std::erase_if(fed.uses,
                      [&](const ParamUse& use) { return use.node == node && use.param == param; });
    return std::nullopt;
}

} // namespace

std::optional<ParamProblem> assignParam(CompiledGraph& graph, const Catalog& catalog,
                                        const std::string& path, const std::string& text,
                                        std::vector<NodeId>& changed) {
    std::vector<std::string> known;
    for (PlannedParam& param : graph.params) {
        if (param.decl.name == path)
            return assignGraphParam(graph, catalog, param, text, changed);
        known.push_back(param.decl.name);
    }
    for (NodeId id = 0; id < graph.nodes.size(); ++id) {
        const PassType* type = graph.nodes[id].type;
        for (std::size_t i = 0; type != nullptr && i < type->params.size(); ++i) {
            std::string name = graph.nodes[id].name + "." + type->params[i].name;
            if (name == path)
                return assignPassParam(graph, catalog, id, i, text, changed);
            known.push_back(std::move(name));
        }
    }
    return ParamProblem{"E0509", "the graph has no parameter \"" + path + "\"",
                        suggest(path, known, "it has")};
}

bool isBounded(const PlannedLoop& loop) {
    return std::ranges::any_of(loop.stop, [](const StopRule& rule) {
        return rule.kind != StopRule::Kind::kEmpty && rule.kind != StopRule::Kind::kBelow &&
               rule.limit > 0;
    });
}

} // namespace hone

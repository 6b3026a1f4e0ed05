// SPDX-License-Identifier: Apache-2.0
#include "hone/core/graph/compilation.h"

#include <algorithm>

namespace hone {
namespace {

void resolveInputs(Compilation& c, NodeId id) {
    Resolver resolver(c, c.written[id].scope);
    for (const InputDesc& input : c.written[id].desc->inputs) {
        // Sources are looked up even where the port is wrong, so that both are reported.
        std::vector<ValueId> sources;
        for (const EdgeDesc& edge : input.edges)
            sources.push_back(resolver.find(edge));
        PlannedNode& node = c.graph.nodes[id];
        if (node.type == nullptr)
            continue;
        const InPort* port = node.type->findIn(input.port.text);
        if (port == nullptr) {
            std::vector<std::string> names;
            for (const InPort& known : node.type->inputs)
                names.push_back(known.name);
            c.reporter.error("E0302", input.port.place,
                             "pass \"" + c.nameOf(id) + "\" (" + node.type->name +
                                 ") has no input \"" + input.port.text + "\"",
                             suggest(input.port.text, names, "it has"));
            continue;
        }
        if (!port->variadic && input.is_list)
            c.reporter.error("E0403",
                             input.edges.empty() ? input.port.place : input.edges.back().from.place,
                             "input \"" + input.port.text + "\" of \"" + c.nameOf(id) +
                                 "\" takes one edge, not a list",
                             "write \"" + input.port.text + "\": \"pass.port\"");
        if (input.edges.size() > InPort::kMaxEdges)
            c.reporter.error("E0404", input.edges[InPort::kMaxEdges].from.place,
                             "input \"" + input.port.text + "\" of \"" + c.nameOf(id) + "\" has " +
                                 std::to_string(input.edges.size()) + " edges; at most " +
                                 std::to_string(InPort::kMaxEdges) + " are possible",
                             "join some of them in a pass before it");
        for (std::size_t i = 0; i < std::min(sources.size(), InPort::kMaxEdges); ++i) {
            PlannedEdge& edge = node.inputs.emplace_back();
            edge.port = static_cast<std::uint32_t>(port - node.type->inputs.data());
            edge.element = static_cast<std::uint32_t>(i);
            edge.value = sources[i];
            c.written[id].edges.push_back(&input.edges[i]);
        }
    }
}

void resolveCarries(Compilation& c, NodeId id) {
    const LoopDesc& desc = *c.written[id].desc->loop;
    const std::uint32_t index = c.graph.nodes[id].loop;
    Resolver outside(c, c.written[id].scope);
    Resolver inside(c, c.loop_scopes.at(id));
    for (std::size_t i = 0; i < desc.carry.size(); ++i)
        if (!desc.carry[i].initial.is_zero) {
            const ValueId initial = outside.find(desc.carry[i].initial);
            c.graph.loops[index].carries[i].initial = initial;
            if (initial != kNoId)
                c.same_types.emplace_back(c.graph.loops[index].carries[i].value, initial);
        }

    std::vector<PlannedCarry>& carries = c.graph.loops[index].carries;
    std::vector<std::string> carried;
    for (const PlannedCarry& carry : carries)
        carried.push_back(carry.name);
    for (const NextDesc& next : desc.next) {
        const ValueId source = inside.find(next.from);
        const auto carry = std::ranges::find(carries, next.name.text, &PlannedCarry::name);
        if (carry != carries.end())
            carry->next = source;
        else
            c.reporter.error("E0603", next.name.place,
                             "loop \"" + c.nameOf(id) + "\" carries no \"" + next.name.text + "\"",
                             suggest(next.name.text, carried, "it carries"));
    }
    for (const CarryDesc& carry : desc.carry)
        if (std::ranges::none_of(
                desc.next, [&](const NextDesc& next) { return next.name.text == carry.name.text; }))
            c.reporter.error(
                "E0602", carry.name.place,
                "loop \"" + c.nameOf(id) + "\" does not say what \"" + carry.name.text +
                    "\" is in the next iteration",
                "add it under \"next\"; a value that stays the same needs no carrying");
}

void resolveStopRules(Compilation& c, NodeId id) {
    const LoopDesc& desc = *c.written[id].desc->loop;
    Resolver inside(c, c.loop_scopes.at(id));
    for (const StopDesc& stop : desc.stop) {
        StopRule rule;
        const std::string& kind = stop.rule.name.text;
        rule.kind = kind == "empty"   ? StopRule::Kind::kEmpty
                    : kind == "below" ? StopRule::Kind::kBelow
                    : kind == "rays"  ? StopRule::Kind::kRays
                    : kind == "ms"    ? StopRule::Kind::kMs
                                      : StopRule::Kind::kIterations;
        if (rule.kind == StopRule::Kind::kBelow) {
            rule.value = inside.find(stop.of);
        } else if (rule.kind == StopRule::Kind::kEmpty) {
            const std::string* list = std::get_if<std::string>(&stop.rule.value);
            if (list != nullptr && !list->empty())
                rule.value = inside.find(Word{*list, stop.rule.place});
            else
                c.reporter.error("E0202", stop.rule.place, "\"empty\" needs the name of a list",
                                 "write \"pass.port\"");
        }
        c.graph.loops[c.graph.nodes[id].loop].stop.push_back(rule);
    }
}

/// The pass that is a graph: what it is fed with, and what it is not.
void resolveGraphUse(Compilation& c, ScopeId id) {
    const Scope& scope = c.scopes[id];
    std::vector<std::string> names;
    for (const GraphInputDesc& input : scope.graph->inputs)
        names.push_back(input.name.text);
    const std::string what = "graph \"" + scope.use->name.text + "\"";
    for (const InputDesc& input : scope.use->inputs) {
        const auto port = std::ranges::find(names, input.port.text);
        if (port == names.end()) {
            c.reporter.error("E0302", input.port.place,
                             what + " has no input \"" + input.port.text + "\"",
                             suggest(input.port.text, names, "it has"));
            c.reporter.note(scope.use->graph.place,
                            "the graph is \"" + scope.use->graph.text + "\"");
            continue;
        }
        if (input.is_list)
            c.reporter.error("E0403", input.port.place,
                             "input \"" + input.port.text + "\" of " + what +
                                 " takes one edge, not a list",
                             "write \"" + input.port.text + "\": \"pass.port\"");
        for (const EdgeDesc& edge : input.edges) {
            for (const ParamText& param : edge.params)
                c.reporter.error("E0501", param.name.place,
                                 "an edge into " + what + " has no parameter \"" + param.name.text +
                                     "\"",
                                 "it has none");
            const ValueId fed = Resolver(c, scope.parent).find(edge);
            const PortType& declared =
                c.scopes[id].input_types[static_cast<std::size_t>(port - names.begin())];
            if (fed != kNoId && !declared.name.empty())
                c.fed_inputs.push_back(
                    {declared, fed, &edge, scope.use->name.text + "." + input.port.text});
        }
    }
    for (std::size_t i = 0; i < names.size(); ++i)
        if (std::ranges::none_of(scope.use->inputs, [&](const InputDesc& input) {
                return !input.edges.empty() &&
                       (input.port.text == names[i] || nearest(input.port.text, names) == names[i]);
            }))
            c.reporter.error("E0402", scope.use->name.place,
                             "input \"" + names[i] + "\" (" + scope.graph->inputs[i].type.text +
                                 ") of " + what + " is not connected",
                             "add \"" + names[i] + "\": \"pass.port\" to its \"in\"");
}

void resolveOutputs(Compilation& c, ScopeId id) {
    const Scope& scope = c.scopes[id];
    Resolver resolver(c, id);
    for (const OutputDesc& output : scope.graph->outputs) {
        const ValueId value = resolver.find(output.from);
        if (value != kNoId && !output.type.text.empty())
            c.typed_outputs.push_back({&output, value});
        (scope.use == nullptr ? c.graph.outputs : c.graph.graphs[scope.planned].outputs)
            .push_back({output.name.text, value});
    }
    if (scope.graph->outputs.empty())
        c.reporter.error("E0208", scope.graph->outputs_place, "the graph has no outputs",
                         "add \"outputs\": { \"color\": \"pass.port\" }: what no output needs does "
                         "not run");
}

/// What readers get while a pass, loop or graph is switched off.
void resolveBypasses(Compilation& c, const PassDesc& pass, ScopeId scope) {
    for (const BypassDesc& bypass : pass.bypass) {
        const Word output{pass.name.text + "." + bypass.output.text, bypass.output.place};
        const ValueId value = Resolver(c, scope).find(output);
        const ValueId instead = Resolver(c, scope).find(bypass.from);
        if (value != kNoId && instead != kNoId)
            c.bypasses.push_back({value, instead, scope, bypass.from.from.place});
    }
    if (!pass.bypass.empty() && !pass.when)
        c.reporter.error("E0609", pass.bypass.front().output.place,
                         "\"" + pass.name.text + "\" has a \"bypass\" and no \"when\"",
                         "add \"when\": \"$flag\", or remove \"bypass\"");
}

} // namespace

void resolveEdges(Compilation& c) {
    for (NodeId id = 0; id < c.graph.nodes.size(); ++id) {
        if (c.graph.nodes[id].loop == kNoId) {
            resolveInputs(c, id);
        } else {
            resolveCarries(c, id);
            resolveStopRules(c, id);
        }
        resolveBypasses(c, *c.written[id].desc, c.written[id].scope);
    }
    for (ScopeId id = 0; id < c.scopes.size(); ++id) {
        if (c.scopes[id].graph == nullptr)
            continue;
        resolveOutputs(c, id);
        if (c.scopes[id].use == nullptr)
            continue;
        resolveGraphUse(c, id);
        resolveBypasses(c, *c.scopes[id].use, c.scopes[id].parent);
    }
}

} // namespace hone

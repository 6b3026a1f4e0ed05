// SPDX-License-Identifier: Apache-2.0
#include "hone/core/graph/compilation.h"

#include <algorithm>

namespace hone {
namespace {

bool isTyped(const PlannedValue& value) {
    return !value.type.name.empty();
}

/// The type that {"zero": "Type"} names.
PortType zeroType(Compilation& c, const EdgeDesc& zero) {
    const std::vector<PortType> known = graphTypes(*c.catalog.passes);
    const auto has_elements = [](const PortType& type) { return type.stride != 0; };
    const auto found = std::ranges::find(known, zero.from.text, &PortType::name);
    if (found != known.end() && has_elements(*found))
        return *found;
    std::vector<std::string> names;
    for (const PortType& type : known)
        if (has_elements(type))
            names.emplace_back(type.name);
    c.reporter.error("E0605", zero.from.place,
                     found == known.end() ? "there is no type \"" + zero.from.text + "\""
                                          : "a " + zero.from.text + " cannot be made of zeroes",
                     suggest(zero.from.text, names, "there are"));
    return {};
}

/// Carried values and histories have the type of what they begin with or follow, which may be
/// another such value: repeat until nothing more is found.
void typeFeedback(Compilation& c) {
    for (PlannedLoop& loop : c.graph.loops)
        for (std::size_t i = 0; i < loop.carries.size(); ++i)
            if (const CarryDesc& carry = c.written[loop.node].desc->loop->carry[i];
                carry.initial.is_zero && !carry.initial.from.text.empty())
                c.graph.values[loop.carries[i].value].type = zeroType(c, carry.initial);
    for (std::size_t i = 0; i < c.histories.size(); ++i)
        if (const EdgeDesc& initial = *c.histories[i].desc->initial;
            initial.is_zero && !initial.from.text.empty())
            c.graph.values[c.graph.histories[i].value].type = zeroType(c, initial);
    for (bool found = true; found;) {
        found = false;
        for (const auto& [value, like] : c.same_types) {
            if (isTyped(c.graph.values[value]) || !isTyped(c.graph.values[like]))
                continue;
            c.graph.values[value].type = c.graph.values[like].type;
            found = true;
        }
    }
}

/// What a history follows and begins with must be of one type, and have content to keep.
void checkHistories(Compilation& c) {
    for (std::size_t i = 0; i < c.histories.size(); ++i) {
        const PlannedHistory& history = c.graph.histories[i];
        const EdgeDesc& edge = *c.histories[i].desc;
        const PortType& type = c.graph.values[history.value].type;
        if (type.name.empty())
            continue;
        if (type.stride == 0)
            c.reporter.error("E0605", edge.from.place,
                             "a " + std::string(type.name) + " of the last frame is not kept",
                             "what has no elements cannot be copied");
        const std::pair<ValueId, const Word*> ends[] = {{history.source, &edge.from},
                                                        {history.initial, &edge.initial->from}};
        for (const auto& [value, from] : ends) {
            if (value == kNoId || !isTyped(c.graph.values[value]) ||
                c.graph.values[value].type == type)
                continue;
            c.reporter.error("E0604", from->place,
                             "\"" + edge.from.text + "@-1\" is " + std::string(type.name) +
                                 ", but \"" + from->text + "\" is " +
                                 std::string(c.graph.values[value].type.name),
                             "a value keeps its type from frame to frame");
        }
    }
}

/// Outputs that have the type and can be read in the scope by a plain name: what a person may have
/// meant.
std::vector<std::string> writersOf(const Compilation& c, const PortType& type, NodeId reader) {
    std::vector<std::string> result;
    const ScopeId scope = c.graphOf(c.written[reader].scope);
    for (const PlannedValue& value : c.graph.values) {
        if (!isTyped(value) || value.type != type || value.writer == reader)
            continue;
        const bool is_input =
            value.writer == kNoId && c.scopes[scope].use == nullptr && value.name.starts_with('$');
        const bool is_here = value.writer != kNoId && c.written[value.writer].scope == scope;
        if (is_input || is_here)
            result.push_back(value.name.substr(c.scopes[scope].prefix.size()));
    }
    if (c.scopes[scope].use != nullptr)
        for (std::size_t i = 0; i < c.scopes[scope].input_types.size(); ++i)
            if (c.scopes[scope].input_types[i] == type)
                result.push_back("$" + c.scopes[scope].graph->inputs[i].name.text);
    return result;
}

void noteWriter(Compilation& c, ValueId id, ScopeId from) {
    const PlannedValue& value = c.graph.values[id];
    if (value.writer != kNoId)
        c.reporter.note(c.written[value.writer].desc->name.place,
                        "\"" + c.nameOf(id, from) + "\" is " + describe(value.type));
}

/// The type that an edge brings. Inside a graph that is used as a pass, its inputs are of the types
/// that it says; what it is fed with is checked at its border.
PortType typeOf(const Compilation& c, const EdgeDesc& edge, ScopeId reader, ValueId value) {
    const Scope& scope = c.scopes[c.graphOf(reader)];
    if (scope.use != nullptr && edge.from.text.starts_with('$'))
        for (std::size_t i = 0; i < scope.input_types.size(); ++i)
            if (scope.graph->inputs[i].name.text == edge.from.text.substr(1))
                return scope.input_types[i];
    return c.graph.values[value].type;
}

void checkEdges(Compilation& c, NodeId id) {
    const PlannedNode& node = c.graph.nodes[id];
    for (std::size_t i = 0; i < node.inputs.size(); ++i) {
        const PlannedEdge& edge = node.inputs[i];
        const InPort& port = node.type->inputs[edge.port];
        if (edge.value == kNoId)
            continue;
        const PortType type = typeOf(c, *c.written[id].edges[i], c.written[id].scope, edge.value);
        if (type.name.empty() || type == port.type)
            continue;
        const std::vector<std::string> fitting = writersOf(c, port.type, id);
        c.reporter.error(
            "E0401", c.written[id].edges[i]->from.place,
            "cannot feed " + std::string(type.name) + " into " + std::string(port.type.name) +
                ": \"" + c.nameOf(edge.value, c.written[id].scope) + "\" to \"" + c.nameOf(id) +
                "." + port.name + "\"",
            fitting.empty() ? "nothing in this graph writes " + describe(port.type)
                            : std::string(port.type.name) + " comes from " + quotedList(fitting));
        noteWriter(c, edge.value, c.written[id].scope);
    }
}

/// Was the port meant by an input that was written with a wrong name? Then that is the report.
bool isMisspelt(const PassType& type, const std::vector<InputDesc>& written,
                const std::string& port) {
    std::vector<std::string> names;
    for (const InPort& known : type.inputs)
        names.push_back(known.name);
    return std::ranges::any_of(written, [&](const InputDesc& input) {
        return type.findIn(input.port.text) == nullptr && nearest(input.port.text, names) == port;
    });
}

void checkRequired(Compilation& c, NodeId id) {
    const PlannedNode& node = c.graph.nodes[id];
    const std::vector<InputDesc>& written = c.written[id].desc->inputs;
    for (const InPort& port : node.type->inputs) {
        const auto input = std::ranges::find(written, port.name,
                                             [](const InputDesc& desc) { return desc.port.text; });
        if (port.optional || (input != written.end() && !input->edges.empty()) ||
            isMisspelt(*node.type, written, port.name))
            continue;
        const std::vector<std::string> fitting = writersOf(c, port.type, id);
        c.reporter.error(
            "E0402", input != written.end() ? input->port.place : c.written[id].desc->name.place,
            "input \"" + port.name + "\" (" + std::string(port.type.name) + ") of \"" +
                c.nameOf(id) + "\" is not connected",
            fitting.empty()
                ? "nothing in this graph writes " + std::string(port.type.name)
                : "add \"" + port.name + "\": \"" + fitting.front() + "\" to its \"in\"");
    }
}

void checkStopRule(Compilation& c, const StopDesc& desc, const StopRule& rule) {
    if (rule.value == kNoId)
        return;
    const PlannedValue& value = c.graph.values[rule.value];
    if (!isTyped(value))
        return;
    const std::string is = "; \"" + value.name + "\" is " + std::string(value.type.name);
    if (rule.kind == StopRule::Kind::kEmpty && value.type.shape != Shape::kList)
        c.reporter.error("E0606", desc.rule.place, "only a list can be empty" + is);
    if (rule.kind == StopRule::Kind::kBelow && !(value.type == types::kScalar))
        c.reporter.error("E0606", desc.of.place, "only a Scalar can be below a limit" + is,
                         "request.worst is one: the greatest expected error of a batch");
}

/// The border of a graph that is used as a pass.
void checkGraphUses(Compilation& c) {
    for (const FedInput& input : c.fed_inputs) {
        const PlannedValue& value = c.graph.values[input.fed];
        if (!isTyped(value) || value.type == input.declared)
            continue;
        c.reporter.error("E0401", input.edge->from.place,
                         "cannot feed " + std::string(value.type.name) + " into " +
                             std::string(input.declared.name) + ": \"" + input.edge->from.text +
                             "\" to \"" + input.input + "\"",
                         "the graph wants " + describe(input.declared));
    }
    const std::vector<PortType> known = graphTypes(*c.catalog.passes);
    for (const TypedOutput& output : c.typed_outputs) {
        const PlannedValue& value = c.graph.values[output.value];
        const Word& type = output.desc->type;
        const auto found = std::ranges::find(known, type.text, &PortType::name);
        std::vector<std::string> names;
        for (const PortType& port : known)
            names.emplace_back(port.name);
        if (found == known.end())
            c.reporter.error("E0307", type.place, "there is no type \"" + type.text + "\"",
                             suggest(type.text, names, "there are"));
        else if (isTyped(value) && !(value.type == *found))
            c.reporter.error("E0406", type.place,
                             "output \"" + output.desc->name.text + "\" is said to be " +
                                 type.text + ", but \"" + output.desc->from.text + "\" is " +
                                 std::string(value.type.name),
                             "write \"type\": \"" + std::string(value.type.name) +
                                 "\", or connect another value");
    }
}

void checkLoop(Compilation& c, NodeId id) {
    const LoopDesc& desc = *c.written[id].desc->loop;
    const PlannedLoop& loop = c.graph.loops[c.graph.nodes[id].loop];
    for (const NextDesc& next : desc.next) {
        const auto carry = std::ranges::find(loop.carries, next.name.text, &PlannedCarry::name);
        if (carry == loop.carries.end() || carry->next == kNoId)
            continue;
        const PlannedValue& to = c.graph.values[carry->value];
        const PlannedValue& from = c.graph.values[carry->next];
        if (!isTyped(to) || !isTyped(from) || to.type == from.type)
            continue;
        c.reporter.error("E0604", next.from.place,
                         "\"" + carry->name + "\" is carried as " + std::string(to.type.name) +
                             ", but \"" + next.from.text + "\" is " + std::string(from.type.name),
                         "what is carried keeps its type");
        c.reporter.note(
            desc.carry[static_cast<std::size_t>(carry - loop.carries.begin())].name.place,
            "it begins here");
    }
    for (std::size_t i = 0; i < loop.stop.size(); ++i)
        checkStopRule(c, desc.stop[i], loop.stop[i]);
    for (const PlannedCarry& carry : loop.carries) {
        const PlannedValue& value = c.graph.values[carry.value];
        if (isTyped(value) && value.type.stride == 0)
            c.reporter.error(
                "E0605",
                desc.carry[static_cast<std::size_t>(&carry - loop.carries.data())].name.place,
                "a " + std::string(value.type.name) + " cannot be carried",
                "passes inside a loop may read it from outside");
    }
}

/// An input of the graph that nothing reads does no harm. The extent is every plane's size.
void warnUnreadInputs(Compilation& c) {
    std::vector<bool> is_read(c.graph.values.size());
    const auto read = [&](ValueId value) {
        if (value != kNoId)
            is_read[value] = true;
    };
    for (const PlannedNode& node : c.graph.nodes)
        for (const PlannedEdge& edge : node.inputs)
            read(edge.value);
    for (const NamedValue& output : c.graph.outputs)
        read(output.value);
    for (const PlannedHistory& history : c.graph.histories)
        read(history.initial);
    for (const PlannedLoop& loop : c.graph.loops)
        for (const PlannedCarry& carry : loop.carries)
            read(carry.initial);
    for (std::size_t i = 0; i < c.graph.inputs.size(); ++i) {
        const ValueId id = c.graph.inputs[i].value;
        if (id != kNoId && !is_read[id] && c.graph.values[id].type.shape != Shape::kExtent)
            c.reporter.warning("W0801", c.desc.inputs[i].name.place,
                               "no pass reads input \"" + c.graph.inputs[i].name + "\"",
                               "remove it, or connect it as \"$" + c.graph.inputs[i].name + "\"");
    }
}

} // namespace

void checkTypes(Compilation& c) {
    typeFeedback(c);
    checkHistories(c);
    checkGraphUses(c);
    for (NodeId id = 0; id < c.graph.nodes.size(); ++id) {
        if (c.graph.nodes[id].loop != kNoId) {
            checkLoop(c, id);
        } else if (c.graph.nodes[id].type != nullptr) {
            checkEdges(c, id);
            checkRequired(c, id);
        }
    }
    if (!c.reporter.failed())
        warnUnreadInputs(c);
}

} // namespace hone

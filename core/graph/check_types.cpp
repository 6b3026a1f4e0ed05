// SPDX-License-Identifier: Apache-2.0
#include "hone/core/graph/compilation.h"

#include <algorithm>

namespace hone {
namespace {

bool isTyped(const PlannedValue& value) {
    return !value.type.name.empty();
}

/// What a carried value begins with, where that is zeroes.
void typeZero(Compilation& c, const CarryDesc& carry, PlannedValue& value) {
    const std::vector<PortType> known = graphTypes(*c.catalog.passes);
    const auto has_elements = [](const PortType& type) { return type.stride != 0; };
    const auto found = std::ranges::find(known, carry.initial.from.text, &PortType::name);
    if (found != known.end() && has_elements(*found)) {
        value.type = *found;
        return;
    }
    std::vector<std::string> names;
    for (const PortType& type : known)
        if (has_elements(type))
            names.emplace_back(type.name);
    c.reporter.error("E0605", carry.initial.from.place,
                     found == known.end()
                         ? "there is no type \"" + carry.initial.from.text + "\""
                         : "a " + carry.initial.from.text + " cannot be made of zeroes",
                     suggest(carry.initial.from.text, names, "there are"));
}

/// A carried value has the type of what it begins with, which may be another loop's carried value:
/// repeat until nothing more is found.
void typeCarries(Compilation& c) {
    for (PlannedLoop& loop : c.graph.loops)
        for (std::size_t i = 0; i < loop.carries.size(); ++i)
            if (const CarryDesc& carry = c.written[loop.node]->loop->carry[i];
                carry.initial.is_zero && !carry.initial.from.text.empty())
                typeZero(c, carry, c.graph.values[loop.carries[i].value]);
    for (bool found = true; found;) {
        found = false;
        for (const PlannedLoop& loop : c.graph.loops)
            for (const PlannedCarry& carry : loop.carries) {
                PlannedValue& value = c.graph.values[carry.value];
                if (carry.initial == kNoId || isTyped(value) ||
                    !isTyped(c.graph.values[carry.initial]))
                    continue;
                value.type = c.graph.values[carry.initial].type;
                found = true;
            }
    }
}

/// Outputs of this graph that have the type: what a person may have meant.
std::vector<std::string> writersOf(const Compilation& c, const PortType& type, NodeId reader) {
    std::vector<std::string> result;
    for (const PlannedValue& value : c.graph.values)
        if (isTyped(value) && value.type == type && value.writer != reader &&
            (value.writer == kNoId || c.graph.nodes[value.writer].parent == kNoId))
            result.push_back(value.name);
    return result;
}

void noteWriter(Compilation& c, ValueId id) {
    const PlannedValue& value = c.graph.values[id];
    if (value.writer != kNoId)
        c.reporter.note(c.written[value.writer]->name.place,
                        "\"" + value.name + "\" is " + describe(value.type));
}

void checkEdges(Compilation& c, NodeId id) {
    const PlannedNode& node = c.graph.nodes[id];
    for (std::size_t i = 0; i < node.inputs.size(); ++i) {
        const PlannedEdge& edge = node.inputs[i];
        const InPort& port = node.type->inputs[edge.port];
        if (edge.value == kNoId)
            continue;
        const PlannedValue& value = c.graph.values[edge.value];
        if (!isTyped(value) || value.type == port.type)
            continue;
        const std::vector<std::string> fitting = writersOf(c, port.type, id);
        c.reporter.error(
            "E0401", c.edge_places[id][i],
            "cannot feed " + std::string(value.type.name) + " into " + std::string(port.type.name) +
                ": \"" + value.name + "\" to \"" + node.name + "." + port.name + "\"",
            fitting.empty() ? "nothing in this graph writes " + describe(port.type)
                            : std::string(port.type.name) + " comes from " + quotedList(fitting));
        noteWriter(c, edge.value);
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
    const std::vector<InputDesc>& written = c.written[id]->inputs;
    for (const InPort& port : node.type->inputs) {
        const auto input = std::ranges::find(written, port.name,
                                             [](const InputDesc& desc) { return desc.port.text; });
        if (port.optional || (input != written.end() && !input->edges.empty()) ||
            isMisspelt(*node.type, written, port.name))
            continue;
        const std::vector<std::string> fitting = writersOf(c, port.type, id);
        c.reporter.error(
            "E0402", input != written.end() ? input->port.place : c.written[id]->name.place,
            "input \"" + port.name + "\" (" + std::string(port.type.name) + ") of \"" + node.name +
                "\" is not connected",
            fitting.empty()
                ? "nothing in this graph writes " + std::string(port.type.name)
                : "add \"" + port.name + "\": \"" + fitting.front() + "\" to its \"in\"");
    }
}

void checkLoop(Compilation& c, NodeId id) {
    const LoopDesc& desc = *c.written[id]->loop;
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
    for (std::size_t i = 0; i < loop.stop.size(); ++i) {
        if (loop.stop[i].list == kNoId)
            continue;
        const PlannedValue& list = c.graph.values[loop.stop[i].list];
        if (isTyped(list) && list.type.shape != Shape::kList)
            c.reporter.error("E0606", desc.stop[i].rule.place,
                             "only a list can be empty; \"" + list.name + "\" is " +
                                 std::string(list.type.name));
    }
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
    typeCarries(c);
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

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/graph/compilation.h"

#include <algorithm>

namespace hone {
namespace {

/// Follows edges backwards from the outputs.
class Needs {
public:
    explicit Needs(CompiledGraph& graph) : graph_(&graph), is_node_needed_(graph.nodes.size()) {}

    void run() {
        for (const NamedValue& output : graph_->outputs)
            need(output.value);
        while (!open_.empty()) {
            const ValueId id = open_.back();
            open_.pop_back();
            const NodeId writer = graph_->values[id].writer;
            if (writer == kNoId) {
                needHistory(id);
                continue;
            }
            needNode(writer);
            if (const std::uint32_t loop = graph_->nodes[writer].loop; loop != kNoId)
                needCarry(graph_->loops[loop], id);
        }
    }

    bool isNeeded(NodeId node) const { return is_node_needed_[node]; }

private:
    void need(ValueId id) {
        if (id == kNoId || graph_->values[id].is_needed)
            return;
        graph_->values[id].is_needed = true;
        open_.push_back(id);
    }

    void needNode(NodeId id) {
        if (id == kNoId || is_node_needed_[id])
            return;
        is_node_needed_[id] = true;
        const PlannedNode& node = graph_->nodes[id];
        for (const PlannedEdge& edge : node.inputs)
            need(edge.value);
        // A pass writes all of its outputs, read or not: they need memory.
        if (node.loop == kNoId)
            for (const PlannedOutput& output : node.outputs)
                need(output.value);
        else
            for (const StopRule& rule : graph_->loops[node.loop].stop)
                need(rule.value);
        needNode(node.parent);
    }

    void needHistory(ValueId id) {
        for (const PlannedHistory& history : graph_->histories)
            if (history.value == id) {
                need(history.initial);
                need(history.source);
            }
    }

    void needCarry(const PlannedLoop& loop, ValueId id) {
        for (const PlannedCarry& carry : loop.carries)
            if (carry.value == id) {
                need(carry.initial);
                need(carry.next);
            }
    }

    CompiledGraph* graph_;
    std::vector<bool> is_node_needed_;
    std::vector<ValueId> open_;
};

/// The nodes that read any of a node's outputs.
std::vector<std::string> readersOf(const Compilation& c, NodeId id) {
    std::vector<std::string> result;
    const auto is_written = [&](ValueId value) {
        return value != kNoId && c.graph.values[value].writer == id;
    };
    for (const PlannedNode& node : c.graph.nodes)
        if (std::ranges::any_of(node.inputs,
                                [&](const PlannedEdge& edge) { return is_written(edge.value); }))
            result.push_back(node.name);
    for (const PlannedLoop& loop : c.graph.loops)
        for (const PlannedCarry& carry : loop.carries)
            if (loop.node != id && (is_written(carry.initial) || is_written(carry.next)))
                result.push_back(c.graph.nodes[loop.node].name + "'s carried " + carry.name);
    return result;
}

/// The first node outside loops that reads the value, itself or within.
NodeId firstReader(const Compilation& c, ValueId value) {
    for (const NodeId id : c.graph.order)
        for (NodeId node = 0; node < c.graph.nodes.size(); ++node) {
            const auto reads = [&](const PlannedEdge& edge) { return edge.value == value; };
            if (c.isInside(node, id) && std::ranges::any_of(c.graph.nodes[node].inputs, reads))
                return id;
            if (const std::uint32_t loop = c.graph.nodes[node].loop;
                loop != kNoId && c.isInside(node, id))
                for (const PlannedCarry& carry : c.graph.loops[loop].carries)
                    if (carry.initial == value || carry.next == value)
                        return id;
        }
    return kNoId;
}

} // namespace

void cullNodes(Compilation& c) {
    Needs needs(c.graph);
    needs.run();
    for (NodeId id = 0; id < c.graph.nodes.size(); ++id) {
        PlannedNode& node = c.graph.nodes[id];
        if (needs.isNeeded(id))
            continue;
        const std::vector<std::string> readers = readersOf(c, id);
        if (!node.culled.empty())
            continue; // switched off
        if (node.parent != kNoId && !needs.isNeeded(node.parent))
            node.culled = "its loop does not run";
        else if (readers.empty())
            node.culled = "nothing reads its outputs";
        else
            node.culled = "no output needs what reads it: " + quotedList(readers);
    }
    const auto is_culled = [&](NodeId id) { return !needs.isNeeded(id); };
    std::erase_if(c.graph.order, is_culled);
    for (PlannedLoop& loop : c.graph.loops) {
        std::erase_if(loop.body, is_culled);
        for (PlannedCarry& carry : loop.carries)
            carry.is_culled = !c.graph.values[carry.value].is_needed;
    }
    for (PlannedHistory& history : c.graph.histories)
        history.begins_at = firstReader(c, history.value);
}

} // namespace hone

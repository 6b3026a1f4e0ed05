// SPDX-License-Identifier: Apache-2.0
#include "hone/core/graph/compilation.h"

#include <algorithm>
#include <string_view>

namespace hone {
namespace {

/// Names as the graph file writes them, seen from inside one scope.
class Resolver {
public:
    Resolver(Compilation& c, NodeId scope) : c_(&c), scope_(scope) {}

    /// The value that `from` means; kNoId when there is none, which is then reported.
    ValueId find(const Word& from) {
        if (from.text.empty())
            return kNoId; // the reader has reported it
        if (from.text.front() == '$')
            return findInput(from);
        if (from.text.front() == '~')
            return findCarried(from);
        return findOutput(from);
    }

private:
    ValueId findInput(const Word& from) {
        const std::string name = from.text.substr(1);
        std::vector<std::string> names;
        for (const NamedValue& input : c_->graph.inputs) {
            if (input.name == name)
                return input.value;
            names.push_back("$" + input.name);
        }
        const bool is_param = std::ranges::any_of(
            c_->desc.params, [&](const GraphParamDesc& param) { return param.name.text == name; });
        if (is_param)
            c_->reporter.error("E0305", from.place,
                               "\"" + from.text +
                                   "\" is a parameter; an edge needs a graph input "
                                   "or a pass's output",
                               "parameters are read under \"params\"");
        else
            c_->reporter.error("E0305", from.place, "the graph has no input \"" + from.text + "\"",
                               suggest(from.text, names, "it has"));
        return kNoId;
    }

    ValueId findCarried(const Word& from) {
        const std::string name = from.text.substr(1);
        std::vector<std::string> names;
        for (NodeId loop = scope_; loop != kNoId; loop = c_->graph.nodes[loop].parent)
            for (const PlannedCarry& carry : c_->graph.loops[c_->graph.nodes[loop].loop].carries) {
                if (carry.name == name)
                    return carry.value;
                names.push_back("~" + carry.name);
            }
        if (scope_ == kNoId)
            c_->reporter.error("E0306", from.place,
                               "\"" + from.text +
                                   "\" is a carried value, and this is outside any "
                                   "loop",
                               "after a loop its carried values are its outputs: \"loop.name\"");
        else
            c_->reporter.error("E0306", from.place, "no loop here carries \"" + from.text + "\"",
                               suggest(from.text, names, "carried are"));
        return kNoId;
    }

    ValueId findOutput(const Word& from) {
        std::string_view rest = from.text;
        const std::string first(takeStep(rest));
        const NodeId node = findNode(first);
        if (node == kNoId) {
            reportUnknownPass(from, first, rest);
            return kNoId;
        }
        return findIn(from, node, rest);
    }

    /// Cuts the part before the first "." off `rest`.
    static std::string_view takeStep(std::string_view& rest) {
        const std::size_t dot = std::min(rest.find('.'), rest.size());
        const std::string_view step = rest.substr(0, dot);
        rest.remove_prefix(std::min(dot + 1, rest.size()));
        return step;
    }

    NodeId findNode(const std::string& name) const {
        for (NodeId scope = scope_;; scope = c_->graph.nodes[scope].parent) {
            const auto found = c_->node_names.find({scope, name});
            if (found != c_->node_names.end())
                return found->second;
            if (scope == kNoId)
                return kNoId;
        }
    }

    ValueId findIn(const Word& from, NodeId id, std::string_view rest) {
        const PlannedNode& node = c_->graph.nodes[id];
        if (c_->isInside(scope_, id)) {
            const std::string inner(rest);
            const bool is_carried = inner.find('.') == std::string::npos && inner != "stats";
            c_->reporter.error("E0306", from.place,
                               "\"" + from.text + "\" exists after the loop, and this is inside it",
                               is_carried ? "write \"~" + inner + "\""
                                          : "write \"" + inner + "\" for this iteration's");
            return kNoId;
        }
        const std::string step(takeStep(rest));
        const std::string name = node.name + "." + step;
        if (rest.empty())
            for (const PlannedOutput& output : node.outputs)
                if (c_->graph.values[output.value].name == name)
                    return output.value;
        if (node.loop != kNoId && !step.empty()) {
            const auto inner = c_->node_names.find({id, step});
            if (inner != c_->node_names.end())
                return findIn(from, inner->second, rest);
        }
        reportUnknownOutput(from, id);
        return kNoId;
    }

    void reportUnknownPass(const Word& from, const std::string& first, std::string_view port) {
        std::vector<std::string> passes;
        std::vector<std::string> outputs;
        const std::string rest = port.empty() ? "" : "." + std::string(port);
        for (const auto& [key, id] : c_->node_names)
            if (isVisible(key.first) && !c_->isInside(scope_, id)) {
                passes.push_back(key.second);
                outputs.push_back(key.second + rest);
            }
        const std::string near = nearest(first + rest, outputs);
        c_->reporter.error("E0303", from.place, "there is no pass \"" + first + "\"",
                           near.empty() ? suggest(first, passes, "the passes here are")
                                        : "did you mean \"" + near + "\"?");
    }

    bool isVisible(NodeId scope) const { return scope == kNoId || c_->isInside(scope_, scope); }

    void reportUnknownOutput(const Word& from, NodeId id) {
        const PlannedNode& node = c_->graph.nodes[id];
        if (node.type == nullptr && node.loop == kNoId)
            return; // its type is unknown, which is the cause
        const std::string prefix = from.text.substr(0, from.text.find('.')) + ".";
        std::vector<std::string> names;
        for (const PlannedOutput& output : node.outputs) {
            // As seen from here: the node's own name is the last step of its full one.
            const std::string& full = c_->graph.values[output.value].name;
            const std::size_t parent = node.name.rfind('.');
            names.push_back(parent == std::string::npos ||
                                    prefix != node.name.substr(parent + 1) + "."
                                ? full
                                : full.substr(parent + 1));
        }
        const std::size_t dot = from.text.find('.');
        if (dot == std::string::npos)
            c_->reporter.error("E0304", from.place,
                               "\"" + from.text + "\" is a pass; an edge needs one of its outputs",
                               names.size() == 1 ? "write \"" + names.front() + "\""
                                                 : "write one of " + quotedList(names));
        else
            c_->reporter.error("E0304", from.place,
                               std::string(node.loop == kNoId ? "pass" : "loop") + " \"" +
                                   node.name + "\" has no output \"" +
                                   from.text.substr(from.text.rfind('.') + 1) + "\"",
                               suggest(from.text, names, "it has"));
        c_->reporter.note(c_->written[id]->name.place, "\"" + node.name + "\" is here");
    }

    Compilation* c_;
    NodeId scope_;
};

void resolveInputs(Compilation& c, NodeId id) {
    PlannedNode& node = c.graph.nodes[id];
    Resolver resolver(c, node.parent);
    for (const InputDesc& input : c.written[id]->inputs) {
        // Sources are looked up even where the port is wrong, so that both are reported.
        std::vector<ValueId> sources;
        for (const EdgeDesc& edge : input.edges)
            sources.push_back(resolver.find(edge.from));
        if (node.type == nullptr)
            continue;
        const InPort* port = node.type->findIn(input.port.text);
        if (port == nullptr) {
            std::vector<std::string> names;
            for (const InPort& known : node.type->inputs)
                names.push_back(known.name);
            c.reporter.error("E0302", input.port.place,
                             "pass \"" + node.name + "\" (" + node.type->name +
                                 ") has no input \"" + input.port.text + "\"",
                             suggest(input.port.text, names, "it has"));
            continue;
        }
        if (!port->variadic && input.is_list)
            c.reporter.error("E0403",
                             input.edges.empty() ? input.port.place : input.edges.back().from.place,
                             "input \"" + input.port.text + "\" of \"" + node.name +
                                 "\" takes one edge, not a list",
                             "write \"" + input.port.text + "\": \"pass.port\"");
        if (input.edges.size() > InPort::kMaxEdges)
            c.reporter.error("E0404", input.edges[InPort::kMaxEdges].from.place,
                             "input \"" + input.port.text + "\" of \"" + node.name + "\" has " +
                                 std::to_string(input.edges.size()) + " edges; at most " +
                                 std::to_string(InPort::kMaxEdges) + " are possible",
                             "join some of them in a pass before it");
        for (std::size_t i = 0; i < std::min(sources.size(), InPort::kMaxEdges); ++i) {
            PlannedEdge& edge = node.inputs.emplace_back();
            edge.port = static_cast<std::uint32_t>(port - node.type->inputs.data());
            edge.element = static_cast<std::uint32_t>(i);
            edge.value = sources[i];
            c.edge_places[id].push_back(input.edges[i].from.place);
        }
    }
}

void resolveCarries(Compilation& c, NodeId id) {
    const LoopDesc& desc = *c.written[id]->loop;
    PlannedLoop& loop = c.graph.loops[c.graph.nodes[id].loop];
    Resolver outside(c, c.graph.nodes[id].parent);
    Resolver inside(c, id);
    for (std::size_t i = 0; i < desc.carry.size(); ++i)
        if (!desc.carry[i].initial.is_zero)
            loop.carries[i].initial = outside.find(desc.carry[i].initial.from);

    std::vector<std::string> carried;
    for (const PlannedCarry& carry : loop.carries)
        carried.push_back(carry.name);
    for (const NextDesc& next : desc.next) {
        const ValueId source = inside.find(next.from);
        const auto carry = std::ranges::find(loop.carries, next.name.text, &PlannedCarry::name);
        if (carry != loop.carries.end())
            carry->next = source;
        else
            c.reporter.error("E0603", next.name.place,
                             "loop \"" + c.graph.nodes[id].name + "\" carries no \"" +
                                 next.name.text + "\"",
                             suggest(next.name.text, carried, "it carries"));
    }
    for (const CarryDesc& carry : desc.carry)
        if (std::ranges::none_of(
                desc.next, [&](const NextDesc& next) { return next.name.text == carry.name.text; }))
            c.reporter.error(
                "E0602", carry.name.place,
                "loop \"" + c.graph.nodes[id].name + "\" does not say what \"" + carry.name.text +
                    "\" is in the next iteration",
                "add it under \"next\"; a value that stays the same needs no carrying");
}

void resolveStopRules(Compilation& c, NodeId id) {
    const LoopDesc& desc = *c.written[id]->loop;
    PlannedLoop& loop = c.graph.loops[c.graph.nodes[id].loop];
    Resolver inside(c, id);
    for (const StopDesc& stop : desc.stop) {
        StopRule& rule = loop.stop.emplace_back();
        const std::string& kind = stop.rule.name.text;
        rule.kind = kind == "empty"  ? StopRule::Kind::kEmpty
                    : kind == "rays" ? StopRule::Kind::kRays
                    : kind == "ms"   ? StopRule::Kind::kMs
                                     : StopRule::Kind::kIterations;
        if (rule.kind != StopRule::Kind::kEmpty)
            continue; // numbers: bindParams
        const std::string* list = std::get_if<std::string>(&stop.rule.value);
        if (list == nullptr) {
            c.reporter.error("E0202", stop.rule.place, "\"empty\" needs the name of a list",
                             "write \"pass.port\"");
            continue;
        }
        rule.list = inside.find({*list, stop.rule.place});
    }
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
    }
    Resolver resolver(c, kNoId);
    for (const OutputDesc& output : c.desc.outputs)
        c.graph.outputs.push_back({output.name.text, resolver.find(output.from)});
    if (c.desc.outputs.empty())
        c.reporter.error("E0208", c.desc.outputs_place, "the graph has no outputs",
                         "add \"outputs\": { \"color\": \"pass.port\" }: what no output needs does "
                         "not run");
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/graph/compilation.h"

#include <algorithm>

namespace hone {
namespace {

/// Passes that `when` switches off, and what their readers get instead.
class Switches {
public:
    explicit Switches(Compilation& c) : c_(&c) {}

    void run() {
        checkBypasses();
        checkReaders();
        if (c_->reporter.failed())
            return;
        for (NodeId id = 0; id < c_->graph.nodes.size(); ++id)
            c_->graph.nodes[id].culled = reasonToBeOff(id);
        for (NodeId id = 0; id < c_->graph.nodes.size(); ++id)
            if (c_->graph.nodes[id].culled.empty() && c_->graph.nodes[id].type != nullptr)
                rewire(id);
        for (PlannedLoop& loop : c_->graph.loops) {
            for (PlannedCarry& carry : loop.carries) {
                carry.initial = live(carry.initial);
                carry.next = live(carry.next);
            }
            for (StopRule& rule : loop.stop)
                rule.value = live(rule.value);
        }
        for (PlannedHistory& history : c_->graph.histories) {
            history.source = live(history.source);
            history.initial = live(history.initial);
        }
        for (NamedValue& output : c_->graph.outputs)
            output.value = live(output.value);
        for (PlannedGraph& graph : c_->graph.graphs)
            for (NamedValue& output : graph.outputs)
                output.value = live(output.value);
    }

private:
    const std::vector<Condition>& conditionsOf(ValueId value) const {
        static const std::vector<Condition> kNone;
        const NodeId writer = c_->graph.values[value].writer;
        return writer != kNoId ? c_->written[writer].conditions : kNone;
    }

    const Bypass* bypassOf(ValueId value) const {
        const auto found = std::ranges::find(c_->bypasses, value, &Bypass::value);
        return found != c_->bypasses.end() ? &*found : nullptr;
    }

    std::string reasonToBeOff(NodeId id) const {
        for (const Condition& condition : c_->written[id].conditions) {
            const PlannedParam& param = c_->graph.params[condition.param];
            if (std::ranges::find(condition.on, param.value) == condition.on.end())
                return "switched off: " + param.decl.name + " is " + toString(param.value);
        }
        return "";
    }

    void checkBypasses() {
        for (const Bypass& bypass : c_->bypasses) {
            const PlannedValue& value = c_->graph.values[bypass.value];
            const PlannedValue& instead = c_->graph.values[bypass.instead];
            if (!(value.type == instead.type))
                c_->reporter.error("E0401", bypass.place,
                                   "cannot put " + std::string(instead.type.name) +
                                       " in place of " + std::string(value.type.name) + ": \"" +
                                       c_->nameOf(bypass.instead, bypass.scope) + "\" for \"" +
                                       c_->nameOf(bypass.value, bypass.scope) + "\"",
                                   "what stands in has the same type");
        }
    }

    /// What may be switched off needs a bypass, unless its reader goes with it or can do without.
    void checkReaders() {
        const std::vector<Condition> none;
        for (NodeId id = 0; id < c_->graph.nodes.size(); ++id) {
            const PlannedNode& node = c_->graph.nodes[id];
            const WrittenNode& written = c_->written[id];
            for (std::size_t i = 0; i < node.inputs.size(); ++i) {
                const InPort& port = node.type->inputs[node.inputs[i].port];
                if (!port.optional && !port.variadic)
                    checkRead(node.inputs[i].value, written.conditions,
                              written.edges[i]->from.place, written.scope);
            }
            if (node.loop == kNoId)
                continue;
            const PlannedLoop& loop = c_->graph.loops[node.loop];
            const LoopDesc& desc = *written.desc->loop;
            for (std::size_t i = 0; i < loop.carries.size(); ++i)
                checkRead(loop.carries[i].initial, written.conditions,
                          desc.carry[i].initial.from.place, written.scope);
            for (const NextDesc& next : desc.next) {
                const auto carry =
                    std::ranges::find(loop.carries, next.name.text, &PlannedCarry::name);
                checkRead(carry->next, written.conditions, next.from.place, written.scope);
            }
            for (std::size_t i = 0; i < loop.stop.size(); ++i)
                checkRead(loop.stop[i].value, written.conditions, desc.stop[i].rule.place,
                          written.scope);
        }
        for (std::size_t i = 0; i < c_->histories.size(); ++i) {
            const WrittenHistory& written = c_->histories[i];
            checkRead(c_->graph.histories[i].source, none, written.desc->from.place, written.scope);
            checkRead(c_->graph.histories[i].initial, none, written.desc->from.place,
                      written.scope);
        }
        for (std::size_t i = 0; i < c_->graph.outputs.size(); ++i)
            checkRead(c_->graph.outputs[i].value, none, c_->desc.outputs[i].from.place, 0);
    }

    void checkRead(ValueId value, const std::vector<Condition>& reader, const Place& place,
                   ScopeId scope) {
        for (std::size_t steps = 0; value != kNoId; ++steps) {
            const std::vector<Condition>& writer = conditionsOf(value);
            const bool goes_with_it = std::ranges::all_of(writer, [&](const Condition& condition) {
                return std::ranges::find(reader, condition) != reader.end();
            });
            if (goes_with_it)
                return;
            const Bypass* bypass = bypassOf(value);
            if (bypass != nullptr && steps < c_->bypasses.size()) {
                value = bypass->instead;
                continue;
            }
            const std::string name = c_->nameOf(value, scope);
            c_->reporter.error(
                "E0608", place, "\"" + name + "\" may be switched off while this needs it",
                "say what stands in for it: \"bypass\": { \"" + name.substr(name.rfind('.') + 1) +
                    "\": \"pass.port\" } beside its \"when\"");
            const NodeId node = c_->graph.values[value].writer;
            c_->reporter.note(c_->written[node].desc->name.place,
                              "\"" + c_->nameOf(node) + "\" is switched here, or around it");
            return;
        }
    }

    /// The value itself, or what stands in for it; kNoId if nothing does.
    ValueId live(ValueId value) const {
        while (value != kNoId) {
            const NodeId writer = c_->graph.values[value].writer;
            if (writer == kNoId || c_->graph.nodes[writer].culled.empty())
                break;
            const Bypass* bypass = bypassOf(value);
            value = bypass != nullptr ? bypass->instead : kNoId;
        }
        return value;
    }

    /// Edges that lead to nothing vanish; the others of a list close up.
    void rewire(NodeId id) {
        PlannedNode& node = c_->graph.nodes[id];
        std::vector<PlannedEdge> edges;
        std::vector<const EdgeDesc*> written;
        std::vector<std::uint32_t> now(node.inputs.size(), kNoId); // index of an edge afterwards
        for (std::size_t i = 0; i < node.inputs.size(); ++i) {
            PlannedEdge edge = std::move(node.inputs[i]);
            edge.value = live(edge.value);
            if (edge.value == kNoId)
                continue;
            edge.element = static_cast<std::uint32_t>(
                std::ranges::count(edges, edge.port, &PlannedEdge::port));
            now[i] = static_cast<std::uint32_t>(edges.size());
            edges.push_back(std::move(edge));
            written.push_back(c_->written[id].edges[i]);
        }
        for (PlannedParam& param : c_->graph.params)
            std::erase_if(param.uses, [&](ParamUse& use) {
                if (use.node != id || use.edge == kNoId)
                    return false;
                use.edge = now[use.edge];
                return use.edge == kNoId;
            });
        node.inputs = std::move(edges);
        c_->written[id].edges = std::move(written);
        for (std::uint32_t port = 0; port < node.type->inputs.size(); ++port) {
            const bool is_fed = std::ranges::count(node.inputs, port, &PlannedEdge::port) > 0;
            const bool was_fed =
                std::ranges::any_of(c_->written[id].desc->inputs, [&](const InputDesc& input) {
                    return input.port.text == node.type->inputs[port].name;
                });
            if (was_fed && !is_fed && !node.type->inputs[port].optional)
                c_->reporter.error("E0607", c_->written[id].desc->name.place,
                                   "all that feeds \"" + c_->nameOf(id) + "." +
                                       node.type->inputs[port].name + "\" is switched off",
                                   "give \"" + c_->nameOf(id) +
                                       "\" a \"when\" of its own, or an edge that stays");
        }
    }

    Compilation* c_;
};

} // namespace

void switchOff(Compilation& c) {
    Switches(c).run();
}

} // namespace hone

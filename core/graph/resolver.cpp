// SPDX-License-Identifier: Apache-2.0
#include "hone/core/graph/compilation.h"

#include <algorithm>
#include <string_view>

namespace hone {
namespace {

/// Graphs hand on what they are given; deeper than that they do it in a circle.
constexpr std::uint32_t kMaxDepth = 64;

/// Cuts the part before the first "." off `rest`.
std::string_view takeStep(std::string_view& rest) {
    const std::size_t dot = std::min(rest.find('.'), rest.size());
    const std::string_view step = rest.substr(0, dot);
    rest.remove_prefix(std::min(dot + 1, rest.size()));
    return step;
}

} // namespace

ValueId Resolver::find(const Word& from) {
    if (from.text.empty())
        return kNoId; // the reader has reported it
    if (from.text.find('@') != std::string::npos) {
        c_->reporter.error("E0610", from.place, "the last frame's value cannot be used here",
                           "inputs of passes and carried values may begin with it");
        return kNoId;
    }
    if (from.text.front() == '$')
        return findInput(from);
    if (from.text.front() == '~')
        return findCarried(from);
    return findOutput(from);
}

ValueId Resolver::find(const EdgeDesc& edge) {
    return edge.is_history ? findHistory(edge) : find(edge.from);
}

/// A value of its own, which takes over at the end of each frame what its source holds then.
ValueId Resolver::findHistory(const EdgeDesc& edge) {
    const ValueId source = find(edge.from);
    const ValueId initial =
        edge.initial == nullptr || edge.initial->is_zero ? kNoId : find(edge.initial->from);
    if (source == kNoId || edge.initial == nullptr || (initial == kNoId && !edge.initial->is_zero))
        return kNoId;
    const NodeId within = c_->graph.values[source].scope;
    if (within != kNoId && c_->isInside(c_->scopes[scope_].loop, within)) {
        c_->reporter.error("E0610", edge.from.place,
                           "\"" + edge.from.text + "\" is made in this loop, which has no frames",
                           "what the last iteration made is carried: \"carry\" and \"next\"");
        return kNoId;
    }
    for (std::size_t i = 0; i < c_->histories.size(); ++i) {
        const PlannedHistory& known = c_->graph.histories[i];
        const EdgeDesc& begin = *c_->histories[i].desc->initial;
        const bool is_zero_alike =
            !edge.initial->is_zero || begin.from.text == edge.initial->from.text; // of one type
        if (known.source == source && known.initial == initial && is_zero_alike)
            return known.value;
    }
    const ValueId value = static_cast<ValueId>(c_->graph.values.size());
    PlannedValue& history = c_->graph.values.emplace_back();
    history.name = c_->graph.values[source].name + "@-1";
    history.type = PortType{};
    c_->graph.histories.push_back({.value = value, .source = source, .initial = initial});
    c_->same_types.emplace_back(value, source);
    if (initial != kNoId)
        c_->same_types.emplace_back(value, initial);
    c_->histories.push_back({.desc = &edge, .scope = scope_});
    return value;
}

ValueId Resolver::findInput(const Word& from) {
    const std::string name = from.text.substr(1);
    const ScopeId id = c_->graphOf(scope_);
    const Scope& scope = c_->scopes[id];
    std::vector<std::string> names;
    for (std::size_t i = 0; i < scope.graph->inputs.size(); ++i) {
        const std::string& input = scope.graph->inputs[i].name.text;
        names.push_back("$" + input);
        if (input != name)
            continue;
        if (scope.use == nullptr)
            return scope.inputs[i];
        for (const InputDesc& fed : scope.use->inputs) {
            if (fed.port.text != name || fed.edges.empty())
                continue;
            if (++depth_ > kMaxDepth) {
                c_->reporter.error("E0405", from.place,
                                   "graphs wait for each other: \"" + from.text +
                                       "\" is fed with what comes of it");
                return kNoId;
            }
            Resolver outside(*c_, scope.parent);
            outside.depth_ = depth_;
            return outside.find(fed.edges.front());
        }
        return kNoId; // reported as not connected
    }
    const bool is_param = scope.params.contains(name);
    if (is_param)
        c_->reporter.error("E0305", from.place,
                           "\"" + from.text +
                               "\" is a parameter; an edge needs a graph input or a pass's output",
                           "parameters are read under \"params\"");
    else
        c_->reporter.error("E0305", from.place, "the graph has no input \"" + from.text + "\"",
                           suggest(from.text, names, "it has"));
    return kNoId;
}

ValueId Resolver::findCarried(const Word& from) {
    const std::string name = from.text.substr(1);
    const ScopeId graph = c_->graphOf(scope_);
    std::vector<std::string> names;
    for (ScopeId scope = scope_; scope != graph; scope = c_->scopes[scope].parent) {
        const NodeId loop = c_->scopes[scope].loop;
        for (const PlannedCarry& carry : c_->graph.loops[c_->graph.nodes[loop].loop].carries) {
            if (carry.name == name)
                return carry.value;
            names.push_back("~" + carry.name);
        }
    }
    if (scope_ == graph)
        c_->reporter.error("E0306", from.place,
                           "\"" + from.text + "\" is a carried value, and this is outside any loop",
                           "after a loop its carried values are its outputs: \"loop.name\"");
    else
        c_->reporter.error("E0306", from.place, "no loop here carries \"" + from.text + "\"",
                           suggest(from.text, names, "carried are"));
    return kNoId;
}

ValueId Resolver::findOutput(const Word& from) {
    std::string_view rest = from.text;
    const std::string first(takeStep(rest));
    for (ScopeId id = scope_;; id = c_->scopes[id].parent) {
        const Scope& scope = c_->scopes[id];
        if (const auto node = scope.nodes.find(first); node != scope.nodes.end())
            return findIn(from, node->second, rest);
        if (const auto graph = scope.graphs.find(first); graph != scope.graphs.end())
            return findInGraph(from, graph->second, rest);
        if (scope.graph != nullptr)
            break;
    }
    reportUnknownPass(from, first, rest);
    return kNoId;
}

ValueId Resolver::findIn(const Word& from, NodeId id, std::string_view rest) {
    const PlannedNode& node = c_->graph.nodes[id];
    if (c_->isInside(c_->scopes[scope_].loop, id)) {
        const std::string inner(rest);
        const bool is_carried = inner.find('.') == std::string::npos && inner != "stats";
        c_->reporter.error("E0306", from.place,
                           "\"" + from.text + "\" exists after the loop, and this is inside it",
                           is_carried ? "write \"~" + inner + "\""
                                      : "write \"" + inner + "\" for this iteration's");
        return kNoId;
    }
    const bool is_last = rest.find('.') == std::string_view::npos;
    const std::string step(takeStep(rest));
    const std::string name = node.name + "." + step;
    if (is_last)
        for (const PlannedOutput& output : node.outputs)
            if (c_->graph.values[output.value].name == name)
                return output.value;
    if (node.loop != kNoId && !step.empty()) {
        const Scope& body = c_->scopes[c_->loop_scopes.at(id)];
        if (const auto inner = body.nodes.find(step); inner != body.nodes.end())
            return findIn(from, inner->second, rest);
        if (const auto graph = body.graphs.find(step); graph != body.graphs.end())
            return findInGraph(from, graph->second, rest);
    }
    reportUnknownOutput(from, id);
    return kNoId;
}

/// An output of a graph that is used as a pass is what that graph says it is.
ValueId Resolver::findInGraph(const Word& from, ScopeId graph, std::string_view output) {
    if (graph == kNoId)
        return kNoId; // its file could not be read
    const Scope& scope = c_->scopes[graph];
    std::vector<std::string> names;
    for (const OutputDesc& known : scope.graph->outputs) {
        if (known.name.text == output) {
            if (++depth_ > kMaxDepth) {
                c_->reporter.error("E0405", from.place,
                                   "graphs wait for each other: \"" + from.text +
                                       "\" is fed with what comes of it");
                return kNoId;
            }
            Resolver inside(*c_, graph);
            inside.depth_ = depth_;
            return inside.find(known.from);
        }
        names.push_back(scope.use->name.text + "." + known.name.text);
    }
    const std::string& name = scope.use->name.text;
    if (output.empty())
        c_->reporter.error("E0304", from.place,
                           "\"" + from.text + "\" is a graph; an edge needs one of its outputs",
                           names.empty() ? "it has none" : "write one of " + quotedList(names));
    else
        c_->reporter.error("E0304", from.place,
                           "graph \"" + name + "\" has no output \"" + std::string(output) + "\"",
                           suggest(from.text, names, "it has"));
    c_->reporter.note(scope.graph->outputs_place, "the outputs of \"" + name + "\" are here");
    return kNoId;
}

/// What a pass or a loop gives, and what is in it; `rest` where it could be anything.
void Resolver::addSources(std::vector<std::string>& sources, const std::string& name, NodeId id,
                          const std::string& rest) const {
    const PlannedNode& node = c_->graph.nodes[id];
    for (const PlannedOutput& output : node.outputs)
        sources.push_back(name + c_->graph.values[output.value].name.substr(node.name.size()));
    if (node.loop != kNoId) {
        const Scope& body = c_->scopes[c_->loop_scopes.at(id)];
        for (const auto& [inner, inner_id] : body.nodes)
            addSources(sources, name + "." + inner, inner_id, "");
        for (const auto& [inner, graph] : body.graphs)
            addGraphSources(sources, name + "." + inner, graph, "");
    } else if (node.type == nullptr) {
        sources.push_back(name + rest);
    }
}

void Resolver::addGraphSources(std::vector<std::string>& sources, const std::string& name,
                               ScopeId graph, const std::string& rest) const {
    if (graph == kNoId)
        sources.push_back(name + rest);
    else
        for (const OutputDesc& output : c_->scopes[graph].graph->outputs)
            sources.push_back(name + "." + output.name.text);
}

void Resolver::reportUnknownPass(const Word& from, const std::string& first,
                                 std::string_view port) {
    const std::string rest = port.empty() ? "" : "." + std::string(port);
    std::vector<std::string> passes;
    std::vector<std::string> sources;
    for (ScopeId id = scope_;; id = c_->scopes[id].parent) {
        const Scope& scope = c_->scopes[id];
        for (const auto& [name, node_id] : scope.nodes) {
            if (c_->isInside(c_->scopes[scope_].loop, node_id))
                continue;
            passes.push_back(name);
            addSources(sources, name, node_id, rest);
        }
        for (const auto& [name, graph] : scope.graphs) {
            passes.push_back(name);
            addGraphSources(sources, name, graph, rest);
        }
        // The sign before a name is forgotten as easily as a letter.
        if (scope.graph == nullptr) {
            for (const PlannedCarry& carry :
                 c_->graph.loops[c_->graph.nodes[scope.loop].loop].carries)
                sources.push_back("~" + carry.name);
            continue;
        }
        for (const GraphInputDesc& input : scope.graph->inputs)
            sources.push_back("$" + input.name.text);
        break;
    }
    const std::string near = nearest(from.text, sources);
    c_->reporter.error("E0303", from.place, "there is no pass \"" + first + "\"",
                       near.empty() ? suggest(first, passes, "the passes here are")
                                    : "did you mean \"" + near + "\"?");
}

void Resolver::reportUnknownOutput(const Word& from, NodeId id) {
    const PlannedNode& node = c_->graph.nodes[id];
    if (node.type == nullptr && node.loop == kNoId)
        return; // its type is unknown, which is the cause
    const std::string prefix = from.text.substr(0, from.text.find('.')) + ".";
    std::vector<std::string> names;
    for (const PlannedOutput& output : node.outputs) {
        // As seen from here: the node's own name is the last step of its full one.
        const std::string full = c_->nameOf(output.value, scope_);
        const std::string name = c_->nameOf(id);
        const std::size_t parent = name.rfind('.');
        names.push_back(parent == std::string::npos || prefix != name.substr(parent + 1) + "."
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
                               c_->nameOf(id) + "\" has no output \"" +
                               from.text.substr(from.text.rfind('.') + 1) + "\"",
                           suggest(from.text, names, "it has"));
    c_->reporter.note(c_->written[id].desc->name.place, "\"" + c_->nameOf(id) + "\" is here");
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/graph/compiled_graph.h"
#include "hone/core/graph/reporter.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace hone {

using ScopeId = std::uint32_t; ///< index into Compilation::scopes
using ParamId = std::uint32_t; ///< index into CompiledGraph::params

/// Where names are looked up: a graph, or a loop's body, which also sees the names around it.
struct Scope {
    ScopeId parent = kNoId;
    NodeId loop = kNoId;              ///< the innermost loop that it is in
    const GraphDesc* graph = nullptr; ///< null: a loop's body
    const PassDesc* use = nullptr;    ///< the pass that the graph is used as; null: the outermost
    std::uint32_t planned = kNoId;    ///< index into CompiledGraph::graphs: the innermost used one
    std::string prefix;               ///< of its nodes' names: "refine."
    std::map<std::string, NodeId, std::less<>> nodes;
    std::map<std::string, ScopeId, std::less<>> graphs; ///< passes that are graphs
    std::map<std::string, ParamId, std::less<>> params; ///< of a graph
    std::vector<PortType> input_types{}; ///< of a graph, parallel to GraphDesc::inputs
    std::vector<ValueId> inputs{};       ///< the same, of the outermost graph
};

/// A `when` that was understood: on unless the parameter's value is none of the choices.
struct Condition {
    ParamId param = kNoId;
    std::vector<ParamValue> on; ///< values with which the pass runs

    friend bool operator==(const Condition&, const Condition&) = default;
};

/// What a node was made of.
struct WrittenNode {
    const PassDesc* desc = nullptr;
    ScopeId scope = kNoId;
    std::vector<const EdgeDesc*> edges; ///< parallel to PlannedNode::inputs
    std::vector<Condition> conditions;  ///< its own and those of the loops and graphs around it
};

/// What readers of a value get when its writer is switched off.
struct Bypass {
    ValueId value = kNoId;
    ValueId instead = kNoId;
    ScopeId scope = kNoId; ///< in which it was written
    Place place;
};

/// How a history was written; parallel to CompiledGraph::histories.
struct WrittenHistory {
    const EdgeDesc* desc = nullptr;
    ScopeId scope = kNoId;
};

/// An edge into a graph that is used as a pass.
struct FedInput {
    PortType declared{};
    ValueId fed = kNoId;
    const EdgeDesc* edge = nullptr;
    std::string input; ///< "refine.image"
};

/// An output that says its type.
struct TypedOutput {
    const OutputDesc* desc = nullptr;
    ValueId value = kNoId;
};

/// What the phases of compile() hand to each other. Each phase reports all that is wrong in its
/// part and leaves what is broken as kNoId, which later phases pass over in silence.
struct Compilation {
    Compilation(const GraphDesc& the_desc, const Catalog& the_catalog,
                std::vector<Diagnostic>& diagnostics)
        : desc(the_desc), catalog(the_catalog), reporter(*the_desc.source, diagnostics) {}

    const GraphDesc& desc;
    const Catalog& catalog;
    Reporter reporter;
    CompiledGraph graph;
    std::vector<Scope> scopes;        ///< parents before what is in them
    std::vector<WrittenNode> written; ///< by NodeId
    std::map<NodeId, ScopeId> loop_scopes;
    std::vector<Bypass> bypasses;
    std::vector<WrittenHistory> histories;
    std::vector<FedInput> fed_inputs;
    std::vector<TypedOutput> typed_outputs;
    std::vector<std::pair<ValueId, ValueId>> same_types; ///< (untyped, what it takes its type from)

    /// The node that `node` is, or is inside of, directly in `loop`; kNoId if it is elsewhere.
    [[nodiscard]] NodeId ancestorIn(NodeId loop, NodeId node) const {
        while (node != kNoId && graph.nodes[node].parent != loop)
            node = graph.nodes[node].parent;
        return node;
    }
    [[nodiscard]] bool isInside(NodeId node, NodeId loop) const {
        while (node != kNoId && node != loop)
            node = graph.nodes[node].parent;
        return node == loop;
    }
    /// The graph that a scope belongs to.
    [[nodiscard]] ScopeId graphOf(ScopeId scope) const {
        while (scopes[scope].graph == nullptr)
            scope = scopes[scope].parent;
        return scope;
    }
    /// A node's name as its own file knows it.
    [[nodiscard]] std::string nameOf(NodeId node) const {
        return graph.nodes[node].name.substr(scopes[graphOf(written[node].scope)].prefix.size());
    }
    /// A value's name as seen from a scope.
    [[nodiscard]] std::string nameOf(ValueId value, ScopeId from) const {
        const std::string& prefix = scopes[graphOf(from)].prefix;
        const std::string& name = graph.values[value].name;
        return name.starts_with(prefix) ? name.substr(prefix.size()) : name;
    }
};

/// Finds values by the names that a graph file writes, seen from inside one scope. Names that mean
/// nothing are reported.
class Resolver {
public:
    Resolver(Compilation& c, ScopeId scope) : c_(&c), scope_(scope) {}

    /// The value that `from` means; kNoId when there is none.
    [[nodiscard]] ValueId find(const Word& from);
    /// The same for an edge, which may mean a value of the last frame.
    [[nodiscard]] ValueId find(const EdgeDesc& edge);

private:
    [[nodiscard]] ValueId findHistory(const EdgeDesc& edge);
    [[nodiscard]] ValueId findInput(const Word& from);
    [[nodiscard]] ValueId findCarried(const Word& from);
    [[nodiscard]] ValueId findOutput(const Word& from);
    [[nodiscard]] ValueId findIn(const Word& from, NodeId id, std::string_view rest);
    [[nodiscard]] ValueId findInGraph(const Word& from, ScopeId graph, std::string_view output);
    void addSources(std::vector<std::string>& sources, const std::string& name, NodeId id,
                    const std::string& rest) const;
    void addGraphSources(std::vector<std::string>& sources, const std::string& name, ScopeId graph,
                         const std::string& rest) const;
    void reportUnknownPass(const Word& from, const std::string& first, std::string_view port);
    void reportUnknownOutput(const Word& from, NodeId id);

    Compilation* c_;
    ScopeId scope_;
    std::uint32_t depth_ = 0; ///< of graphs whose inputs and outputs are followed
};

// ---- Phase "resolve": names and the edges between them ----
/// Makes nodes, loops, scopes and values with their names; finds pass types.
void declareNames(Compilation& c);
/// Connects edges, carried values, outputs.
void resolveEdges(Compilation& c);
// ---- Phase "infer": types and values ----
/// Compares the types at both ends of edges and finds required inputs that nothing feeds.
void checkTypes(Compilation& c);
/// Gives parameters, edge parameters, stop rules and conditions their values.
void bindParams(Compilation& c, const Overrides& overrides);
// ---- Phase "order and cull" ----
/// Sorts each scope's nodes so that every value is written before it is read; reports cycles.
void orderNodes(Compilation& c, std::uint64_t schedule_seed);
/// Takes what `when` switches off out of the edges and puts bypasses in its place.
void switchOff(Compilation& c);
/// Marks what outputs need; the rest does not run. Only for graphs without errors, as is all below.
void cullNodes(Compilation& c);
// ---- Phase "plan" ----
/// Decides lifetimes, what is updated in place, which values share memory, what is copied.
void planMemory(Compilation& c);

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/graph/compiled_graph.h"
#include "hone/core/graph/reporter.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace hone {

/// What the phases of compile() hand to each other. Each phase reports all that is wrong in its
/// part and leaves what is broken as kNoId, which later phases pass over in silence.
struct Compilation {
    Compilation(const GraphDesc& the_desc, const Catalog& the_catalog,
                std::vector<Diagnostic>& diagnostics)
        : desc(the_desc), catalog(the_catalog), reporter(the_desc.source, diagnostics) {}

    const GraphDesc& desc;
    const Catalog& catalog;
    Reporter reporter;
    CompiledGraph graph;
    std::vector<const PassDesc*> written;        ///< by NodeId
    std::vector<std::vector<Place>> edge_places; ///< by NodeId, parallel to PlannedNode::inputs
    std::map<std::pair<NodeId, std::string>, NodeId> node_names; ///< (scope, name in it)

    /// The node that `node` is, or is inside of, directly in `scope`; kNoId if it is elsewhere.
    [[nodiscard]] NodeId ancestorIn(NodeId scope, NodeId node) const {
        while (node != kNoId && graph.nodes[node].parent != scope)
            node = graph.nodes[node].parent;
        return node;
    }
    [[nodiscard]] bool isInside(NodeId node, NodeId loop) const {
        while (node != kNoId && node != loop)
            node = graph.nodes[node].parent;
        return node == loop;
    }
};

/// Makes nodes, loops and values with their names; finds pass types.
void declareNames(Compilation& c);
/// Connects edges, carried values, outputs.
void resolveEdges(Compilation& c);
/// Compares the types at both ends of edges and finds required inputs that nothing feeds.
void checkTypes(Compilation& c);
/// Gives parameters, edge parameters and stop rules their values.
void bindParams(Compilation& c, const Overrides& overrides);
/// Sorts each scope's nodes so that every value is written before it is read; reports cycles.
void orderNodes(Compilation& c);
/// Marks what outputs need; the rest does not run. Only for graphs without errors, as is all below.
void cullNodes(Compilation& c);
/// Decides lifetimes, what is updated in place, which values share memory, what is copied.
void planMemory(Compilation& c);

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/graph/compiled_graph.h"

#include "hone/core/error.h"
#include "hone/core/graph/compilation.h"
#include "hone/core/log.h"

#include <algorithm>
#include <tuple>

namespace hone {

CompiledGraph compile(const GraphDesc& desc, const Catalog& catalog, const Overrides& overrides,
                      std::vector<Diagnostic>& diagnostics, std::uint64_t schedule_seed) {
    Compilation c(desc, catalog, diagnostics);
    if (!desc.is_readable)
        return std::move(c.graph);
    declareNames(c);
    resolveEdges(c);
    checkTypes(c);
    bindParams(c, overrides);
    orderNodes(c, schedule_seed);
    const bool failed = std::ranges::any_of(
        diagnostics, [](const Diagnostic& d) { return d.severity == Severity::kError; });
    if (!failed) {
        switchOff(c);
    }
    if (!c.reporter.failed() && !failed) {
        cullNodes(c);
        planMemory(c);
    }
    // In the order of the file, so that a person reads it once from top to bottom; files that it
    // uses after it.
    const std::string& file = desc.source->file();
    std::ranges::stable_sort(diagnostics, [&](const Diagnostic& a, const Diagnostic& b) {
        return std::tuple(a.file != file, std::string_view(a.file), a.line, a.column) <
               std::tuple(b.file != file, std::string_view(b.file), b.line, b.column);
    });
    return std::move(c.graph);
}

CompiledGraph compileOrThrow(const GraphDesc& desc, const Catalog& catalog,
                             const Overrides& overrides, std::vector<Diagnostic> diagnostics) {
    CompiledGraph graph = compile(desc, catalog, overrides, diagnostics);
    if (std::ranges::any_of(diagnostics,
                            [](const Diagnostic& d) { return d.severity == Severity::kError; }))
        throw GraphError(format(diagnostics));
    for (const Diagnostic& diagnostic : diagnostics)
        logger().warn("{}", format(diagnostic));
    return graph;
}

CompiledGraph loadGraph(const std::string& path, const Catalog& catalog,
                        const Overrides& overrides) {
    std::vector<Diagnostic> diagnostics;
    const GraphDesc desc = parseGraphFile(path, diagnostics, catalog.graphs);
    return compileOrThrow(desc, catalog, overrides, std::move(diagnostics));
}

const PlannedNode* CompiledGraph::findNode(std::string_view node_name) const {
    const auto found = std::ranges::find(nodes, node_name, &PlannedNode::name);
    return found != nodes.end() ? &*found : nullptr;
}

const PlannedParam* CompiledGraph::findParam(std::string_view param) const {
    const auto found = std::ranges::find_if(
        params, [&](const PlannedParam& candidate) { return candidate.decl.name == param; });
    return found != params.end() ? &*found : nullptr;
}

ValueId CompiledGraph::findValue(std::string_view value_name) const {
    const std::vector<NamedValue> known = namedValues();
    const auto found = std::ranges::find(known, value_name, &NamedValue::name);
    return found != known.end() ? found->value : kNoId;
}

std::vector<NamedValue> CompiledGraph::namedValues() const {
    std::vector<NamedValue> result;
    for (ValueId id = 0; id < values.size(); ++id)
        result.push_back({values[id].name, id});
    for (const PlannedGraph& graph : graphs)
        for (const NamedValue& output : graph.outputs)
            if (output.value != kNoId)
                result.push_back({graph.name + "." + output.name, output.value});
    return result;
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/explain_value.h"

#include "hone/cli/session.h"
#include "hone/core/error.h"
#include "hone/core/graph/explain.h"
#include "hone/core/graph/reporter.h"

#include <ostream>

namespace hone::cli {

int explainValue(const std::string& graph_name, const std::string& name, const Overrides& overrides,
                 std::span<const std::string> plugins, const Console& console) {
    const Session session(plugins);
    const std::string path = findGraph(graph_name);
    const CompiledGraph graph = loadGraph(path, session.catalog(), overrides);
    const std::optional<std::string> text = hone::explain(graph, name);
    if (!text)
        throw GraphError(path + ": the graph has no pass, loop or value \"" + name + "\"; " +
                         suggest(name, explainable(graph), "it has") + "; hone check --plan " +
                         graph_name + " shows all");
    console.out << *text;
    return kOk;
}

} // namespace hone::cli

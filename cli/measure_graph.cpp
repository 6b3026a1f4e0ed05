// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/measure_graph.h"

#include "hone/cli/graph_document.h"
#include "hone/core/error.h"

#include <algorithm>

namespace hone::cli {
namespace {

using Json = nlohmann::ordered_json;

/// A pass of this file, outside its loops.
bool isOutermost(const PlannedNode& node) {
    return node.type != nullptr && node.parent == kNoId && node.graph == kNoId;
}

/// The raster image as an output of the file `written`.
Json rasterOf(const CompiledGraph& graph, const Json& written) {
    for (const NamedValue& output : graph.outputs)
        if (output.name == "raster" && graph.values[output.value].type == types::kRadiance)
            return written["outputs"]["raster"];
    for (const PlannedNode& node : graph.nodes)
        if (isOutermost(node))
            for (const OutPort& port : node.type->outputs)
                if (port.type == types::kRadiance)
                    return node.name + "." + port.name;
    throw GraphError(graph.file +
                     ": nothing to judge: no output \"raster\" of type Radiance and no "
                     "pass outside loops that makes one");
}

} // namespace

MeasureGraph makeMeasureGraph(const std::string& path, const Catalog& catalog,
                              const Overrides& overrides) {
    const CompiledGraph written = loadGraph(path, catalog, overrides);
    MeasureGraph result;
    GraphDocument document = readGraphDocument(path);
    Json& graph = document.json;
    Json outputs = {{"raster", rasterOf(written, graph)}};
    const auto add = [&](GraphMetric metric, const std::string& value) {
        metric.output = "metric_" + std::to_string(result.metrics.size());
        outputs[metric.output] = value;
        result.metrics.push_back(std::move(metric));
    };
    for (const PlannedNode& node : written.nodes) {
        if (!isOutermost(node))
            continue;
        for (const OutPort& port : node.type->outputs) {
            if (port.type != types::kError)
                continue;
            const std::string name = node.name + "." + port.name;
            const bool is_combiner = node.type->name == "combine";
            const std::string mode = is_combiner ? node.params.get<std::string>("mode") : "";
            add({name, {}, node.name, mode}, name);
            if (!is_combiner)
                continue;
            for (const std::string& other : node.type->findParam("mode")->choices) {
                if (other == mode)
                    continue;
                Json pass = graph["passes"][node.name];
                pass["params"]["mode"] = other;
                std::string twin = node.name + "_" + other;
                while (graph["passes"].contains(twin))
                    twin += "_";
                graph["passes"][twin] = std::move(pass);
                add({name + "[" + other + "]", {}, node.name, other}, twin + "." + port.name);
            }
        }
    }
    for (const PlannedGraph& used : written.graphs) {
        if (used.parent != kNoId || used.graph != kNoId)
            continue;
        for (const NamedValue& output : used.outputs) {
            if (output.value == kNoId)
                continue; // switched off
            const PlannedValue& value = written.values[output.value];
            const bool is_made_there =
                value.writer != kNoId && written.nodes[value.writer].graph != kNoId;
            if (value.type == types::kError && is_made_there)
                add({value.name, {}, used.name, ""}, used.name + "." + output.name);
        }
    }
    if (result.metrics.empty())
        throw GraphError(path + ": nothing to judge: no pass outside loops makes an Error");
    graph["outputs"] = std::move(outputs);
    result.graph = compileDocument(document, "as it is measured", catalog, overrides);
    return result;
}

} // namespace hone::cli

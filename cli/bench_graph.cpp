// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/bench_graph.h"

#include "hone/cli/commands.h"
#include "hone/cli/graph_document.h"
#include "hone/core/error.h"

#include <filesystem>

namespace hone::cli {

std::string defaultBenchScene() {
    namespace fs = std::filesystem;
    const fs::path sponza = fs::path(HONE_SOURCE_DIR) / "tests/scenes/sponza.scene.json";
    const fs::path model = fs::path(HONE_SOURCE_DIR) / "../shared/scenes/sponza/sponza.gltf";
    std::error_code ignored;
    const bool is_there = fs::exists(sponza, ignored) && fs::exists(model, ignored);
    return is_there ? sponza.string() : "builtin:atrium";
}

CompiledGraph makeBenchGraph(const Catalog& catalog) {
    using Json = nlohmann::ordered_json;
    GraphDocument graph = readGraphDocument(findGraph("sir"));
    Json& passes = graph.json["passes"];
    const Json view = {{"scene", "$scene"}, {"camera", "$camera"}};
    passes["visibility"] = {{"type", "bench.visibility"}, {"in", view}};
    passes["depth_only"] = {{"type", "bench.depth_only"}, {"in", view}};
    passes["noise"] = {{"type", "bench.noise"}, {"in", {{"error", "combine.error"}}}};
    for (const char* strategy : {"select", "radix"})
        passes[strategy] = {{"type", "sort"},
                            {"in", {{"error", "noise.noisy"}}},
                            {"params", {{"strategy", strategy}, {"batch", kBenchBatch}}}};
    passes["tonemap"] = {{"type", "tonemap"}, {"in", {{"color", "refine.image"}}}};
    // What is no output, or leads to one, would be culled.
    Json& outputs = graph.json["outputs"];
    outputs["visibility"] = "visibility.gbuffer";
    outputs["depth_only"] = "depth_only.depth";
    outputs["noise"] = "noise.noisy";
    outputs["select"] = "select.order";
    outputs["radix"] = "radix.order";
    outputs["display"] = "tonemap.display";
    return compileDocument(graph, "as it is timed", catalog, {});
}

Traffic trafficOf(const CompiledGraph& graph, std::string_view node_name, std::size_t pixels) {
    const PlannedNode* node = graph.findNode(node_name);
    HONE_ASSERT(node != nullptr, std::string(node_name));
    const auto bytes = [&](ValueId id) -> std::size_t {
        if (id == kNoId)
            return 0;
        const PortType& type = graph.values[id].type;
        const bool is_by_pixel = type.shape == Shape::kPlane || type.shape == Shape::kList;
        return is_by_pixel ? pixels * type.stride : 0;
    };
    Traffic traffic;
    for (const PlannedEdge& edge : node->inputs)
        traffic.read += bytes(edge.value);
    for (const PlannedOutput& output : node->outputs)
        traffic.written += bytes(output.value);
    return traffic;
}

} // namespace hone::cli

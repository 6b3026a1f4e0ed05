// SPDX-License-Identifier: Apache-2.0
#include "hone/core/graph/executor.h"

#include "hone/core/error.h"
#include "hone/core/graph/executor_state.h"
#include "hone/core/graph/parameters.h"

#include <algorithm>
#include <cstring>

namespace hone {

Executor::State::State(CompiledGraph the_graph, const Catalog& the_catalog, Devices the_devices,
                       std::uint64_t the_seed)
    : graph(std::move(the_graph)), catalog(the_catalog), devices(the_devices), seed(the_seed),
      memory(&devices.memory()), host(&devices.host->encoder()),
      device(devices.raster != nullptr ? &devices.raster->encoder() : nullptr),
      kernels(device != nullptr && !devices.raster->info().is_software ? device : host),
      values(graph.values.size()), memories(graph.memories.size()), loops(graph.loops.size()),
      histories(graph.histories.size()), tracers(*catalog.trace_backends, devices),
      nodes(graph.nodes.size()) {
    for (const NamedValue& input : graph.inputs)
        if (const Shape shape = graph.values[input.value].type.shape;
            shape != Shape::kScene && shape != Shape::kCamera && shape != Shape::kExtent)
            throw GraphError(graph.file + ": graph \"" + graph.name + "\" has an input \"" +
                             input.name + "\" of type " +
                             std::string(graph.values[input.value].type.name) +
                             ", so it cannot run alone; use it in another graph: { \"graph\": "
                             "FILE, \"in\": { \"" +
                             input.name + "\": ... } }");
    for (ValueId id = 0; id < values.size(); ++id)
        values[id].type = &graph.values[id].type;
    for (std::size_t i = 0; i < loops.size(); ++i) {
        loops[i].staged.resize(graph.loops[i].carries.size());
        values[graph.loops[i].stats].curve = &loops[i].curve;
    }
    for (NodeId id = 0; id < nodes.size(); ++id) {
        if (!graph.nodes[id].culled.empty())
            continue;
        if (graph.nodes[id].loop == kNoId) {
            makePass(id);
            bindPorts(id);
        } else {
            nodes[id].seen_versions.resize(graph.loops[graph.nodes[id].loop].reads.size());
        }
    }
}

Executor::State::~State() {
    // Recorded work may name buffers that are about to go. If the device is lost there is nothing
    // to wait for, and a destructor has nobody to tell.
    try {
        finishDevice();
    } catch (const std::exception&) {
    }
}

void Executor::State::makePass(NodeId id) {
    const PlannedNode& node = graph.nodes[id];
    NodeState& state = nodes[id];
    const bool needs_device = node.type->domain == Domain::kDevice || node.on == Placement::kDevice;
    if (needs_device && device == nullptr)
        throw DeviceError("pass \"" + node.name + "\" (" + node.type->name +
                          ") needs a device that rasterises, and there is none; install a Vulkan "
                          "driver (hone doctor says which)");
    const bool is_host = node.type->domain == Domain::kHost || node.on == Placement::kHost;
    state.chosen = needs_device ? device : is_host ? host : kernels;
    state.where = state.chosen == host ? "host" : "device";
    state.may_use_device = device != nullptr && node.type->domain != Domain::kHost;
    state.pass = node.type->create();
}

void Executor::State::bindPorts(NodeId id) {
    const PlannedNode& node = graph.nodes[id];
    NodeState& state = nodes[id];
    for (const PlannedEdge& edge : node.inputs)
        state.inputs.push_back({.name = node.type->inputs[edge.port].name,
                                .element = edge.element,
                                .value = &values[edge.value],
                                .edge_params = &edge.params});
    state.seen_versions.resize(node.inputs.size());
    // Optional inputs that nothing feeds are there, without a value: asking for them is no mistake.
    for (std::size_t i = 0; i < node.type->inputs.size(); ++i)
        if (std::ranges::none_of(node.inputs, [&](const PlannedEdge& e) { return e.port == i; }))
            state.inputs.push_back({.name = node.type->inputs[i].name});
    for (std::size_t i = 0; i < node.outputs.size(); ++i)
        state.outputs.push_back(
            {.name = node.type->outputs[i].name, .value = &values[node.outputs[i].value]});
}

Executor::Executor(CompiledGraph graph, const Catalog& catalog, Devices devices,
                   std::uint64_t seed) {
    HONE_ASSERT(devices.host != nullptr, "an executor needs a host device");
    HONE_ASSERT(catalog.trace_backends != nullptr, "an executor needs a list of trace backends");
    state_ = std::make_unique<State>(std::move(graph), catalog, devices, seed);
}

Executor::~Executor() = default;

void Executor::setScene(const Scene& scene) {
    state_->scene = &scene;
}

void Executor::setCamera(const Camera& camera) {
    static_assert(sizeof(Camera) == 16 * sizeof(float), "compared byte by byte: no padding");
    if (state_->camera && std::memcmp(&*state_->camera, &camera, sizeof camera) == 0)
        return;
    state_->camera = camera;
    const std::uint64_t version = ++state_->last_version;
    for (const NamedValue& input : state_->graph.inputs)
        if (state_->graph.values[input.value].type == types::kCamera) {
            state_->values[input.value].camera = &*state_->camera;
            state_->values[input.value].version = version;
        }
}

void Executor::setExtent(uvec2 extent) {
    HONE_ASSERT(extent.x > 0 && extent.y > 0, "an image has at least one pixel");
    if (state_->extent == extent)
        return;
    state_->extent = extent;
    state_->extent_version = ++state_->last_version;
    for (const NamedValue& input : state_->graph.inputs)
        if (state_->graph.values[input.value].type == types::kExtent) {
            state_->values[input.value].extent = extent;
            state_->values[input.value].version = state_->extent_version;
        }
}

void Executor::setParameter(const std::string& path, const std::string& value) {
    std::vector<NodeId> changed;
    if (const auto problem = assignParam(state_->graph, state_->catalog, path, value, changed))
        throw GraphError(path + "=" + value + ": error " + problem->code + ": " + problem->message +
                         (problem->hint.empty() ? "" : "; " + problem->hint));
    // The loops around a pass run again with it.
    for (NodeId id : changed)
        for (; id != kNoId; id = state_->graph.nodes[id].parent)
            ++state_->nodes[id].params_version;
}

void Executor::resetHistory() {
    for (HistoryState& history : state_->histories)
        history.has_begun = false;
}

void Executor::run(const RunOptions& options) {
    state_->run(options);
}

const Value& Executor::output(std::string_view name) const {
    const auto found = std::ranges::find(state_->graph.outputs, name, &NamedValue::name);
    HONE_ASSERT(found != state_->graph.outputs.end(),
                "the graph has no output \"" + std::string(name) + "\"");
    return state_->values[found->value];
}

const Value* Executor::find(std::string_view node_and_port) const {
    const ValueId id = state_->graph.findValue(node_and_port);
    if (id == kNoId || state_->values[id].version == 0 || !state_->graph.values[id].is_kept)
        return nullptr;
    return &state_->values[id];
}

std::vector<std::string> Executor::outputs() const {
    std::vector<std::string> result;
    for (const NamedValue& output : state_->graph.outputs)
        result.push_back(output.name);
    return result;
}

std::vector<NodeReport> Executor::nodes() const {
    std::vector<std::pair<std::uint32_t, NodeReport>> reports;
    for (NodeId id = 0; id < state_->nodes.size(); ++id) {
        const PlannedNode& node = state_->graph.nodes[id];
        const NodeState& state = state_->nodes[id];
        if (node.culled.empty())
            reports.push_back({node.step,
                               {.name = node.name,
                                .type = node.type != nullptr ? node.type->name : "loop",
                                .runs = state.runs,
                                .ms = state.ms,
                                .where = state.where}});
    }
    std::ranges::sort(reports, {}, [](const auto& report) { return report.first; });
    std::vector<NodeReport> result;
    for (auto& [step, report] : reports)
        result.push_back(std::move(report));
    return result;
}

const Counters& Executor::counters() const {
    return state_->counters;
}
const CompiledGraph& Executor::graph() const {
    return state_->graph;
}
Tracers& Executor::tracers() {
    return state_->tracers;
}

std::size_t Executor::bytesAllocated() const {
    std::size_t total = state_->scene_buffers ? state_->scene_buffers->bytes() : 0;
    for (const Buffer& buffer : state_->memories)
        total += buffer.bytes();
    for (const LoopState& loop : state_->loops)
        for (const StagedValue& staged : loop.staged)
            total += staged.memory.bytes();
    return total;
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
//
// What runs: passes whose inputs changed.
#include "hone/core/error.h"
#include "hone/core/graph/executor_state.h"

#include <algorithm>

namespace hone {
namespace {

double msSince(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
        .count();
}

/// Names a stretch of recorded work, also when it ends with an exception.
class Scope {
public:
    Scope(CommandEncoder* encoder, std::string_view name) : encoder_(encoder) {
        if (encoder_ != nullptr)
            encoder_->beginScope(name);
    }
    ~Scope() noexcept(false) {
        if (encoder_ != nullptr)
            encoder_->endScope();
    }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

private:
    CommandEncoder* encoder_;
};

} // namespace

void Executor::State::run(const RunOptions& run_options) {
    options = &run_options;
    run_began = Clock::now();
    counters.clear();
    for (NodeState& node : nodes)
        node.ms = 0;
    interrupt = {options->cancel, deadlineAfter(run_began, options->max_ms)};
    prepareInputs();
    bool has_looped = false;
    for (const NodeId id : graph.order) {
        has_looped |= graph.nodes[id].loop != kNoId;
        beginHistories(id);
        if ((interrupt.isCancelled() && !has_looped) || !runNode(id, 0))
            break;
    }
    endFrame();
    finishDevice();
    // A hardware device ran on after its passes were recorded; it alone knows how long.
    if (device != nullptr && !devices.raster->info().is_software)
        for (const ScopeTiming& timing : devices.raster->takeTimings())
            for (NodeId id = 0; id < nodes.size(); ++id)
                if (graph.nodes[id].name == timing.name)
                    nodes[id].ms += timing.ms;
}

void Executor::State::prepareInputs() {
    HONE_ASSERT(extent.x > 0, "setExtent() comes before run()");
    for (const NamedValue& input : graph.inputs) {
        if (!graph.values[input.value].is_needed)
            continue;
        Value& value = values[input.value];
        if (value.type->shape == Shape::kCamera)
            HONE_ASSERT(camera.has_value(),
                        "the graph reads a camera: setCamera() comes before run()");
        if (value.type->shape != Shape::kScene)
            continue;
        HONE_ASSERT(scene != nullptr, "the graph reads a scene: setScene() comes before run()");
        if (scene_version != scene->version) {
            finishDevice();
            if (scene_buffers && scene_shape_version == scene->shape_version) {
                scene_buffers->update(*scene);
            } else {
                scene_buffers.reset(); // first, so that not both need memory at once
                scene_buffers.emplace(*memory, *scene);
            }
            scene_version = scene->version;
            scene_shape_version = scene->shape_version;
        }
        // Scene versions are unique in the process, so they need no translation into ours.
        value.scene = scene;
        value.scene_buffers = &*scene_buffers;
        value.version = scene_version;
    }
}

/// Compares what the node would see with what it saw last.
bool Executor::State::seesOther(NodeId id) const {
    const NodeState& state = nodes[id];
    if (state.seen_params != state.params_version || state.seen_extent != extent_version)
        return true;
    const PlannedNode& node = graph.nodes[id];
    for (std::size_t i = 0; i < state.seen_versions.size(); ++i) {
        const ValueId value =
            node.loop == kNoId ? node.inputs[i].value : graph.loops[node.loop].reads[i];
        if (state.seen_versions[i] != values[value].version)
            return true;
    }
    return false;
}

void Executor::State::markSeen(NodeId id) {
    NodeState& state = nodes[id];
    const PlannedNode& node = graph.nodes[id];
    for (std::size_t i = 0; i < state.seen_versions.size(); ++i)
        state.seen_versions[i] =
            values[node.loop == kNoId ? node.inputs[i].value : graph.loops[node.loop].reads[i]]
                .version;
    state.seen_params = state.params_version;
    state.seen_extent = extent_version;
}

bool Executor::State::runNode(NodeId id, uint iteration, bool goes_on) {
    const bool is_loop = graph.nodes[id].loop != kNoId;
    const bool is_due = graph.nodes[id].is_every_iteration && !goes_on;
    const bool is_new = is_due || !nodes[id].has_run || seesOther(id);
    if (!is_new && !(is_loop && loops[graph.nodes[id].loop].is_cut))
        return true;
    const Clock::time_point begin = Clock::now();
    const bool is_done = is_loop ? runLoop(id, is_new) : runPass(id, iteration);
    nodes[id].ms += msSince(begin);
    if (options->on_pass)
        tellOf(id, iteration, begin, is_done);
    return is_done;
}

void Executor::State::tellOf(NodeId id, uint iteration, Clock::time_point begin, bool is_whole) {
    finishDevice();
    options->on_pass({.node = id,
                      .iteration = iteration,
                      .begin = begin,
                      .end = Clock::now(),
                      .is_whole = is_whole,
                      .outputs = nodes[id].outputs});
}

bool Executor::State::runPass(NodeId id, uint iteration) {
    NodeState& state = nodes[id];
    state.has_run = false;
    const bool goes_on = std::exchange(state.gave_up, false) && !seesOther(id);
    if (!goes_on) {
        markSeen(id);
        for (std::size_t port = 0; port < state.outputs.size(); ++port)
            prepareOutput(id, port);
    }
    if (state.chosen == host)
        finishDevice(); // the host must see what the device wrote
    state.gave_up = !execute(id, iteration, goes_on);
    is_device_pending |= state.may_use_device;
    // On a software device nothing is won by waiting later, and time is told by pass.
    if (device != nullptr && devices.raster->info().is_software)
        finishDevice();
    for (const BoundPort& output : state.outputs)
        output.value->version = state.gave_up ? 0 : ++last_version;
    if (state.gave_up)
        return false;
    state.has_run = true;
    ++state.runs;
    return true;
}

/// When a pass is to give up: loops have time limits, and what is changed in place must be
/// finished, for it cannot be done twice.
Interrupt Executor::State::interruptOf(NodeId id) const {
    const PlannedNode& node = graph.nodes[id];
    if (std::ranges::any_of(node.outputs, [](const PlannedOutput& output) {
            return output.in_place != InPlace::kNo;
        }))
        return {};
    return node.parent != kNoId ? interrupt : Interrupt{.cancel = interrupt.cancel};
}

bool Executor::State::execute(NodeId id, uint iteration, bool goes_on) {
    const PlannedNode& node = graph.nodes[id];
    NodeState& state = nodes[id];
    PassContext context;
    context.pass_name = node.name;
    context.type = node.type;
    context.inputs = state.inputs;
    context.outputs = state.outputs;
    context.params = &node.params;
    context.extent = extent;
    context.seed = seed;
    context.memory = memory;
    context.host = host;
    context.device = device;
    context.chosen = state.chosen;
    context.tracers = &tracers;
    context.counters = &counters;
    context.iteration = iteration;
    context.interrupt = interruptOf(id);
    context.goes_on = goes_on;
    is_device_pending |= state.may_use_device; // also if it throws half-way
    const Scope scope(state.chosen == device ? device : nullptr, node.name);
    try {
        state.pass->execute(context);
    } catch (const Interrupted&) {
        return false;
    }
    return true;
}

} // namespace hone

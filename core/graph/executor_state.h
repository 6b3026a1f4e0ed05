// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/graph/executor.h"

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace hone {

/// A pass or loop while its graph runs.
struct NodeState {
    std::unique_ptr<RenderPass> pass; ///< null: a loop, or culled
    std::vector<BoundPort> inputs;
    std::vector<BoundPort> outputs;
    CommandEncoder* chosen = nullptr;
    const char* where = "";
    bool may_use_device = false;

    // What it last ran with.
    std::vector<std::uint64_t> seen_versions; ///< by edge; of a loop by PlannedLoop::reads
    std::uint64_t seen_params = 0;
    std::uint64_t seen_extent = 0;
    bool has_run = false; ///< false also after an exception: its outputs are worth nothing
    bool gave_up = false; ///< it threw Interrupted when it ran last

    std::uint64_t params_version = 1; ///< of a loop: any parameter in it
    std::uint64_t runs = 0;
    double ms = 0;
};

/// A copy of a value, kept while its own memory is overwritten.
struct StagedValue {
    Value value;
    Buffer memory;
};

/// What a value of the last frame holds.
struct HistoryState {
    bool has_begun = false;
    std::uint64_t extent_version = 0; ///< of the frame that it is from
    std::uint64_t source_version = 0;
};

struct LoopState {
    Curve curve;
    std::uint64_t rays = 0;
    std::uint64_t pixels = 0;
    double ms = 0;
    uint iteration = 0;
    bool is_cut = false;      ///< ended by RunOptions, not by its own rules: the next run goes on
    bool is_halfway = false;  ///< cut within an iteration, in this pass of the body:
    std::size_t position = 0; ///< index into PlannedLoop::body
    std::uint64_t worst_expect_bits = 0; ///< of that iteration so far
    std::vector<StagedValue> staged;     ///< by carry; for NextBy::kStagedCopy
};

/// All that an executor owns. Members that passes point at come first, so that passes go first.
struct Executor::State {
    using Clock = std::chrono::steady_clock;

    State(CompiledGraph the_graph, const Catalog& the_catalog, Devices the_devices,
          std::uint64_t the_seed);
    ~State();
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    void makePass(NodeId id);
    void bindPorts(NodeId id);

    void run(const RunOptions& options);
    void prepareInputs();
    void prepareTracers();
    [[nodiscard]] bool seesOther(NodeId id) const;
    void markSeen(NodeId id);

    // Each returns whether it came to its end, or else is to go on in the next run.
    [[nodiscard]] bool runNode(NodeId id, uint iteration, bool goes_on = false);
    void tellOf(NodeId id, uint iteration, Clock::time_point begin, bool is_whole);
    [[nodiscard]] bool runPass(NodeId id, uint iteration);
    [[nodiscard]] bool execute(NodeId id, uint iteration, bool goes_on);
    [[nodiscard]] bool runLoop(NodeId id, bool is_new);
    [[nodiscard]] bool iterate(const PlannedLoop& loop, LoopState& state, bool is_outermost);
    [[nodiscard]] bool runBody(const PlannedLoop& loop, LoopState& state);

    void finishDevice();
    void beginLoop(const PlannedLoop& loop, LoopState& state);
    [[nodiscard]] Interrupt interruptOf(NodeId id) const;
    void carryOver(const PlannedLoop& loop, LoopState& state);
    [[nodiscard]] const char* ruleThatEnds(const PlannedLoop& loop, const LoopState& state) const;
    [[nodiscard]] const char* limitThatEnds(bool is_outermost, uint iterations) const;
    [[nodiscard]] std::uint64_t raysSoFar() const;

    void beginHistories(NodeId before);
    void endFrame();

    void prepareOutput(NodeId id, std::size_t port);
    [[nodiscard]] std::size_t elementsOf(NodeId id, const OutPort& port) const;
    void place(ValueId id, std::size_t elements);
    void makeZero(ValueId id);
    void fill(BufferView target, uint word);
    void copyContent(const Value& from, BufferView to);
    void copyValue(const Value& from, ValueId to);
    void stage(const Value& value, StagedValue& staged);

    CompiledGraph graph;
    Catalog catalog;
    Devices devices;
    std::uint64_t seed;
    Device* memory; ///< where buffers live
    CommandEncoder* host;
    CommandEncoder* device;  ///< null without a raster device
    CommandEncoder* kernels; ///< where kernels run that may run anywhere
    bool is_device_pending = false;

    const Scene* scene = nullptr;
    std::uint64_t scene_version = 0;       ///< of scene_buffers
    std::uint64_t scene_shape_version = 0; ///< the same
    std::optional<SceneBuffers> scene_buffers;
    std::optional<Camera> camera;
    uvec2 extent{0, 0};
    std::uint64_t extent_version = 0;

    std::uint64_t last_version = 0;
    std::vector<Value> values;    ///< by ValueId
    std::vector<Buffer> memories; ///< by CompiledGraph::memories
    std::vector<LoopState> loops;
    std::vector<HistoryState> histories; ///< by CompiledGraph::histories
    Counters counters;
    Tracers tracers;
    std::vector<NodeState> nodes; ///< by NodeId

    const RunOptions* options = nullptr; ///< of the run that goes on
    Clock::time_point run_began;
    Interrupt interrupt; ///< the same in short
};

} // namespace hone

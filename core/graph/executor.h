// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/graph/compiled_graph.h"
#include "hone/core/pass/pass.h"
#include "hone/core/scene/scene_buffers.h"

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace hone {

/// One execution of a pass, or of a loop with all its iterations, told when it is over.
struct PassEvent {
    NodeId node = kNoId; ///< index into Executor::graph().nodes
    uint iteration = 0;  ///< of the loop that it is in, from 1; outside loops 0
    std::chrono::steady_clock::time_point begin, end;
    bool is_whole = true; ///< false: a limit cut it, and its outputs are half-written
    /// By port; of a loop none. What runs next may overwrite their contents.
    std::span<const BoundPort> outputs;
};

/// Limits and callbacks of one run; zero is no limit. They come on top of the graph's own stop
/// rules and are looked at after each iteration of an outermost loop. A loop that one of them cut
/// goes on in the next run; if something that it depends on changed, it begins anew.
///
/// max_ms and cancel also end a pass halfway that can give up (trace does, within 250 ms): its
/// iteration then counts as not yet done, and what the loop carries is what the last whole one left
/// (but for what passes before it in the iteration changed in place, as request its cursor). The
/// next run goes on within the pass and ends at the same bits.
struct RunOptions {
    double max_ms = 0; ///< since run() was called; passes before the first loop run all the same
    std::uint64_t max_rays = 0;
    std::uint64_t max_iterations = 0;
    /// Another thread or a signal handler sets it to end the run ("cancelled"). Before the first
    /// loop began no further pass runs; after that, loops end, and passes behind them still make
    /// their outputs of what is there. May be null.
    const std::atomic<bool>* cancel = nullptr;
    /// Called after each iteration of an outermost loop that did something; returns false to stop
    /// there ("cancelled"). May be empty.
    std::function<bool(const LoopRecord&)> on_iteration{};
    /// Called after each execution of a pass or loop, once the device has finished its work: times
    /// are its own, its outputs may be read, and a hardware device loses its head start. May be
    /// empty, at no cost.
    std::function<void(const PassEvent&)> on_pass{};
    /// For tests: fills what a pass is about to write with NaN bits, so that whoever reads what
    /// was not written, or what another value's memory held, is seen.
    bool poison_outputs = false;
};

/// What one node did, for reports and tests.
struct NodeReport {
    std::string name; ///< "refine.trace"
    std::string type;
    std::uint64_t runs = 0; ///< since the executor was made
    double ms = 0;          ///< in the last run(), all its executions together
    const char* where = ""; ///< "host", "device"
};

/// Runs a compiled graph, again and again, doing only what is needed: a pass runs when one of its
/// inputs, its parameters or the extent changed since it last ran. Owns the memory of all values.
/// One thread at a time.
///
/// What passes tell it through their counters: "rays.KIND" (all kinds count for limits of rays and
/// LoopRecord::rays), "pixels" (requested; LoopRecord::pixels), "worst_expect_bits" (the bits of a
/// float >= 0; LoopRecord::worst_expect).
class Executor {
public:
    /// Throws GraphError for a graph that can only be used as a pass of another, for its inputs are
    /// more than scene, camera and extent.
    Executor(CompiledGraph graph, const Catalog& catalog, Devices devices, std::uint64_t seed = 0);
    ~Executor();
    Executor(const Executor&) = delete;
    Executor& operator=(const Executor&) = delete;

    /// Values of the graph's inputs. The scene must outlive the executor; a changed Scene::version
    /// counts as a change.
    void setScene(const Scene& scene);
    void setCamera(const Camera& camera);
    void setExtent(uvec2 extent);
    /// A pass's or graph's parameter as in Overrides; only what depends on it runs again. Throws
    /// GraphError.
    void setParameter(const std::string& path, const std::string& value);

    /// Does before its time what the next run() would do at its first need: brings the scene to the
    /// devices and builds the tracers that passes name. Throws what run() throws.
    void prepare();
    /// One frame: runs to the end of every loop, or to a limit. At its end values of the last frame
    /// ("pass.port@-1") become those of this one. Throws DeviceError, SceneError, OutOfMemory. A
    /// steady-state run (nothing grew) does no heap allocation of its own.
    void run(const RunOptions& options = {});

    /// Values of the last frame begin anew in the next run(): after a cut, or for another scene.
    void resetHistory();

    /// The value of a graph output after run(); its version is 0 if a cancelled run did not come to
    /// write it. Throws std::logic_error for an unknown name.
    [[nodiscard]] const Value& output(std::string_view name) const;
    /// Any pass's output by "pass.port" or "loop.pass.port", after run(); null when culled, unknown
    /// or overwritten by a value that shares its memory (dump() tells which do).
    [[nodiscard]] const Value* find(std::string_view node_and_port) const;
    [[nodiscard]] std::vector<std::string> outputs() const;
    [[nodiscard]] std::vector<NodeReport> nodes() const;
    [[nodiscard]] const Counters& counters() const; ///< of the last run
    [[nodiscard]] const CompiledGraph& graph() const;
    [[nodiscard]] std::size_t bytesAllocated() const;
    /// What exists twice or was carried between memories so far. After prepare() all that can be
    /// known before a run; lists of rays are known once they were asked.
    [[nodiscard]] std::vector<MemoryCopy> copies() const;
    [[nodiscard]] Tracers& tracers();

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace hone

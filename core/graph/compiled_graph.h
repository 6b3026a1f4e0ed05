// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/graph/diagnostics.h"
#include "hone/core/graph/graph_desc.h"
#include "hone/core/math.h"
#include "hone/core/pass/pass_type.h"
#include "hone/core/pass/shader_pass.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace hone {

/// What a program offers to graphs.
struct Catalog {
    const PassRegistry* passes = nullptr;
    const TraceBackendRegistry* trace_backends = nullptr;
    const ShaderCompiler* shaders = nullptr; ///< null: passes of type "glsl" are refused
    std::string graphs{};                    ///< folder of graphs that any may use; "": none
};

/// Overrides in the order given: {"batch", "4096"} sets a graph parameter, {"refine.trace.exact",
/// "true"} or
/// {"raster.culling", ...} a pass's parameter.
using Overrides = std::vector<std::pair<std::string, std::string>>;

using NodeId = std::uint32_t;  ///< index into CompiledGraph::nodes
using ValueId = std::uint32_t; ///< index into CompiledGraph::values
inline constexpr std::uint32_t kNoId = 0xffffffffu;

/// One edge into a pass.
struct PlannedEdge {
    std::uint32_t port = 0;    ///< index into PassType::inputs
    std::uint32_t element = 0; ///< which edge of a variadic input
    ValueId value = kNoId;
    std::vector<ParamValue> params; ///< in the order of InPort::edge_params
};

/// How an output that updates an input in place gets its memory.
enum class InPlace : std::uint8_t {
    kNo,
    kTakesOver, ///< nobody reads the input afterwards: the output is the input's memory
    kCopies,    ///< the input's content is copied into the output's memory first
};

struct PlannedOutput {
    ValueId value = kNoId;
    InPlace in_place = InPlace::kNo;
    ValueId in_place_of = kNoId;
};

/// Where a node's kernels run, as the graph file wishes.
enum class Placement : std::uint8_t { kAuto, kHost, kDevice };

/// A pass or a loop of the graph.
struct PlannedNode {
    std::string name;               ///< "refine.trace"
    const PassType* type = nullptr; ///< null: a loop (or, before errors are out, an unknown type)
    NodeId parent = kNoId;          ///< the loop that it is in
    std::uint32_t loop = kNoId;     ///< index into CompiledGraph::loops, if it is one
    std::uint32_t graph = kNoId;    ///< index into CompiledGraph::graphs: the innermost it is in
    std::vector<PlannedEdge> inputs;
    std::vector<PlannedOutput> outputs; ///< by port
    PassParams params;
    Placement on = Placement::kAuto;
    std::string culled; ///< why it does not run; "" if it does
    /// Runs in every iteration of its loop, whether its inputs changed or not, because its outputs
    /// share memory with others.
    bool is_every_iteration = false;
    std::uint32_t step =
        0; ///< position in the flattened order, from 1; a loop's is where it begins
};

enum class NextBy : std::uint8_t {
    kKept,    ///< next is the carried value itself
    kInPlace, ///< next was written into the carried value's memory
    kCopy,
    kStagedCopy, ///< through scratch memory: another carried value's copy would overwrite it
};

/// A value that a loop carries from iteration to iteration; after the loop its output.
struct PlannedCarry {
    std::string name;
    ValueId value = kNoId;
    ValueId initial = kNoId; ///< copied in when the loop begins; kNoId: zeroes
    ValueId next = kNoId;
    NextBy next_by = NextBy::kCopy;
    bool is_culled = false;
};

struct StopRule {
    enum class Kind : std::uint8_t { kEmpty, kBelow, kRays, kMs, kIterations };
    Kind kind = Kind::kIterations;
    ValueId value = kNoId; ///< kEmpty: a list; kBelow: a Scalar
    double limit = 0;      ///< all but kEmpty; 0 = no limit
};

struct PlannedLoop {
    NodeId node = kNoId;
    std::vector<PlannedCarry> carries;
    std::vector<StopRule> stop; ///< in the order of the file: the first that holds names the reason
    std::uint32_t check_every = 1;
    ValueId stats = kNoId;
    std::vector<NodeId> body;    ///< in order
    std::vector<ValueId> reads;  ///< outside values that the body and the initial values read
    std::uint32_t last_step = 0; ///< of its body
};

/// A value of the frame before: "pass.port@-1".
struct PlannedHistory {
    ValueId value = kNoId;
    ValueId source = kNoId;   ///< copied in at the end of each frame
    ValueId initial = kNoId;  ///< what it is in the first frame; kNoId: zeroes
    NodeId begins_at = kNoId; ///< the first of CompiledGraph::order that needs it; kNoId: culled
};

struct PlannedValue {
    std::string name; ///< "raster.color", "refine.image", "$scene"
    PortType type = types::kScene;
    NodeId writer = kNoId;        ///< the pass, or the loop that carries it; kNoId: a graph input
    NodeId scope = kNoId;         ///< the loop whose iterations write it anew; kNoId: outside
    std::uint32_t memory = kNoId; ///< index into CompiledGraph::memories; kNoId: has no elements
    std::uint32_t first_step = 0; ///< written
    std::uint32_t last_step = 0;  ///< last read
    bool is_needed = false;
    bool is_kept = true; ///< false: its memory belongs to others after last_step
};

/// Memory of one value, or of several whose lifetimes do not touch.
struct PlannedMemory {
    Shape shape = Shape::kPlane;
    std::uint32_t stride = 0; ///< the greatest of its values
    std::vector<ValueId> values;
};

struct NamedValue {
    std::string name;
    ValueId value = kNoId;
};

/// A graph that is used as a pass: its passes are nodes like all others, and bear its name.
struct PlannedGraph {
    std::string name;            ///< "refine": of "refine.loop.trace"
    std::string file;            ///< as it was written: "parts/refine.json"
    NodeId parent = kNoId;       ///< the loop that it is in
    std::uint32_t graph = kNoId; ///< index into CompiledGraph::graphs: the one that it is in
    std::vector<NamedValue> outputs;
};

/// One place that a graph parameter feeds.
struct ParamUse {
    NodeId node = kNoId;
    std::uint32_t param = kNoId; ///< of the pass
    std::uint32_t edge = kNoId;  ///< or: of this edge ...
    std::uint32_t edge_param = kNoId;
    std::uint32_t stop_rule = kNoId;   ///< or: the limit of this loop's rule
    std::uint32_t graph_param = kNoId; ///< or: this parameter, of a graph that is used as a pass
    Place place;
};

struct PlannedParam {
    ParamDecl decl; ///< choices filled in
    ParamValue value = 0.0f;
    std::vector<ParamUse> uses;
    bool is_switch = false; ///< passes come and go with it: it cannot change once compiled
};

/// A checked and planned graph. Plain data; refers to the pass registry, which must outlive it.
struct CompiledGraph {
    std::string name;
    std::string doc;
    std::string file;
    std::vector<PlannedParam> params;
    std::vector<PlannedNode> nodes; ///< in the order of the file, a loop before its body
    std::vector<PlannedLoop> loops;
    std::vector<PlannedGraph> graphs; ///< one before those that it uses
    std::vector<PlannedHistory> histories;
    std::vector<PlannedValue> values;
    std::vector<PlannedMemory> memories;
    std::vector<NamedValue> inputs;  ///< types kScene, kCamera, kExtent
    std::vector<NamedValue> outputs; ///< in the order of the file
    std::vector<NodeId> order;       ///< outside loops
    /// Of passes of type "glsl"; copies of a graph share them.
    std::vector<std::shared_ptr<const PassType>> shader_types;

    [[nodiscard]] const PlannedNode* findNode(std::string_view node_name) const;
    [[nodiscard]] const PlannedParam* findParam(std::string_view param) const;
    /// By "pass.port", "loop.carried", "loop.stats", "loop.pass.port", "graph.output" or "$input".
    [[nodiscard]] ValueId findValue(std::string_view value_name) const;
    /// All that findValue() knows. What is switched off is not there.
    [[nodiscard]] std::vector<NamedValue> namedValues() const;
};

/// Checks a graph and plans it: names resolved, types and parameters checked, unused passes culled,
/// order, lifetimes, shared memory. Opens no device, makes no pass. Immutable afterwards. All
/// problems found are added to `diagnostics`; the result is only usable if none is an error.
///
/// Phases: resolve (names, edges), infer (types, parameters), order and cull, plan (memory,
/// copies); parseGraph() did parse and upgrade, an Executor instantiates. A `schedule_seed` other
/// than 0 takes another legal order than the file's, for tests: results must not depend on it.
[[nodiscard]] CompiledGraph compile(const GraphDesc& desc, const Catalog& catalog,
                                    const Overrides& overrides,
                                    std::vector<Diagnostic>& diagnostics,
                                    std::uint64_t schedule_seed = 0);

/// compile for a graph of which reading found `diagnostics`; throws GraphError with the whole
/// report if anything is an error; warnings are logged.
[[nodiscard]] CompiledGraph compileOrThrow(const GraphDesc& desc, const Catalog& catalog,
                                           const Overrides& overrides,
                                           std::vector<Diagnostic> diagnostics);
/// parseGraphFile and compileOrThrow.
[[nodiscard]] CompiledGraph loadGraph(const std::string& path, const Catalog& catalog,
                                      const Overrides& overrides);

/// The plan as stable text: order, culled passes with reasons, lifetimes, memory, copies. With an
/// extent also what memories take for images of that size.
[[nodiscard]] std::string dump(const CompiledGraph& graph, uvec2 extent = {0, 0});

/// When a loop ends: "refine.request.requests is empty or 64 iterations, no limit of ms".
[[nodiscard]] std::string stopText(const CompiledGraph& graph, const PlannedLoop& loop);

} // namespace hone

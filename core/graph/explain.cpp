// SPDX-License-Identifier: Apache-2.0
//
// Reads the plan backwards: from what was decided to the reasons, which are those of
// cull_nodes.cpp, order_nodes.cpp and plan_memory.cpp.
#include "hone/core/graph/explain.h"

#include <algorithm>
#include <limits>

namespace hone {
namespace {

constexpr std::uint32_t kForever = std::numeric_limits<std::uint32_t>::max();

/// One read of a value.
struct Reader {
    std::string text;           ///< "refine.blend, step 9"
    NodeId node = kNoId;        ///< a pass; kNoId: a loop's carry or stop, or an output
    std::uint32_t step = 0;     ///< kForever: an output of the graph
    bool is_after_loop = false; ///< read outside the loop that writes it
    bool is_culled = false;
};

class Explanation {
public:
    explicit Explanation(const CompiledGraph& graph) : graph_(&graph) {}

    std::string ofNode(NodeId id) {
        const PlannedNode& node = graph_->nodes[id];
        const bool is_loop = node.loop != kNoId;
        text_ = node.name + ": " +
                (is_loop ? "loop" : "pass of type " + node.type->name + ": " + node.type->doc) +
                "\n";
        if (!node.culled.empty()) {
            row("does not run", whyCulled(id));
            return text_;
        }
        row("runs", "at " + stepOf(node) + whenInLoop(node.parent));
        row("waits for", waitsFor(id));
        row("why there", whyThere(id));
        if (!is_loop) {
            row("where", whyWhere(node));
            row("again", node.is_every_iteration
                             ? "in every iteration, changed or not: its outputs share memory with "
                               "other values"
                             : "only when an input, a parameter or the image's size changed");
        } else {
            row("again", "goes on where a limit cut it; begins anew when something that its passes "
                         "read from outside changed");
        }
        for (const PlannedEdge& edge : node.inputs)
            row("reads", node.type->inputs[edge.port].name + " = " + valueName(edge.value));
        for (const PlannedOutput& output : node.outputs)
            row("writes", valueName(output.value) + copyNote(output));
        if (is_loop)
            for (const PlannedCarry& carry : graph_->loops[node.loop].carries)
                row("carries", valueName(carry.value) +
                                   (carry.is_culled ? " (not carried: no output needs it)" : ""));
        return text_;
    }

    std::string ofValue(ValueId id) {
        const PlannedValue& v = graph_->values[id];
        text_ = v.name + ": " + describe(v.type) + "\n";
        row("written by", writerOf(id));
        for (const NamedValue& output : graph_->outputs)
            if (output.value == id)
                row("output", "\"" + output.name + "\" of the graph");
        const std::vector<Reader> readers = readersOf(id);
        for (const Reader& reader : readers)
            row("read by", reader.text);
        if (!v.is_needed) {
            row("not made", v.writer == kNoId ? "nothing that runs reads it" : whyCulled(v.writer));
            return text_;
        }
        if (readers.empty())
            row("read by",
                v.writer == kNoId || graph_->nodes[v.writer].loop != kNoId
                    ? "nothing"
                    : "nothing; " + graph_->nodes[v.writer].name +
                          " runs for its other outputs and writes this one all the same");
        if (v.writer != kNoId)
            row("needed",
                "from step " + std::to_string(v.first_step) +
                    (v.last_step == kForever ? " to the end"
                                             : " to step " + std::to_string(v.last_step)));
        if (v.memory != kNoId)
            explainMemory(id);
        explainCopies(id);
        return text_;
    }

private:
    void row(const std::string& label, const std::string& text) {
        if (text.empty())
            return;
        constexpr std::size_t kWidth = 13;
        const bool is_same = label == last_label_;
        last_label_ = label;
        std::string head = is_same ? "" : label;
        head.resize(std::max(kWidth, head.size() + 1), ' ');
        text_ += "  " + head + text + "\n";
    }

    const std::string& valueName(ValueId id) const { return graph_->values[id].name; }

    static std::string stepOf(const PlannedNode& node) {
        return "step " + std::to_string(node.step);
    }

    std::string whenInLoop(NodeId loop) const {
        return loop == kNoId ? "" : ", in the iterations of " + graph_->nodes[loop].name;
    }

    bool isInside(NodeId node, NodeId scope) const {
        for (; node != kNoId; node = graph_->nodes[node].parent)
            if (node == scope)
                return true;
        return scope == kNoId;
    }

    // ---- culled

    /// The reason, and the reasons of those that read it, down to the last.
    std::string whyCulled(NodeId id, int depth = 0) const {
        const PlannedNode& node = graph_->nodes[id];
        std::string text = node.culled;
        if (node.culled.empty() || depth > 8)
            return text.empty() ? "no output of the graph needs it" : text;
        if (node.parent != kNoId && !graph_->nodes[node.parent].culled.empty())
            return text + "; " + graph_->nodes[node.parent].name + ": " +
                   whyCulled(node.parent, depth + 1);
        for (NodeId other = 0; other < graph_->nodes.size(); ++other)
            if (other != id && !graph_->nodes[other].culled.empty() && readsFrom(other, id))
                return text + "; " + graph_->nodes[other].name + ": " + whyCulled(other, depth + 1);
        return text;
    }

    bool readsFrom(NodeId reader, NodeId writer) const {
        return std::ranges::any_of(graph_->nodes[reader].inputs, [&](const PlannedEdge& edge) {
            return edge.value != kNoId && graph_->values[edge.value].writer == writer;
        });
    }

    // ---- order

    /// The node of the same scope as `id` that must come first, for a value that `id` reads.
    NodeId before(NodeId id, ValueId value) const {
        NodeId writer = value == kNoId ? kNoId : graph_->values[value].writer;
        const NodeId scope = graph_->nodes[id].parent;
        while (writer != kNoId && graph_->nodes[writer].parent != scope)
            writer = graph_->nodes[writer].parent;
        return writer == id ? kNoId : writer;
    }

    /// What a node of its scope waits for, with the value that makes it wait.
    std::vector<std::pair<NodeId, ValueId>> dependencies(NodeId id) const {
        std::vector<std::pair<NodeId, ValueId>> found;
        const auto add = [&](ValueId value) {
            const NodeId first = before(id, value);
            if (first != kNoId && first != graph_->nodes[id].parent &&
                std::ranges::none_of(found,
                                     [&](const auto& known) { return known.first == first; }))
                found.emplace_back(first, value);
        };
        for (const PlannedEdge& edge : graph_->nodes[id].inputs)
            add(edge.value);
        if (graph_->nodes[id].loop != kNoId)
            for (const ValueId value : graph_->loops[graph_->nodes[id].loop].reads)
                add(value);
        std::ranges::sort(found, {}, [&](const auto& d) { return graph_->nodes[d.first].step; });
        return found;
    }

    std::string waitsFor(NodeId id) const {
        std::string text;
        for (const auto& [first, value] : dependencies(id))
            text += (text.empty() ? "" : "; ") + graph_->nodes[first].name + " (" +
                    stepOf(graph_->nodes[first]) + "), which writes " + valueName(value);
        return text.empty() ? "nothing" : text;
    }

    std::string whyThere(NodeId id) const {
        const PlannedNode& node = graph_->nodes[id];
        const std::vector<NodeId>& order =
            node.parent == kNoId ? graph_->order
                                 : graph_->loops[graph_->nodes[node.parent].loop].body;
        const auto here = std::ranges::find(order, id);
        if (here == order.begin())
            return "it waits for nothing, and of such passes it stands first in the file";
        const NodeId previous = here[-1];
        const auto waits = dependencies(id);
        if (!waits.empty() && waits.back().first == previous)
            return "right after " + graph_->nodes[previous].name + ", the last that it waits for";
        return "it could run earlier; of passes that could run next, the first in the file does, "
               "which was " +
               graph_->nodes[previous].name;
    }

    static std::string whyWhere(const PlannedNode& node) {
        if (node.on == Placement::kHost)
            return "on the host, as the graph says (\"on\": \"host\")";
        if (node.on == Placement::kDevice)
            return "on the device, as the graph says (\"on\": \"device\")";
        switch (node.type->domain) {
        case Domain::kHost:
            return "on the host: it has no code for a device";
        case Domain::kDevice:
            return "on the device: it has no code for the host";
        case Domain::kEither:
            break;
        }
        return "on a hardware device where there is one, else on the host: it has code for both "
               "(\"on\" decides otherwise)";
    }

    // ---- values

    std::string writerOf(ValueId id) const {
        const PlannedValue& v = graph_->values[id];
        if (const PlannedHistory* history = historyOf(id))
            return "the last frame, at whose end " + valueName(history->source) +
                   " is copied; in the first it is " +
                   (history->initial == kNoId ? "zeroes" : valueName(history->initial));
        if (v.writer == kNoId)
            return "nobody: it is an input of the graph";
        const PlannedNode& writer = graph_->nodes[v.writer];
        if (!writer.culled.empty())
            return writer.name + ", which does not run";
        if (writer.loop == kNoId)
            return writer.name + " (" + writer.type->name + ") at " + stepOf(writer) +
                   whenInLoop(writer.parent);
        for (const PlannedCarry& carry : graph_->loops[writer.loop].carries)
            if (carry.value == id)
                return "loop " + writer.name + ": first " +
                       (carry.initial == kNoId ? "zeroes" : valueName(carry.initial)) +
                       ", after each iteration " +
                       (carry.next == id || carry.next == kNoId ? "what it was"
                                                                : valueName(carry.next));
        return "loop " + writer.name + ": one record an iteration";
    }

    const PlannedHistory* historyOf(ValueId id) const {
        const auto found = std::ranges::find(graph_->histories, id, &PlannedHistory::value);
        return found != graph_->histories.end() ? &*found : nullptr;
    }

    std::vector<Reader> readersOf(ValueId id) const {
        std::vector<Reader> readers;
        const NodeId scope = graph_->values[id].scope;
        const auto add = [&](std::string text, NodeId node, NodeId reader_scope, std::uint32_t step,
                             bool is_culled) {
            readers.push_back(
                {std::move(text), node, step, !isInside(reader_scope, scope), is_culled});
        };
        for (NodeId n = 0; n < graph_->nodes.size(); ++n) {
            const PlannedNode& node = graph_->nodes[n];
            for (const PlannedEdge& edge : node.inputs)
                if (edge.value == id)
                    add(node.name + " as " + node.type->inputs[edge.port].name +
                            (node.culled.empty() ? " at " + stepOf(node)
                                                 : ", which does not run: " + node.culled),
                        n, node.parent, node.step, !node.culled.empty());
            if (node.loop == kNoId)
                continue;
            const PlannedLoop& loop = graph_->loops[node.loop];
            const bool is_culled = !node.culled.empty();
            for (const PlannedCarry& carry : loop.carries) {
                const bool is_off = is_culled || carry.is_culled;
                if (carry.initial == id)
                    add("loop " + node.name + ", which begins with it as " + valueName(carry.value),
                        kNoId, node.parent, node.step, is_off);
                if (carry.next == id && carry.value != id)
                    add("loop " + node.name + ", which carries it on as " + valueName(carry.value),
                        kNoId, n, loop.last_step, is_off);
            }
            for (const StopRule& rule : loop.stop)
                if (rule.value == id)
                    add("loop " + node.name + ", whose stop rule looks at it", kNoId, n,
                        loop.last_step, is_culled);
        }
        for (const PlannedHistory& history : graph_->histories) {
            const bool is_culled = history.begins_at == kNoId;
            if (history.source == id)
                add("the next frame, as " + valueName(history.value), kNoId, kNoId,
                    is_culled ? 0 : kForever, is_culled);
            if (history.initial == id)
                add("the first frame, as " + valueName(history.value), kNoId, kNoId,
                    is_culled ? 0 : graph_->nodes[history.begins_at].step, is_culled);
        }
        for (const NamedValue& output : graph_->outputs)
            if (output.value == id)
                add("", kNoId, kNoId, kForever, false);
        return readers;
    }

    // ---- memory

    void explainMemory(ValueId id) {
        const PlannedValue& v = graph_->values[id];
        const PlannedMemory& memory = graph_->memories[v.memory];
        const char* const element = memory.shape == Shape::kPlane  ? " B a pixel"
                                    : memory.shape == Shape::kList ? " B a list element"
                                                                   : " B a record element";
        std::string others;
        for (const ValueId other : memory.values)
            if (other != id)
                others += (others.empty() ? "" : ", ") + valueName(other) + " (steps " +
                          std::to_string(graph_->values[other].first_step) + " to " +
                          (graph_->values[other].last_step == kForever
                               ? "end"
                               : std::to_string(graph_->values[other].last_step)) +
                          ")";
        row("memory",
            std::to_string(v.memory) + ", " + std::to_string(memory.stride) + element +
                (others.empty() ? ", its own: " + whyAlone(id) : ", shared with " + others));
        if (!others.empty())
            row("", "each is written after the one before was last read, or updates it in place");
        if (!v.is_kept)
            row("", "gone after the loop: another value took its memory");
    }

    std::string whyAlone(ValueId id) const {
        const PlannedValue& v = graph_->values[id];
        if (v.scope == kNoId)
            return "outside loops a value is kept, so that its pass need not run again as long as "
                   "nothing changed";
        if (v.writer == v.scope)
            return "a carried value keeps its memory through all iterations";
        for (const Reader& reader : readersOf(id))
            if (reader.is_after_loop && !reader.is_culled)
                return "it is read after the loop";
        if (!isVarying(v.writer, v.scope))
            return "it does not change while " + graph_->nodes[v.scope].name +
                   " iterates, so it is made once and kept";
        return "no memory of its kind was free while it is needed";
    }

    /// Does a pass of a loop see anything that changes while the loop iterates?
    bool isVarying(NodeId id, NodeId loop) const {
        return std::ranges::any_of(graph_->nodes[id].inputs, [&](const PlannedEdge& edge) {
            const NodeId writer = edge.value == kNoId ? kNoId : graph_->values[edge.value].writer;
            if (writer == kNoId || !isInside(writer, loop))
                return false;
            if (writer != loop)
                return graph_->nodes[writer].loop != kNoId || isVarying(writer, loop);
            for (const PlannedCarry& carry : graph_->loops[graph_->nodes[loop].loop].carries)
                if (carry.value == edge.value)
                    return carry.next != edge.value;
            return true;
        });
    }

    // ---- copies

    std::string copyNote(const PlannedOutput& output) const {
        if (output.in_place == InPlace::kTakesOver)
            return ", in place of " + valueName(output.in_place_of);
        if (output.in_place == InPlace::kCopies)
            return ", a copy of " + valueName(output.in_place_of) + " that it updates";
        return "";
    }

    void explainCopies(ValueId id) {
        const PlannedValue& v = graph_->values[id];
        if (v.writer == kNoId)
            return;
        const PlannedNode& writer = graph_->nodes[v.writer];
        for (const PlannedOutput& output : writer.outputs) {
            if (output.value != id)
                continue;
            if (output.in_place == InPlace::kTakesOver)
                row("in place", writer.name + " updates " + valueName(output.in_place_of) +
                                    " where it lies: nothing else reads that any more");
            if (output.in_place == InPlace::kCopies)
                row("copied", writer.name + " updates a copy of " + valueName(output.in_place_of) +
                                  ": " + whyCopied(v.writer, output));
        }
        if (writer.loop == kNoId)
            return;
        for (const PlannedCarry& carry : graph_->loops[writer.loop].carries) {
            if (carry.value != id || carry.is_culled)
                continue;
            if (carry.initial != kNoId)
                row("copied", valueName(carry.initial) + " when " + writer.name +
                                  " begins: the loop may begin again, and what it begins with must "
                                  "still be there");
            if (carry.next_by == NextBy::kInPlace)
                row("in place", valueName(carry.next) + " was written into its memory");
            if (carry.next_by == NextBy::kCopy || carry.next_by == NextBy::kStagedCopy)
                row("copied", valueName(carry.next) +
                                  " after each iteration: it lies in other memory, because no pass "
                                  "updates " +
                                  v.name + " in place to it");
            if (carry.next_by == NextBy::kStagedCopy)
                row("", "through scratch memory: another carried value's copy would overwrite it");
        }
    }

    std::string whyCopied(NodeId id, const PlannedOutput& output) const {
        const PlannedNode& node = graph_->nodes[id];
        const PlannedValue& input = graph_->values[output.in_place_of];
        if (node.parent == kNoId)
            return "outside loops passes run only when something changed, so what they read stays "
                   "as it was";
        if (input.scope != node.parent)
            return input.name + " comes from outside " + graph_->nodes[node.parent].name +
                   ", and every iteration needs it as it was";
        for (const PlannedNode& other : graph_->nodes)
            for (const PlannedOutput& taken : other.outputs)
                if (&other != &node && taken.in_place == InPlace::kTakesOver &&
                    taken.in_place_of == output.in_place_of)
                    return other.name + " already updates it in place";
        for (const Reader& reader : readersOf(output.in_place_of)) {
            if (reader.is_culled)
                continue;
            // A carried value has memory for what is read after the loop; others have not.
            if (reader.is_after_loop && input.writer != input.scope)
                return input.name + " is read after the loop";
            if (reader.node != id && !reader.is_after_loop && reader.step >= node.step)
                return "it is still read by " + reader.text;
        }
        if (std::ranges::count(node.inputs, output.in_place_of, &PlannedEdge::value) > 1)
            return "another input of " + node.name + " reads it, too";
        for (const Reader& reader : readersOf(output.value))
            if (reader.is_after_loop && !reader.is_culled)
                return valueName(output.value) +
                       " is read after the loop, when the memory holds the carried value";
        return input.name +
               " does not change from iteration to iteration: it is made once and kept";
    }

    const CompiledGraph* graph_;
    std::string text_;
    std::string last_label_;
};

} // namespace

std::optional<std::string> explain(const CompiledGraph& graph, std::string_view name) {
    for (NodeId id = 0; id < graph.nodes.size(); ++id)
        if (graph.nodes[id].name == name)
            return Explanation(graph).ofNode(id);
    if (const ValueId id = graph.findValue(name); id != kNoId)
        return Explanation(graph).ofValue(id);
    for (const NamedValue& output : graph.outputs)
        if (output.name == name)
            return Explanation(graph).ofValue(output.value);
    return std::nullopt;
}

std::vector<std::string> explainable(const CompiledGraph& graph) {
    std::vector<std::string> names;
    for (const PlannedNode& node : graph.nodes)
        names.push_back(node.name);
    for (const NamedValue& value : graph.namedValues())
        names.push_back(value.name);
    for (const NamedValue& output : graph.outputs)
        names.push_back(output.name);
    return names;
}

} // namespace hone

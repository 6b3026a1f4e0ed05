// SPDX-License-Identifier: Apache-2.0
#include "hone/core/graph/compiled_graph.h"

#include <algorithm>

namespace hone {
namespace {

const char* shapeName(Shape shape) {
    switch (shape) {
    case Shape::kPlane:
        return "plane";
    case Shape::kList:
        return "list";
    case Shape::kRecord:
        return "record";
    default:
        return "";
    }
}

std::string pad(std::string text, std::size_t width) {
    text.resize(std::max(text.size(), width), ' ');
    return text;
}

class Dump {
public:
    explicit Dump(const CompiledGraph& graph) : graph_(&graph) {}

    std::string text() {
        text_ = "graph " + (graph_->name.empty() ? std::string("(no name)") : graph_->name) + "\n";
        section("order");
        writeOrder(graph_->order, 1);
        section("culled");
        for (const PlannedNode& node : graph_->nodes)
            if (!node.culled.empty())
                line(node.name + ": " + node.culled);
        for (const PlannedLoop& loop : graph_->loops)
            if (graph_->nodes[loop.node].culled.empty())
                for (const PlannedCarry& carry : loop.carries)
                    if (carry.is_culled)
                        line(graph_->values[carry.value].name +
                             ": carried, but no output needs it");
        section("values");
        for (const PlannedValue& value : graph_->values)
            if (value.is_needed)
                writeValue(value);
        section("memory");
        for (std::size_t i = 0; i < graph_->memories.size(); ++i)
            writeMemory(i);
        writeSaved();
        section("copies");
        writeCopies();
        writeHistories();
        section("outputs");
        for (const NamedValue& output : graph_->outputs)
            line(output.name + " = " + graph_->values[output.value].name);
        return text_;
    }

private:
    /// A title that is written with its first line, so that empty sections do not show.
    void section(std::string title) { title_ = std::move(title); }

    void line(const std::string& text) {
        if (!title_.empty())
            text_ += title_ + "\n";
        title_.clear();
        text_ += "  " + text + "\n";
    }

    void writeOrder(const std::vector<NodeId>& order, std::size_t depth) {
        for (const NodeId id : order) {
            const PlannedNode& node = graph_->nodes[id];
            const std::string indent(2 * (depth - 1), ' ');
            std::string text = pad(std::to_string(node.step), 4) + indent + node.name;
            if (node.loop == kNoId) {
                line(text + " (" + node.type->name + ")" + placement(node));
                continue;
            }
            const PlannedLoop& loop = graph_->loops[node.loop];
            line(text + " (loop to step " + std::to_string(loop.last_step) + stopRules(loop) + ")");
            writeOrder(loop.body, depth + 1);
        }
    }

    static std::string placement(const PlannedNode& node) {
        std::string text;
        if (node.on == Placement::kHost)
            text += " on host";
        if (node.on == Placement::kDevice)
            text += " on device";
        return text;
    }

    std::string stopRules(const PlannedLoop& loop) const {
        std::string text;
        for (const StopRule& rule : loop.stop) {
            text += text.empty() ? "; until " : " or ";
            if (rule.kind == StopRule::Kind::kEmpty) {
                text += graph_->values[rule.value].name + " is empty";
                continue;
            }
            if (rule.kind == StopRule::Kind::kBelow) {
                text += graph_->values[rule.value].name + " is below " + number(rule.limit);
                continue;
            }
            text += rule.limit == 0 ? "no limit of " : number(rule.limit) + " ";
            text += rule.kind == StopRule::Kind::kRays ? "rays"
                    : rule.kind == StopRule::Kind::kMs ? "ms"
                                                       : "iterations";
        }
        if (loop.check_every != 1)
            text += ", checked every " + std::to_string(loop.check_every);
        return text;
    }

    static std::string number(double limit) {
        const auto whole = static_cast<std::uint64_t>(limit);
        return static_cast<double>(whole) == limit ? std::to_string(whole) : std::to_string(limit);
    }

    void writeValue(const PlannedValue& value) {
        constexpr std::uint32_t kForever = 0xffffffffu;
        const std::string last =
            value.last_step == kForever ? "end" : std::to_string(value.last_step);
        std::string text = pad(value.name, 26) + " " + pad(std::string(value.type.name), 16) +
                           " steps " + std::to_string(value.first_step) + " to " + last;
        if (value.memory != kNoId)
            text += ", memory " + std::to_string(value.memory);
        line(text);
    }

    void writeMemory(std::size_t index) {
        const PlannedMemory& memory = graph_->memories[index];
        std::string text = pad(std::to_string(index), 4) + pad(shapeName(memory.shape), 7) +
                           std::to_string(memory.stride) + " B  ";
        for (const ValueId id : memory.values) {
            if (id != memory.values.front())
                text += ", ";
            text += graph_->values[id].name;
            if (takesOver(id))
                text += " (in place)";
        }
        line(text);
    }

    bool takesOver(ValueId id) const {
        const NodeId writer = graph_->values[id].writer;
        return writer != kNoId &&
               std::ranges::any_of(graph_->nodes[writer].outputs, [&](const PlannedOutput& o) {
                   return o.value == id && o.in_place == InPlace::kTakesOver;
               });
    }

    /// What the values would take if each had memory of its own, and what they take.
    void writeSaved() {
        for (const Shape shape : {Shape::kPlane, Shape::kList, Shape::kRecord}) {
            std::size_t alone = 0;
            std::size_t shared = 0;
            for (const PlannedMemory& memory : graph_->memories) {
                if (memory.shape != shape)
                    continue;
                shared += memory.stride;
                for (const ValueId id : memory.values)
                    alone += graph_->values[id].type.stride;
            }
            if (alone > shared)
                line(std::string("saved: ") + std::to_string(alone) + " - " +
                     std::to_string(shared) + " = " + std::to_string(alone - shared) + " B a " +
                     (shape == Shape::kPlane  ? "pixel"
                      : shape == Shape::kList ? "list element"
                                              : "record element"));
        }
    }

    void writeCopies() {
        for (const PlannedNode& node : graph_->nodes)
            for (const PlannedOutput& output : node.outputs)
                if (node.culled.empty() && output.in_place == InPlace::kCopies)
                    line(arrow(output.in_place_of, output.value) + " before " + node.name +
                         ": it updates what is still needed");
        for (const PlannedLoop& loop : graph_->loops) {
            const PlannedNode& node = graph_->nodes[loop.node];
            if (!node.culled.empty())
                continue;
            for (const PlannedCarry& carry : loop.carries)
                if (!carry.is_culled && carry.initial != kNoId)
                    line(arrow(carry.initial, carry.value) + " when " + node.name + " begins");
            for (const PlannedCarry& carry : loop.carries)
                if (!carry.is_culled &&
                    (carry.next_by == NextBy::kCopy || carry.next_by == NextBy::kStagedCopy))
                    line(arrow(carry.next, carry.value) + " after each iteration of " + node.name +
                         (carry.next_by == NextBy::kStagedCopy ? ", through scratch memory" : ""));
        }
    }

    void writeHistories() {
        for (const PlannedHistory& history : graph_->histories) {
            if (history.begins_at == kNoId)
                continue;
            const std::string& before = graph_->nodes[history.begins_at].name;
            if (history.initial != kNoId)
                line(arrow(history.initial, history.value) + " before " + before +
                     " in the first frame");
            else
                line("zeroes -> " + graph_->values[history.value].name + " before " + before +
                     " in the first frame");
            line(arrow(history.source, history.value) + " at the end of each frame");
        }
    }

    std::string arrow(ValueId from, ValueId to) const {
        return graph_->values[from].name + " -> " + graph_->values[to].name;
    }

    const CompiledGraph* graph_;
    std::string text_;
    std::string title_;
};

} // namespace

std::string dump(const CompiledGraph& graph) {
    return Dump(graph).text();
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/graph/compiled_graph.h"
#include "hone/core/graph/plan_sizes.h"

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

std::string padLeft(const std::string& text, std::size_t width) {
    return std::string(width - std::min(width, text.size()), ' ') + text;
}

std::string number(double limit) {
    const auto whole = static_cast<std::uint64_t>(limit);
    return static_cast<double>(whole) == limit ? std::to_string(whole) : std::to_string(limit);
}

class Dump {
public:
    Dump(const CompiledGraph& graph, uvec2 extent) : graph_(&graph) {
        if (extent.x > 0)
            sizes_ = planSizes(graph, extent);
        for (const PlannedValue& value : graph.values) {
            if (!value.is_needed)
                continue;
            name_width_ = std::max(name_width_, value.name.size());
            type_width_ = std::max(type_width_, value.type.name.size());
        }
        if (extent.x > 0)
            at_ = " at " + std::to_string(extent.x) + "x" + std::to_string(extent.y);
    }

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
        section("memory" + at_);
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
            line(text + " (loop to step " + std::to_string(loop.last_step) + "; until " +
                 stopText(*graph_, loop) + ")");
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

    void writeValue(const PlannedValue& value) {
        constexpr std::uint32_t kForever = 0xffffffffu;
        const std::string last =
            value.last_step == kForever ? "end" : std::to_string(value.last_step);
        std::string text = pad(value.name, name_width_ + 1) +
                           pad(std::string(value.type.name), type_width_ + 1) + "steps " +
                           std::to_string(value.first_step) + " to " + last;
        if (value.memory != kNoId)
            text += ", memory " + std::to_string(value.memory);
        line(text);
    }

    void writeMemory(std::size_t index) {
        const PlannedMemory& memory = graph_->memories[index];
        std::string text = pad(std::to_string(index), 4) + pad(shapeName(memory.shape), 7) +
                           padLeft(std::to_string(memory.stride), 2) + " B  ";
        if (sizes_)
            text +=
                padLeft(sizes_->memories[index] ? byteText(*sizes_->memories[index]) : "by scene",
                        8) +
                "  ";
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
        if (sizes_) {
            line("in all " + byteText(sizes_->bytes) +
                 (sizes_->unknown > 0 ? " and what the scene decides" : "") + "; sharing saves " +
                 byteText(sizes_->saved));
            return;
        }
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
    std::optional<PlanSizes> sizes_; ///< where an extent was given
    std::string at_;                 ///< " at 800x600"
    std::size_t name_width_ = 26;    ///< at least, so that a new name rarely moves the others
    std::size_t type_width_ = 16;
    std::string text_;
    std::string title_;
};

} // namespace

std::string stopText(const CompiledGraph& graph, const PlannedLoop& loop) {
    std::string text;
    std::string off;
    for (const StopRule& rule : loop.stop) {
        using Kind = StopRule::Kind;
        const std::string value = rule.value != kNoId ? graph.values[rule.value].name : "";
        const std::string unit = rule.kind == Kind::kRays         ? "rays"
                                 : rule.kind == Kind::kMs         ? "ms"
                                 : rule.kind == Kind::kIterations ? "iterations"
                                                                  : value;
        if (rule.kind != Kind::kEmpty && rule.limit == 0) {
            off += (off.empty() ? ", no limit of " : " and ") + unit;
            continue;
        }
        text += (text.empty() ? "" : " or ") + (rule.kind == Kind::kEmpty ? value + " is empty"
                                                : rule.kind == Kind::kBelow
                                                    ? value + " is below " + number(rule.limit)
                                                    : number(rule.limit) + " " + unit);
    }
    text += off;
    if (loop.check_every != 1)
        text += ", checked every " + std::to_string(loop.check_every);
    return text;
}

std::string dump(const CompiledGraph& graph, uvec2 extent) {
    return Dump(graph, extent).text();
}

} // namespace hone

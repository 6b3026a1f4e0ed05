// SPDX-License-Identifier: Apache-2.0
#include "hone/core/graph/plan_sizes.h"

#include "hone/core/scene/scene.h"

#include <algorithm>
#include <cstdio>
#include <iterator>

namespace hone {
namespace {

/// Follows the executor through the plan and notes how many elements each value would get.
class Elements {
public:
    Elements(const CompiledGraph& graph, uvec2 extent, const Scene* scene)
        : graph_(&graph), extent_(extent), scene_(scene), count_(graph.values.size()) {
        for (const NamedValue& input : graph.inputs)
            count_[input.value] = usual(graph.values[input.value]);
        for (const PlannedHistory& history : graph.histories)
            count_[history.value] = usual(graph.values[history.value]);
        walk(graph.order);
        // What the last frame made may be larger than zeroes, and its readers' lists with it.
        for (const PlannedHistory& history : graph.histories)
            count_[history.value] =
                greater(count_[history.source],
                        history.initial != kNoId ? count_[history.initial] : count_[history.value]);
        if (!graph.histories.empty())
            walk(graph.order);
    }

    std::optional<std::size_t> of(ValueId id) const { return count_[id]; }

private:
    void walk(const std::vector<NodeId>& order) {
        for (const NodeId id : order) {
            const PlannedNode& node = graph_->nodes[id];
            if (node.loop == kNoId)
                for (std::size_t port = 0; port < node.outputs.size(); ++port)
                    count_[node.outputs[port].value] = ofOutput(node, port);
            else
                walkLoop(graph_->loops[node.loop]);
        }
    }

    /// Twice: what a loop carries may become larger by what its body makes.
    void walkLoop(const PlannedLoop& loop) {
        for (const PlannedCarry& carry : loop.carries)
            if (!carry.is_culled)
                count_[carry.value] = carry.initial != kNoId ? count_[carry.initial]
                                                             : usual(graph_->values[carry.value]);
        for (int i = 0; i < 2; ++i) {
            walk(loop.body);
            for (const PlannedCarry& carry : loop.carries)
                if (!carry.is_culled && carry.next != kNoId)
                    count_[carry.value] = greater(count_[carry.value], count_[carry.next]);
        }
    }

    static std::optional<std::size_t> greater(std::optional<std::size_t> a,
                                              std::optional<std::size_t> b) {
        return a && b ? std::max(a, b) : std::nullopt;
    }

    std::size_t usual(const PlannedValue& value) const {
        return value.type.shape == Shape::kPlane    ? std::size_t{extent_.x} * extent_.y
               : value.type.shape == Shape::kRecord ? 1
                                                    : 0;
    }

    std::optional<std::size_t> ofOutput(const PlannedNode& node, std::size_t index) const {
        const PlannedOutput& output = node.outputs[index];
        if (output.in_place != InPlace::kNo)
            return count_[output.in_place_of];
        const OutPort& port = node.type->outputs[index];
        if (port.size == nullptr)
            return usual(graph_->values[output.value]);
        const bool has_scene = std::ranges::any_of(node.inputs, [&](const PlannedEdge& edge) {
            return graph_->values[edge.value].type.shape == Shape::kScene;
        });
        // A record of a pass that sees the scene is as large as lights, probes, vertices make it.
        if (has_scene && scene_ == nullptr && port.type.shape == Shape::kRecord)
            return std::nullopt;
        bool is_known = true;
        const auto capacity = [&](std::string_view name) {
            std::size_t sum = 0;
            for (const PlannedEdge& edge : node.inputs)
                if (node.type->inputs[edge.port].name == name) {
                    is_known &= count_[edge.value].has_value();
                    sum += count_[edge.value].value_or(0);
                }
            return sum;
        };
        static const Scene kNoScene;
        const Scene* const seen = scene_ != nullptr ? scene_ : &kNoScene;
        const std::size_t size =
            port.size({extent_, node.params, has_scene ? seen : nullptr, capacity});
        return is_known ? std::optional(size) : std::nullopt;
    }

    const CompiledGraph* graph_;
    uvec2 extent_;
    const Scene* scene_;
    std::vector<std::optional<std::size_t>> count_; ///< elements by value
};

} // namespace

PlanSizes planSizes(const CompiledGraph& graph, uvec2 extent, const Scene* scene) {
    const Elements elements(graph, extent, scene);
    PlanSizes sizes;
    sizes.values.resize(graph.values.size());
    for (const PlannedMemory& memory : graph.memories) {
        std::optional<std::size_t> greatest = 0;
        std::size_t sum = 0;
        for (const ValueId id : memory.values) {
            const PlannedValue& value = graph.values[id];
            if (const auto count = elements.of(id))
                sizes.values[id] = std::max<std::size_t>(*count, 1) * value.type.stride;
            greatest =
                greatest && sizes.values[id] ? std::max(greatest, sizes.values[id]) : std::nullopt;
            sum += sizes.values[id].value_or(0);
        }
        sizes.memories.push_back(greatest);
        if (!greatest) {
            ++sizes.unknown;
            continue;
        }
        sizes.bytes += *greatest;
        sizes.saved += sum - *greatest;
    }
    return sizes;
}

std::string byteText(std::size_t bytes) {
    if (bytes < 1000)
        return std::to_string(bytes) + " B";
    double number = static_cast<double>(bytes);
    std::size_t unit = 0;
    constexpr const char* kUnits[] = {"B", "kB", "MB", "GB", "TB"};
    while (number >= 999.5 && unit + 1 < std::size(kUnits)) {
        number /= 1000;
        ++unit;
    }
    char text[32];
    std::snprintf(text, sizeof text,
                  number < 9.95   ? "%.2f %s"
                  : number < 99.5 ? "%.1f %s"
                                  : "%.0f %s",
                  number, kUnits[unit]);
    return text;
}

} // namespace hone

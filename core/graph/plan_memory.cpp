// SPDX-License-Identifier: Apache-2.0
#include "hone/core/graph/compilation.h"

#include <algorithm>
#include <limits>

namespace hone {
namespace {

constexpr std::uint32_t kForever = std::numeric_limits<std::uint32_t>::max();

/// One read of a value. A read from outside the loop that writes the value happens after the loop.
struct Read {
    std::uint32_t step = 0;
    NodeId node = kNoId; ///< kNoId: no pass, but `next`, a stop rule or an output
};

class MemoryPlanner {
public:
    explicit MemoryPlanner(Compilation& c)
        : c_(&c), graph_(&c.graph), reads_(graph_->values.size()),
          is_exposed_(graph_->values.size()), is_varying_(graph_->nodes.size()),
          root_(graph_->values.size()), taken_over_(graph_->values.size()) {
        for (ValueId id = 0; id < root_.size(); ++id)
            root_[id] = id;
    }

    void plan() {
        std::uint32_t step = 0;
        numberSteps(graph_->order, step);
        collectReads();
        findLifetimes();
        findVarying(graph_->order);
        for (NodeId id : runningPasses())
            planInPlace(id);
        assignMemory();
        planNext();
    }

private:
    PlannedValue& value(ValueId id) { return graph_->values[id]; }
    PlannedNode& node(NodeId id) { return graph_->nodes[id]; }

    /// A loop takes a step to begin and one to end, where `next` becomes `carry`.
    void numberSteps(const std::vector<NodeId>& order, std::uint32_t& step) {
        for (const NodeId id : order) {
            node(id).step = ++step;
            if (node(id).loop == kNoId)
                continue;
            PlannedLoop& loop = graph_->loops[node(id).loop];
            numberSteps(loop.body, step);
            loop.last_step = ++step;
        }
    }

    std::vector<NodeId> runningPasses() const {
        std::vector<NodeId> result;
        for (NodeId id = 0; id < graph_->nodes.size(); ++id)
            if (graph_->nodes[id].culled.empty() && graph_->nodes[id].type != nullptr)
                result.push_back(id);
        std::ranges::sort(result, {}, [&](NodeId id) { return graph_->nodes[id].step; });
        return result;
    }

    void collectReads() {
        for (NodeId id = 0; id < graph_->nodes.size(); ++id) {
            const PlannedNode& reader = graph_->nodes[id];
            if (!reader.culled.empty())
                continue;
            for (const PlannedEdge& edge : reader.inputs)
                addRead(edge.value, id, reader.parent, reader.step);
            if (reader.loop == kNoId)
                continue;
            const PlannedLoop& loop = graph_->loops[reader.loop];
            for (const PlannedCarry& carry : loop.carries)
                if (!carry.is_culled) {
                    addRead(carry.initial, kNoId, reader.parent, reader.step);
                    addRead(carry.next, kNoId, id, loop.last_step);
                }
            for (const StopRule& rule : loop.stop)
                addRead(rule.value, kNoId, id, loop.last_step);
        }
        for (const NamedValue& output : graph_->outputs)
            addRead(output.value, kNoId, kNoId, kForever);
        for (const PlannedHistory& history : graph_->histories)
            if (history.begins_at != kNoId) {
                addRead(history.initial, kNoId, kNoId, node(history.begins_at).step);
                addRead(history.source, kNoId, kNoId, kForever);
            }
    }

    /// A read inside a loop that runs within the value's scope lasts as long as that loop.
    void addRead(ValueId id, NodeId reader, NodeId reader_scope, std::uint32_t step) {
        if (id == kNoId)
            return;
        const PlannedValue& v = value(id);
        const bool is_after = !c_->isInside(reader_scope, v.scope);
        is_exposed_[id] = is_exposed_[id] || is_after;
        for (NodeId loop = reader_scope; loop != kNoId && !c_->isInside(v.writer, loop);
             loop = node(loop).parent) {
            PlannedLoop& around = graph_->loops[node(loop).loop];
            step = std::max(step, around.last_step);
            if (std::ranges::find(around.reads, id) == around.reads.end())
                around.reads.push_back(id);
        }
        reads_[id].push_back({is_after ? kForever : step, reader});
    }

    void findLifetimes() {
        for (ValueId id = 0; id < graph_->values.size(); ++id) {
            PlannedValue& v = value(id);
            if (!v.is_needed)
                continue;
            v.first_step = v.writer == kNoId ? 0 : node(v.writer).step;
            v.last_step = v.first_step;
            for (const Read& read : reads_[id])
                v.last_step = std::max(v.last_step, read.step);
        }
        // What a loop begins with belongs to its dependencies.
        for (PlannedLoop& loop : graph_->loops)
            for (const PlannedCarry& carry : loop.carries)
                if (!carry.is_culled && carry.initial != kNoId &&
                    std::ranges::find(loop.reads, carry.initial) == loop.reads.end())
                    loop.reads.push_back(carry.initial);
    }

    /// Does the value change while `loop` iterates?
    bool isVarying(ValueId id, NodeId loop) {
        const PlannedValue& v = value(id);
        if (v.writer == loop) {
            for (const PlannedCarry& carry : graph_->loops[node(loop).loop].carries)
                if (carry.value == id)
                    return carry.next != id;
            return true;
        }
        const NodeId inner = v.writer == kNoId ? kNoId : c_->ancestorIn(loop, v.writer);
        return inner != kNoId && is_varying_[inner];
    }

    void findVarying(const std::vector<NodeId>& order) {
        for (const NodeId id : order) {
            const NodeId parent = node(id).parent;
            const auto varies = [&](ValueId v) {
                return v != kNoId && parent != kNoId && isVarying(v, parent);
            };
            if (node(id).loop != kNoId) {
                is_varying_[id] = std::ranges::any_of(graph_->loops[node(id).loop].reads, varies);
                findVarying(graph_->loops[node(id).loop].body);
            } else {
                is_varying_[id] = std::ranges::any_of(
                    node(id).inputs, [&](const PlannedEdge& edge) { return varies(edge.value); });
            }
        }
    }

    /// Is it written anew by every iteration of its loop and read only there? Then its memory may
    /// serve others.
    bool isTransient(ValueId id) {
        const PlannedValue& v = value(id);
        return v.scope != kNoId && v.writer != v.scope && node(v.writer).loop == kNoId &&
               v.type.stride != 0 && !is_exposed_[id] && is_varying_[v.writer];
    }

    void planInPlace(NodeId id) {
        for (std::size_t i = 0; i < node(id).outputs.size(); ++i) {
            const OutPort& port = node(id).type->outputs[i];
            if (port.in_place_of.empty())
                continue;
            const auto edge = std::ranges::find_if(node(id).inputs, [&](const PlannedEdge& e) {
                return node(id).type->inputs[e.port].name == port.in_place_of;
            });
            if (edge == node(id).inputs.end())
                continue;
            PlannedOutput& output = node(id).outputs[i];
            output.in_place_of = edge->value;
            output.in_place =
                mayTakeOver(id, output.value, edge->value) ? InPlace::kTakesOver : InPlace::kCopies;
            if (output.in_place == InPlace::kCopies)
                continue;
            root_[output.value] = root_[edge->value];
            taken_over_[edge->value] = true;
            node(id).is_every_iteration = true;
            if (value(edge->value).writer != value(edge->value).scope)
                node(value(edge->value).writer).is_every_iteration = true;
        }
    }

    bool mayTakeOver(NodeId id, ValueId output, ValueId input) {
        const NodeId loop = node(id).parent;
        if (loop == kNoId || value(input).scope != loop || taken_over_[input])
            return false;
        const bool is_carried = value(input).writer == loop;
        if (is_carried ? !isVarying(input, loop) : !isTransient(input))
            return false;
        // Nobody else may read the input at this step or after it.
        const auto later = std::ranges::count_if(reads_[input], [&](const Read& read) {
            return read.step >= node(id).step && read.step != kForever;
        });
        if (later != 1 || (!is_carried && is_exposed_[input]))
            return false;
        // After the loop, a carried value's memory holds the carried value and nothing else.
        if (is_exposed_[output] || !is_varying_[id])
            for (const PlannedCarry& carry : graph_->loops[node(loop).loop].carries)
                if (carry.value == root_[input])
                    return carry.next == output;
        return true;
    }

    /// Values in one piece of memory because one updates the other, and when that is in use.
    struct Group {
        std::vector<ValueId> values;
        std::uint32_t first = kForever;
        std::uint32_t last = 0;
        bool is_shareable = true;
    };

    void assignMemory() {
        std::vector<Group> groups(graph_->values.size());
        for (ValueId id = 0; id < graph_->values.size(); ++id) {
            if (!value(id).is_needed || value(id).type.stride == 0)
                continue;
            Group& group = groups[root_[id]];
            group.values.push_back(id);
            group.first = std::min(group.first, value(id).first_step);
            group.last = std::max(group.last, value(id).last_step);
            group.is_shareable &= isTransient(id);
        }
        std::erase_if(groups, [](const Group& group) { return group.values.empty(); });
        std::ranges::stable_sort(groups, {}, &Group::first);
        for (Group& group : groups)
            place(group);
        for (const Group& group : groups)
            findKept(group);
        for (PlannedMemory& memory : graph_->memories)
            if (memory.values.size() > 1 && isTransient(memory.values.front()))
                for (const ValueId id : memory.values)
                    node(value(id).writer).is_every_iteration = true;
    }

    /// Greedy: the memory of the same loop and shape that is free and fits best, else a new one.
    /// Lifetimes must not touch: a pass would read and write the same bytes.
    void place(Group& group) {
        const PlannedValue& first = value(group.values.front());
        std::uint32_t stride = 0;
        for (const ValueId id : group.values)
            stride = std::max(stride, value(id).type.stride);
        std::uint32_t best = kNoId;
        for (std::uint32_t i = 0; group.is_shareable && i < graph_->memories.size(); ++i) {
            const PlannedMemory& memory = graph_->memories[i];
            if (free_[i].scope != first.scope || memory.shape != first.type.shape ||
                free_[i].last >= group.first)
                continue;
            const auto misfit = [&](std::uint32_t m) {
                const std::uint32_t s = graph_->memories[m].stride;
                return s > stride ? s - stride : stride - s;
            };
            if (best == kNoId || misfit(i) < misfit(best))
                best = i;
        }
        if (best == kNoId) {
            best = static_cast<std::uint32_t>(graph_->memories.size());
            graph_->memories.push_back({first.type.shape, 0, {}});
            free_.push_back({});
        }
        PlannedMemory& memory = graph_->memories[best];
        memory.stride = std::max(memory.stride, stride);
        free_[best] = {group.is_shareable ? first.scope : kNoId,
                       group.is_shareable ? group.last : kForever};
        for (const ValueId id : group.values) {
            value(id).memory = best;
            memory.values.push_back(id);
        }
    }

    /// What can still be read after the loop: the value that was last written into its memory.
    void findKept(const Group& group) {
        const PlannedMemory& memory = graph_->memories[value(group.values.front()).memory];
        ValueId last = memory.values.front();
        for (const ValueId id : memory.values)
            if (value(id).first_step >= value(last).first_step)
                last = id;
        for (const ValueId id : group.values) {
            const bool is_carried = value(id).writer == value(id).scope && value(id).scope != kNoId;
            value(id).is_kept = is_carried || id == last;
        }
    }

    void planNext() {
        for (PlannedLoop& loop : graph_->loops) {
            const auto is_in_place = [&](const PlannedCarry& carry) {
                return value(carry.next).memory == value(carry.value).memory;
            };
            for (PlannedCarry& carry : loop.carries) {
                if (carry.is_culled)
                    continue;
                carry.next_by = carry.next == carry.value ? NextBy::kKept
                                : is_in_place(carry)      ? NextBy::kInPlace
                                                          : NextBy::kCopy;
                const bool is_overwritten =
                    std::ranges::any_of(loop.carries, [&](const PlannedCarry& other) {
                        return !other.is_culled && !is_in_place(other) &&
                               value(other.value).memory == value(carry.next).memory;
                    });
                if (carry.next_by == NextBy::kCopy && is_overwritten)
                    carry.next_by = NextBy::kStagedCopy;
                // An output in a carried value's memory is gone where another value follows it.
                if (carry.next_by == NextBy::kCopy || carry.next_by == NextBy::kStagedCopy)
                    for (const ValueId id : graph_->memories[value(carry.value).memory].values)
                        value(id).is_kept = id == carry.value;
            }
        }
    }

    /// Until when a memory is in use, and by which loop's transients.
    struct Use {
        NodeId scope = kNoId;
        std::uint32_t last = kForever;
    };

    Compilation* c_;
    CompiledGraph* graph_;
    std::vector<std::vector<Read>> reads_; ///< by value
    std::vector<bool> is_exposed_;         ///< read outside the loop that writes it
    std::vector<bool> is_varying_;         ///< by node: changes while its loop iterates
    std::vector<ValueId> root_;            ///< the value whose memory it took over, or itself
    std::vector<bool> taken_over_;
    std::vector<Use> free_; ///< parallel to CompiledGraph::memories
};

} // namespace

void planMemory(Compilation& c) {
    MemoryPlanner(c).plan();
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/graph/compilation.h"

#include <algorithm>
#include <functional>
#include <queue>

namespace hone {
namespace {

/// Why one node of a scope must come before another.
struct Dependency {
    NodeId before = kNoId;
    ValueId value = kNoId;
    Place read_at;
};

class ScopeOrder {
public:
    ScopeOrder(Compilation& c, NodeId scope, std::uint64_t seed) : c_(&c), seed_(seed) {
        for (NodeId id = 0; id < c.graph.nodes.size(); ++id)
            if (c.graph.nodes[id].parent == scope)
                members_.push_back(id);
    }

    /// `dependencies`: by NodeId, within this scope.
    std::vector<NodeId> sort(const std::vector<std::vector<Dependency>>& dependencies) {
        std::vector<std::vector<NodeId>> after(c_->graph.nodes.size());
        std::vector<std::size_t> waiting(c_->graph.nodes.size());
        std::vector<bool> is_done(c_->graph.nodes.size());
        // Of all that could run next, the first in the file does: the order is stable. A seed
        // shuffles the file.
        const auto later = [&](NodeId a, NodeId b) {
            return std::pair(shuffled(a), a) > std::pair(shuffled(b), b);
        };
        std::priority_queue<NodeId, std::vector<NodeId>, decltype(later)> ready(later);
        for (const NodeId id : members_) {
            waiting[id] = dependencies[id].size();
            for (const Dependency& dependency : dependencies[id])
                after[dependency.before].push_back(id);
            if (waiting[id] == 0)
                ready.push(id);
        }
        std::vector<NodeId> order;
        const auto finish = [&](NodeId id) {
            is_done[id] = true;
            order.push_back(id);
            for (const NodeId next : after[id])
                if (--waiting[next] == 0 && !is_done[next])
                    ready.push(next);
        };
        std::size_t first_open = 0;
        while (order.size() < members_.size()) {
            while (!ready.empty()) {
                const NodeId id = ready.top();
                ready.pop();
                if (!is_done[id])
                    finish(id);
            }
            while (first_open < members_.size() && is_done[members_[first_open]])
                ++first_open;
            if (first_open == members_.size())
                break;
            // All that is left waits for a cycle; report it, then go on as if it were not there.
            for (const NodeId id : reportCycle(members_[first_open], dependencies, is_done))
                if (!is_done[id])
                    finish(id);
        }
        return order;
    }

private:
    /// splitmix64 (Steele, Lea, Flood 2014).
    [[nodiscard]] std::uint64_t shuffled(NodeId id) const {
        if (seed_ == 0)
            return 0;
        std::uint64_t z = seed_ + (id + 1) * 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }

    std::vector<NodeId> reportCycle(NodeId start,
                                    const std::vector<std::vector<Dependency>>& dependencies,
                                    const std::vector<bool>& is_done) {
        // Walk against the edges until a node comes up again.
        std::vector<NodeId> path;
        std::vector<const Dependency*> by;
        std::vector<std::size_t> seen(c_->graph.nodes.size(), npos);
        NodeId id = start;
        while (seen[id] == npos) {
            seen[id] = path.size();
            path.push_back(id);
            const auto open =
                std::ranges::find_if(dependencies[id], [&](const Dependency& dependency) {
                    return !is_done[dependency.before];
                });
            by.push_back(&*open);
            id = open->before;
        }
        path.erase(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(seen[id]));
        by.erase(by.begin(), by.begin() + static_cast<std::ptrdiff_t>(seen[id]));
        // In the direction of the data, beginning with the value that the first node reads.
        std::ranges::reverse(by);
        std::string text;
        for (const Dependency* dependency : by)
            text += c_->graph.values[dependency->value].name + " -> ";
        text += c_->graph.values[by.front()->value].name;
        c_->reporter.error(
            "E0405", by.back()->read_at, "passes wait for each other: " + text,
            "to repeat work, put these passes into a \"loop\" and \"carry\" the value");
        for (std::size_t i = 0; i + 1 < by.size(); ++i)
            c_->reporter.note(by[i]->read_at,
                              "\"" + c_->graph.values[by[i]->value].name + "\" is read here");
        return path;
    }

    static constexpr std::size_t npos = static_cast<std::size_t>(-1);
    Compilation* c_;
    std::uint64_t seed_;
    std::vector<NodeId> members_;
};

/// Adds "writer before reader" to the scope in which both are.
void addDependency(Compilation& c, std::vector<std::vector<Dependency>>& dependencies,
                   NodeId reader, NodeId reader_scope, ValueId id, const Place& place) {
    if (id == kNoId)
        return;
    // The last frame's value is there before all, but what it begins with is not.
    for (const PlannedHistory& history : c.graph.histories)
        if (history.value == id)
            return addDependency(c, dependencies, reader, reader_scope, history.initial, place);
    const PlannedValue& value = c.graph.values[id];
    if (value.writer == kNoId || c.isInside(reader_scope, value.writer))
        return; // a graph input, or a loop's carried value read inside it
    // The writer's name is visible to the reader, so some scope around the reader holds both.
    for (NodeId scope = reader_scope;; scope = c.graph.nodes[scope].parent) {
        const NodeId before = c.ancestorIn(scope, value.writer);
        if (before != kNoId) {
            const NodeId after = c.ancestorIn(scope, reader);
            std::vector<Dependency>& known = dependencies[after];
            if (std::ranges::none_of(
                    known, [&](const Dependency& other) { return other.before == before; }))
                known.push_back({before, id, place});
            return;
        }
        if (scope == kNoId)
            return;
    }
}

} // namespace

void orderNodes(Compilation& c, std::uint64_t schedule_seed) {
    std::vector<std::vector<Dependency>> dependencies(c.graph.nodes.size());
    for (NodeId id = 0; id < c.graph.nodes.size(); ++id) {
        const PlannedNode& node = c.graph.nodes[id];
        for (std::size_t i = 0; i < node.inputs.size(); ++i)
            addDependency(c, dependencies, id, node.parent, node.inputs[i].value,
                          c.written[id].edges[i]->from.place);
        if (node.loop == kNoId)
            continue;
        const PlannedLoop& loop = c.graph.loops[node.loop];
        // `next` and `stop` may read values from outside the loop, too; those are waited for.
        const auto isOwn = [&](ValueId value) {
            return value == kNoId || c.isInside(c.graph.values[value].writer, id);
        };
        for (std::size_t i = 0; i < loop.carries.size(); ++i) {
            addDependency(c, dependencies, id, node.parent, loop.carries[i].initial,
                          c.written[id].desc->loop->carry[i].initial.from.place);
            if (!isOwn(loop.carries[i].next))
                addDependency(c, dependencies, id, node.parent, loop.carries[i].next,
                              c.written[id].desc->loop->carry[i].name.place);
        }
        for (const StopRule& rule : loop.stop)
            if (!isOwn(rule.value))
                addDependency(c, dependencies, id, node.parent, rule.value,
                              c.written[id].desc->loop->place);
    }
    // What stands in for a pass that is switched off must be there when the pass would be.
    for (const Bypass& bypass : c.bypasses)
        if (const NodeId writer = c.graph.values[bypass.value].writer; writer != kNoId)
            addDependency(c, dependencies, writer, c.graph.nodes[writer].parent, bypass.instead,
                          bypass.place);
    c.graph.order = ScopeOrder(c, kNoId, schedule_seed).sort(dependencies);
    for (PlannedLoop& loop : c.graph.loops)
        loop.body = ScopeOrder(c, loop.node, schedule_seed).sort(dependencies);
}

} // namespace hone

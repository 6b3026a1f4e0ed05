// SPDX-License-Identifier: Apache-2.0
//
// How loops run: iterations until a rule or a limit ends them, and what they carry.
#include "hone/core/graph/executor_state.h"

#include <bit>

namespace hone {
namespace {

/// How passes tell the loop about their work (Counters).
constexpr std::string_view kRays = "rays.";
constexpr std::string_view kPixels = "pixels";
constexpr std::string_view kWorstExpect = "worst_expect_bits";

} // namespace

/// From the start, or on from where a limit cut it.
bool Executor::State::runLoop(NodeId id, bool is_new) {
    const PlannedLoop& loop = graph.loops[graph.nodes[id].loop];
    LoopState& state = loops[graph.nodes[id].loop];
    NodeState& node = nodes[id];
    node.has_run = false;
    if (is_new) {
        markSeen(id);
        beginLoop(loop, state);
    }
    const bool is_done = iterate(loop, state, graph.nodes[id].parent == kNoId);
    values[loop.stats].version = ++last_version;
    node.has_run = true;
    ++node.runs;
    return is_done;
}

void Executor::State::beginLoop(const PlannedLoop& loop, LoopState& state) {
    state.curve.records.clear();
    state.curve.stop.clear();
    state.rays = state.pixels = 0;
    state.ms = 0;
    state.iteration = 0;
    state.is_halfway = false;
    for (const PlannedCarry& carry : loop.carries) {
        if (carry.is_culled)
            continue;
        if (carry.initial != kNoId)
            copyValue(values[carry.initial], carry.value);
        else
            makeZero(carry.value);
        values[carry.value].version = ++last_version;
    }
}

/// An outermost loop always comes to an end: what a limit cut is worth as much as whole iterations.
bool Executor::State::iterate(const PlannedLoop& loop, LoopState& state, bool is_outermost) {
    const Clock::time_point began = Clock::now();
    const double ms_before = state.ms;
    const uint iterations_before = state.iteration - (state.is_halfway ? 1 : 0);
    std::uint64_t rays_before = raysSoFar();
    std::uint64_t pixels_before = counters.get(kPixels);
    const char* stop = interrupt.isCancelled() ? "cancelled" : nullptr;
    state.is_cut = stop != nullptr;
    while (stop == nullptr) {
        const std::uint64_t pixels_so_far = state.pixels;
        const std::uint64_t rays_so_far = state.rays;
        const bool is_whole = runBody(loop, state);
        state.rays += raysSoFar() - std::exchange(rays_before, raysSoFar());
        state.pixels += counters.get(kPixels) - std::exchange(pixels_before, counters.get(kPixels));
        state.ms =
            ms_before + std::chrono::duration<double, std::milli>(Clock::now() - began).count();
        if (!is_whole) {
            stop = interrupt.isCancelled() ? "cancelled" : "ms";
            state.is_cut = true;
            break;
        }
        carryOver(loop, state);
        state.curve.records.push_back(
            {.iteration = state.iteration,
             .pixels = state.pixels,
             .rays = state.rays,
             .ms = state.ms,
             .worst_expect =
                 std::bit_cast<float>(static_cast<std::uint32_t>(counters.get(kWorstExpect)))});

        stop = ruleThatEnds(loop, state);
        // An iteration that found nothing to do is none.
        const bool is_idle = state.pixels == pixels_so_far && state.rays == rays_so_far;
        if (is_idle && stop != nullptr && std::string_view(stop) == "empty") {
            state.curve.records.pop_back();
            break;
        }
        const bool goes_on = !is_outermost || !options->on_iteration ||
                             options->on_iteration(state.curve.records.back());
        if (stop == nullptr) {
            stop = goes_on ? limitThatEnds(is_outermost, state.iteration - iterations_before)
                           : "cancelled";
            state.is_cut = stop != nullptr;
        }
    }
    state.curve.stop = stop;
    return is_outermost || !state.is_cut;
}

/// An iteration from its start, or on from where it was cut. Returns whether it is whole.
bool Executor::State::runBody(const PlannedLoop& loop, LoopState& state) {
    bool goes_on = std::exchange(state.is_halfway, true);
    if (!goes_on) {
        ++state.iteration;
        state.position = 0;
        state.worst_expect_bits = 0;
    }
    if (counters.get(kWorstExpect) != state.worst_expect_bits)
        counters.set(kWorstExpect, state.worst_expect_bits);
    for (; state.position < loop.body.size(); ++state.position)
        if (!runNode(loop.body[state.position], state.iteration, std::exchange(goes_on, false))) {
            state.worst_expect_bits = counters.get(kWorstExpect);
            return false;
        }
    state.is_halfway = false;
    return true;
}

/// Hands every `next` value to its carried value, as if all at once.
void Executor::State::carryOver(const PlannedLoop& loop, LoopState& state) {
    for (std::size_t i = 0; i < loop.carries.size(); ++i)
        if (!loop.carries[i].is_culled && loop.carries[i].next_by == NextBy::kStagedCopy)
            stage(values[loop.carries[i].next], state.staged[i]);
    for (std::size_t i = 0; i < loop.carries.size(); ++i) {
        const PlannedCarry& carry = loop.carries[i];
        if (carry.is_culled || carry.next_by == NextBy::kKept)
            continue;
        Value& value = values[carry.value];
        const bool is_staged = carry.next_by == NextBy::kStagedCopy;
        const Value& next = is_staged ? state.staged[i].value : values[carry.next];
        if (carry.next_by == NextBy::kInPlace) {
            value = next;
            continue;
        }
        copyValue(next, carry.value);
        value.version = next.version;
    }
}

/// Copies a value out of the way of what is about to overwrite it.
void Executor::State::stage(const Value& value, StagedValue& staged) {
    if (staged.memory.bytes() < value.buffer.bytes) {
        finishDevice();
        staged.memory = memory->createBuffer(value.buffer.bytes, "scratch of a carried value");
    }
    staged.value = value;
    staged.value.buffer = staged.memory.view().part(0, value.buffer.bytes);
    copyContent(value, staged.value.buffer);
}

/// The first of the graph's own rules that holds; null if none does.
const char* Executor::State::ruleThatEnds(const PlannedLoop& loop, const LoopState& state) const {
    if (state.iteration % loop.check_every != 0)
        return nullptr;
    for (const StopRule& rule : loop.stop) {
        switch (rule.kind) {
        case StopRule::Kind::kEmpty:
            if (values[rule.value].count == 0)
                return "empty";
            break;
        case StopRule::Kind::kBelow:
            if (rule.limit > 0 && values[rule.value].as<float>().front() < rule.limit)
                return "below";
            break;
        case StopRule::Kind::kRays:
            if (rule.limit > 0 && static_cast<double>(state.rays) >= rule.limit)
                return "rays";
            break;
        case StopRule::Kind::kMs:
            if (rule.limit > 0 && state.ms >= rule.limit)
                return "ms";
            break;
        case StopRule::Kind::kIterations:
            if (rule.limit > 0 && state.iteration >= rule.limit)
                return "iterations";
            break;
        }
    }
    return nullptr;
}

/// Which limit of the whole run is reached. Those of work count whole iterations of the outermost.
const char* Executor::State::limitThatEnds(bool is_outermost, uint iterations) const {
    if (interrupt.isCancelled())
        return "cancelled";
    if (is_outermost && options->max_rays > 0 && raysSoFar() >= options->max_rays)
        return "rays";
    if (interrupt.isDue())
        return "ms";
    if (is_outermost && options->max_iterations > 0 && iterations >= options->max_iterations)
        return "iterations";
    return nullptr;
}

std::uint64_t Executor::State::raysSoFar() const {
    std::uint64_t sum = 0;
    for (const Counter& counter : counters.all())
        if (counter.name.starts_with(kRays))
            sum += counter.value;
    return sum;
}

} // namespace hone

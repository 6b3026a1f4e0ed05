// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/trace_events.h"

#include "hone/cli/json.h"
#include "hone/core/image/atomic_file.h"

#include <algorithm>

namespace hone::cli {
namespace {

using Json = nlohmann::ordered_json;

std::uint64_t raysOf(const Counters& counters) {
    std::uint64_t rays = 0;
    for (const Counter& counter : counters.all())
        if (counter.name.starts_with("rays."))
            rays += counter.value;
    return rays;
}

} // namespace

void TraceEvents::see(const PassEvent& event, const Executor& executor) {
    const PlannedNode& node = executor.graph().nodes[event.node];
    if (node.loop != kNoId)
        close(event.node);
    if (node.parent != kNoId) {
        auto open = std::ranges::find(open_, node.parent, &OpenIteration::loop);
        if (open != open_.end() && open->span.iteration != event.iteration) {
            close(node.parent);
            open = open_.end();
        }
        if (open == open_.end())
            open =
                open_.insert(open_.end(), {node.parent,
                                           {.name = "iteration " + std::to_string(event.iteration),
                                            .type = "iteration",
                                            .iteration = event.iteration,
                                            .begin = event.begin,
                                            .end = event.end}});
        open->span.end = event.end;
    }
    spans_.push_back({.name = node.name,
                      .type = node.type != nullptr ? node.type->name : "loop",
                      .iteration = event.iteration,
                      .begin = event.begin,
                      .end = event.end,
                      .is_whole = event.is_whole});
    const Count count{event.end, raysOf(executor.counters()), executor.counters().get("pixels")};
    if (counts_.empty() || counts_.back().rays != count.rays ||
        counts_.back().pixels != count.pixels)
        counts_.push_back(count);
}

void TraceEvents::close(NodeId loop) {
    const auto open = std::ranges::find(open_, loop, &OpenIteration::loop);
    if (open == open_.end())
        return;
    spans_.push_back(std::move(open->span));
    open_.erase(open);
}

void TraceEvents::add(const std::string& name, Clock::time_point begin, Clock::time_point end) {
    spans_.push_back({.name = name, .type = "", .begin = begin, .end = end});
}

void TraceEvents::write(const std::string& path, const std::string& graph) const {
    const auto microseconds = [&](Clock::time_point time) {
        return std::chrono::duration<double, std::micro>(time - began_).count();
    };
    Json events = Json::array();
    events.push_back(
        {{"name", "process_name"}, {"ph", "M"}, {"pid", 1}, {"args", {{"name", "hone " + graph}}}});
    events.push_back({{"name", "thread_name"},
                      {"ph", "M"},
                      {"pid", 1},
                      {"tid", 1},
                      {"args", {{"name", "graph"}}}});
    // What begins first comes first, and of two the longer: so viewers nest them.
    std::vector<const Span*> sorted;
    for (const Span& span : spans_)
        sorted.push_back(&span);
    std::ranges::stable_sort(sorted, [](const Span* a, const Span* b) {
        return a->begin != b->begin ? a->begin < b->begin : a->end > b->end;
    });
    for (const Span* span : sorted) {
        Json args = Json::object();
        if (!span->type.empty() && span->type != "iteration")
            args["type"] = span->type;
        if (span->iteration > 0)
            args["iteration"] = span->iteration;
        if (!span->is_whole)
            args["cut"] = "by a limit";
        events.push_back({{"name", span->name},
                          {"cat", span->type.empty()          ? "frame"
                                  : span->type == "iteration" ? "iteration"
                                  : span->type == "loop"      ? "loop"
                                                              : "pass"},
                          {"ph", "X"},
                          {"ts", microseconds(span->begin)},
                          {"dur", microseconds(span->end) - microseconds(span->begin)},
                          {"pid", 1},
                          {"tid", 1},
                          {"args", args}});
    }
    for (const Count& count : counts_)
        for (const auto& [name, number] :
             {std::pair("rays", count.rays), std::pair("pixels", count.pixels)})
            events.push_back({{"name", name},
                              {"ph", "C"},
                              {"ts", microseconds(count.time)},
                              {"pid", 1},
                              {"args", {{name, number}}}});
    // An event a line. Names may be no UTF-8: what is not is replaced.
    std::string text = "{\"displayTimeUnit\": \"ms\", \"traceEvents\": [\n";
    for (const Json& event : events)
        text += event.dump(-1, ' ', false, Json::error_handler_t::replace) +
                (&event == &events.back() ? "\n" : ",\n");
    text += "]}\n";
    writeFileAtomically(path, std::as_bytes(std::span(text)));
}

} // namespace hone::cli

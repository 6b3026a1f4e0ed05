// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/pin.h"

#include "hone/cli/value_file.h"
#include "hone/core/error.h"
#include "hone/core/graph/reporter.h"
#include "hone/core/image/atomic_file.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <stdexcept>

namespace hone::cli {
namespace {

/// What may be pinned, for the nearest name.
std::vector<std::string> pinnable(const CompiledGraph& graph) {
    std::vector<std::string> names;
    for (const NamedValue& value : graph.namedValues())
        if (graph.values[value.value].writer != kNoId)
            names.push_back(value.name);
    return names;
}

/// What is wrong with a request; "" if it can be met.
std::string problemOf(const CompiledGraph& graph, const PinRequest& request) {
    const ValueId id = graph.findValue(request.value);
    if (id == kNoId)
        return "the graph has no value of this name; " +
               suggest(request.value, pinnable(graph), "it has");
    const PlannedValue& value = graph.values[id];
    if (value.writer == kNoId)
        return value.name.starts_with('$')
                   ? "this is an input of the graph; pin what a pass makes of it"
                   : "this is of the last frame; pin what it is a copy of";
    const PlannedNode& writer = graph.nodes[value.writer];
    if (!writer.culled.empty())
        return "pass \"" + writer.name + "\" does not run: " + writer.culled +
               "; give it to an output of the graph";
    if (!value.is_needed)
        return "the loop does not carry it: no output needs it; give it to an output of the graph";
    if (request.iteration && writer.loop != kNoId && writer.parent == kNoId) {
        std::string hint = "it is known after the loop only; leave out the @";
        for (const PlannedCarry& carry : graph.loops[writer.loop].carries)
            if (carry.value == id && carry.next != kNoId && carry.next != id)
                hint += ", or pin what becomes it: " + graph.values[carry.next].name + "@" +
                        std::to_string(*request.iteration);
        return hint;
    }
    if (request.iteration && writer.parent == kNoId)
        return "pass \"" + writer.name +
               "\" is in no loop, so it has no iterations; leave out the @";
    const bool is_plane = value.type.shape == Shape::kPlane;
    const std::string ending = std::filesystem::path(request.path).extension().string();
    if (ending != (is_plane ? ".exr" : ".csv"))
        return "a value of type " + std::string(value.type.name) + " is written as " +
               (is_plane ? "an image" : "a table") + ": end the file's name with " +
               (is_plane ? ".exr" : ".csv");
    return "";
}

std::string numbered(const std::string& path, const std::string& number) {
    if (number.empty())
        return path;
    std::filesystem::path file(path);
    return file.replace_extension(number + file.extension().string()).string();
}

} // namespace

PinRequest parsePin(const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
        throw std::invalid_argument(
            "expected pass.port=file.exr or pass.port@iteration=file.exr; got \"" + text + "\"");
    PinRequest request{text.substr(0, equals), {}, text.substr(equals + 1)};
    const std::size_t at = request.value.find('@');
    if (at == std::string::npos)
        return request;
    const char* const begin = request.value.data() + at + 1;
    const char* const end = request.value.data() + request.value.size();
    uint iteration = 0;
    const auto [rest, error] = std::from_chars(begin, end, iteration);
    if (error != std::errc() || rest != end || iteration == 0)
        throw std::invalid_argument("after the @ comes an iteration, counted from 1; got \"" +
                                    text + "\"");
    request.iteration = iteration;
    request.value.resize(at);
    return request;
}

Pins::Pins(const CompiledGraph& graph, std::span<const PinRequest> requests) {
    std::string problems;
    for (const PinRequest& request : requests) {
        if (const std::string problem = problemOf(graph, request); !problem.empty()) {
            problems += "--pin " + request.value + ": " + problem + "\n";
            continue;
        }
        const ValueId value = graph.findValue(request.value);
        Pin pin{.request = request, .writer = graph.values[value].writer};
        const std::vector<PlannedOutput>& outputs = graph.nodes[pin.writer].outputs;
        pin.port = static_cast<std::size_t>(
            std::ranges::find(outputs, value, &PlannedOutput::value) - outputs.begin());
        pins_.push_back(std::move(pin));
    }
    if (!problems.empty())
        throw GraphError(problems);
    for (const Pin& pin : pins_)
        requireWritableDirectory(std::filesystem::path(pin.request.path).parent_path().string());
}

void Pins::see(const PassEvent& event, const Executor& executor) {
    if (!event.is_whole)
        return;
    for (Pin& pin : pins_) {
        if (pin.writer != event.node)
            continue;
        pin.last_seen = event.iteration;
        if (pin.request.iteration && *pin.request.iteration != event.iteration)
            continue;
        const Value* value = pin.port < event.outputs.size() ? event.outputs[pin.port].value
                                                             : executor.find(pin.request.value);
        // The last iteration of a loop often finds nothing to do: what came before says more.
        const bool is_worse = pin.is_kept && !pin.request.iteration && value != nullptr &&
                              value->count == 0 && value->curve == nullptr;
        if (value == nullptr || is_worse)
            continue;
        pin.is_kept = true;
        pin.extent = value->extent;
        if (value->type->shape == Shape::kPlane)
            pin.layer = toLayer("", *value);
        else
            pin.text = toCsv(*value);
    }
}

std::string Pins::write(const CompiledGraph& graph, const Provenance& provenance,
                        std::vector<std::string>& paths, const std::string& number) const {
    std::string missing;
    for (const Pin& pin : pins_) {
        const PinRequest& request = pin.request;
        if (!pin.is_kept) {
            missing += "--pin " + request.value + ": " + numbered(request.path, number) +
                       " is not written: " + graph.nodes[pin.writer].name +
                       (request.iteration && pin.last_seen > 0
                            ? " last ran in iteration " + std::to_string(pin.last_seen)
                            : " did not run") +
                       "\n";
            continue;
        }
        paths.push_back(numbered(request.path, number));
        if (pin.layer.values.empty()) {
            writeFileAtomically(paths.back(), std::as_bytes(std::span(pin.text)));
            continue;
        }
        Provenance attributes = provenance;
        attributes.emplace_back(
            "hone.pin",
            request.value + (request.iteration ? "@" + std::to_string(*request.iteration) : ""));
        writeExr(paths.back(), {pin.extent, {pin.layer}, std::move(attributes)});
    }
    return missing;
}

} // namespace hone::cli

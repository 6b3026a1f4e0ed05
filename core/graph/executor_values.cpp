// SPDX-License-Identifier: Apache-2.0
//
// The memory of values: sizes, growth, copies.
#include "hone/core/error.h"
#include "hone/core/graph/executor_state.h"

#include <algorithm>

namespace hone {

/// How many elements fit into a value's memory.
static std::size_t capacityOf(const Value& value) {
    return value.type->stride != 0 ? value.buffer.bytes / value.type->stride : 0;
}

std::size_t Executor::State::elementsOf(NodeId id, const OutPort& port) const {
    if (port.size == nullptr)
        return port.type.shape == Shape::kPlane ? std::size_t{extent.x} * extent.y : 1;
    const NodeState& node = nodes[id];
    const Scene* first_scene = nullptr;
    for (const BoundPort& input : node.inputs)
        if (first_scene == nullptr && input.value != nullptr)
            first_scene = input.value->scene;
    // The capture is small enough for std::function to keep it without allocating.
    const auto capacity = [&node](std::string_view name) {
        std::size_t sum = 0;
        for (const BoundPort& input : node.inputs)
            if (input.name == name && input.value != nullptr)
                sum += capacityOf(*input.value);
        return sum;
    };
    return port.size({extent, graph.nodes[id].params, first_scene, capacity});
}

/// Gives a value memory for that many elements; what is there already stays if it fits.
void Executor::State::place(ValueId id, std::size_t elements) {
    Value& value = values[id];
    const std::size_t bytes = std::max<std::size_t>(elements, 1) * value.type->stride;
    Buffer& buffer = memories[graph.values[id].memory];
    if (buffer.bytes() < bytes) {
        if (buffer) {
            finishDevice(); // recorded work may name it
            buffer = Buffer();
        }
        buffer = memory->createBuffer(bytes, graph.values[id].name);
    }
    value.buffer = buffer.view().part(0, bytes);
    value.count = static_cast<uint>(elements);
    value.extent = value.type->shape == Shape::kPlane ? extent : uvec2(0, 0);
}

/// Zeroes: lists begin empty; a record's size is known once something is copied to it.
void Executor::State::makeZero(ValueId id) {
    const Shape shape = graph.values[id].type.shape;
    place(id, shape == Shape::kPlane    ? std::size_t{extent.x} * extent.y
              : shape == Shape::kRecord ? 1
                                        : 0);
    fill(values[id].buffer, 0);
}

/// Gives values of the last frame that have none yet what they begin with.
void Executor::State::beginHistories(NodeId before) {
    for (std::size_t i = 0; i < histories.size(); ++i) {
        const PlannedHistory& planned = graph.histories[i];
        HistoryState& history = histories[i];
        if (planned.begins_at != before ||
            (history.has_begun && history.extent_version == extent_version))
            continue;
        if (planned.initial != kNoId)
            copyValue(values[planned.initial], planned.value);
        else
            makeZero(planned.value);
        values[planned.value].version = ++last_version;
        history = {.has_begun = true, .extent_version = extent_version, .source_version = 0};
    }
}

/// Hands what this frame made to the next. A cancelled run may not have come to make it.
void Executor::State::endFrame() {
    for (std::size_t i = 0; i < histories.size(); ++i) {
        const PlannedHistory& planned = graph.histories[i];
        const Value& source = values[planned.source];
        HistoryState& history = histories[i];
        if (planned.begins_at == kNoId || !history.has_begun || source.version == 0 ||
            source.version == history.source_version)
            continue;
        copyValue(source, planned.value);
        values[planned.value].version = ++last_version;
        history.source_version = source.version;
    }
}

void Executor::State::prepareOutput(NodeId id, std::size_t port) {
    const PlannedOutput& planned = graph.nodes[id].outputs[port];
    Value& value = values[planned.value];
    if (planned.in_place == InPlace::kNo) {
        place(planned.value, elementsOf(id, graph.nodes[id].type->outputs[port]));
        if (options->poison_outputs)
            fill(value.buffer, 0xffffffffu);
        // In place of an input that nothing feeds: it updates zeroes.
        if (!graph.nodes[id].type->outputs[port].in_place_of.empty())
            fill(value.buffer, 0);
        return;
    }
    const Value& input = values[planned.in_place_of];
    if (planned.in_place == InPlace::kCopies) {
        copyValue(input, planned.value);
        return;
    }
    value.buffer = input.buffer;
    value.count = input.count;
    value.extent = input.extent;
}

void Executor::State::fill(BufferView target, uint word) {
    if (kernels == host)
        finishDevice();
    kernels->fill(target, word);
    is_device_pending |= kernels == device;
}

void Executor::State::copyContent(const Value& from, BufferView to) {
    const std::size_t bytes = from.count * std::size_t{from.type->stride};
    if (bytes == 0)
        return;
    if (kernels == host)
        finishDevice();
    kernels->copy(from.buffer.part(0, bytes), to.part(0, bytes));
    is_device_pending |= kernels == device;
}

/// Makes `to` the same as `from`, in its own memory; the version is the caller's business.
void Executor::State::copyValue(const Value& from, ValueId to) {
    place(to, capacityOf(from));
    values[to].count = from.count;
    values[to].extent = from.extent;
    copyContent(from, values[to].buffer);
}

void Executor::State::finishDevice() {
    if (is_device_pending)
        device->finish();
    is_device_pending = false;
}

} // namespace hone

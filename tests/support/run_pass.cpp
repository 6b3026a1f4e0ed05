// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/support/run_pass.h"

#include "hone/backends/host/host_device.h"

#include <algorithm>
#include <cstring>

namespace hone {

PassRun::PassRun(PassType type)
    : type_(std::move(type)), host_(makeHostDevice()), device_(host_.get()), pass_(type_.create()),
      params_(type_) {
    context_.chosen = &host_->encoder();
}

PassRun::PassRun(PassType type, Device& device) : PassRun(std::move(type)) {
    device_ = &device;
    context_.device = &device.encoder();
    context_.chosen = context_.device;
}

PassRun& PassRun::kernelsOnHost() {
    context_.chosen = &host_->encoder();
    return *this;
}

PassRun& PassRun::extent(uvec2 size) {
    context_.extent = size;
    return *this;
}

PassRun& PassRun::seed(std::uint64_t value) {
    context_.seed = value;
    return *this;
}

PassRun& PassRun::iteration(uint value) {
    context_.iteration = value;
    return *this;
}

PassRun& PassRun::param(std::string_view name, ParamValue value) {
    params_.set(name, std::move(value));
    return *this;
}

PassRun& PassRun::scene(const Scene& scene) {
    scene_buffers_ = std::make_unique<SceneBuffers>(*device_, scene);
    for (const InPort& port : type_.inputs)
        if (port.type.shape == Shape::kScene) {
            Value& value = inputSlot(port.name).value;
            value.scene = &scene;
            value.scene_buffers = scene_buffers_.get();
        }
    return *this;
}

PassRun& PassRun::camera(const Camera& camera) {
    camera_ = camera;
    for (const InPort& port : type_.inputs)
        if (port.type.shape == Shape::kCamera)
            inputSlot(port.name).value.camera = &camera_;
    return *this;
}

PassRun& PassRun::tracers(const TraceBackendRegistry& registry) {
    tracers_ = std::make_unique<Tracers>(registry, Devices{device_, nullptr});
    return *this;
}

PassRun& PassRun::interrupt(const Interrupt& value) {
    context_.interrupt = value;
    return *this;
}

PassRun& PassRun::goOn() {
    context_.goes_on = true;
    execute();
    context_.goes_on = false;
    return *this;
}

PassRun& PassRun::input(std::string_view port, const Value& value) {
    inputSlot(port).value = value;
    return *this;
}

PassRun& PassRun::execute() {
    prepareOutputs();

    // Ports that nothing feeds are bound, too, to nothing.
    std::vector<BoundPort> inputs;
    for (const InPort& port : type_.inputs) {
        std::uint32_t element = 0;
        for (Slot& slot : inputs_)
            if (slot.port == port.name)
                inputs.push_back({port.name, element++, &slot.value, &slot.edge_params});
        HONE_ASSERT(element > 0 || port.optional, "nothing feeds input " + port.name);
        if (element == 0)
            inputs.push_back({port.name, 0, nullptr, nullptr});
    }
    std::vector<BoundPort> outputs;
    for (Slot& slot : outputs_)
        outputs.push_back({slot.port, 0, &slot.value, nullptr});

    context_.pass_name = type_.name;
    context_.type = &type_;
    context_.inputs = inputs;
    context_.outputs = outputs;
    context_.params = &params_;
    context_.memory = device_;
    context_.host = &host_->encoder();
    context_.tracers = tracers_.get();
    context_.counters = &counters_;
    pass_->execute(context_);
    context_.chosen->finish();
    if (context_.device != nullptr)
        context_.device->finish();
    return *this;
}

const Value& PassRun::value(std::string_view port) const {
    const auto found = std::ranges::find(outputs_, port, &Slot::port);
    HONE_ASSERT(found != outputs_.end(), "not an output, or not executed: " + std::string(port));
    return found->value;
}

/// The one to fill: a new edge where the port takes several, else the port's own.
PassRun::Slot& PassRun::inputSlot(std::string_view port) {
    const InPort* declared = type_.findIn(port);
    HONE_ASSERT(declared != nullptr, type_.name + " has no input " + std::string(port));
    const auto found = std::ranges::find(inputs_, port, &Slot::port);
    if (found != inputs_.end() && !declared->variadic)
        return *found;
    Slot& slot = inputs_.emplace_back();
    slot.port = port;
    slot.value.type = &declared->type;
    return slot;
}

void PassRun::feed(std::string_view port, std::span<const std::byte> bytes, std::size_t stride,
                   std::size_t capacity, std::vector<ParamValue> edge_params) {
    Slot& slot = inputSlot(port);
    const InPort& declared = *type_.findIn(port);
    HONE_ASSERT(declared.type.stride == stride, "another element: " + std::string(port));
    for (std::size_t i = edge_params.size(); i < declared.edge_params.size(); ++i)
        edge_params.push_back(declared.edge_params[i].fallback);
    slot.edge_params = std::move(edge_params);
    slot.memory = device_->createBuffer(std::max(bytes.size(), capacity * stride), port);
    slot.value.buffer = slot.memory.view();
    if (!bytes.empty())
        std::memcpy(slot.value.buffer.data, bytes.data(), bytes.size());
    slot.value.count = static_cast<uint>(bytes.size() / stride);
    slot.value.extent = context_.extent;
}

void PassRun::prepareOutputs() {
    const bool is_first = outputs_.empty();
    const auto scene_input =
        std::ranges::find_if(inputs_, [](const Slot& slot) { return slot.value.scene != nullptr; });
    for (const OutPort& port : type_.outputs) {
        auto found = std::ranges::find(outputs_, port.name, &Slot::port);
        Slot& slot = is_first ? outputs_.emplace_back() : *found;
        slot.port = port.name;

        // What takes over an input's memory is that input.
        const auto taken_over = std::ranges::find(inputs_, port.in_place_of, &Slot::port);
        if (!port.in_place_of.empty() && taken_over != inputs_.end()) {
            slot.value = taken_over->value;
            continue;
        }
        const SizeQuery query{
            .extent = context_.extent,
            .params = params_,
            .scene = scene_input != inputs_.end() ? scene_input->value.scene : nullptr,
            .input = [&](std::string_view name) {
                std::size_t sum = 0;
                for (const Slot& input : inputs_)
                    if (input.port == name)
                        sum += input.value.buffer.bytes / input.value.type->stride;
                return sum;
            }};
        const bool is_list = port.type.shape == Shape::kList;
        const std::size_t elements = port.size != nullptr
                                         ? port.size(query)
                                         : std::size_t{context_.extent.x} * context_.extent.y;
        if (slot.memory && slot.memory.bytes() >= elements * port.type.stride)
            continue;
        slot.memory = device_->createBuffer(elements * port.type.stride, port.name);
        slot.value.type = &port.type;
        slot.value.buffer = slot.memory.view();
        slot.value.count = is_list ? 0 : static_cast<uint>(elements);
        slot.value.extent = context_.extent;
    }
}

} // namespace hone

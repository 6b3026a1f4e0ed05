// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/support/run_pass.h"

#include "hone/backends/host/host_device.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

namespace hone {
namespace {

/// What stands behind the end of every buffer and must stay there.
constexpr std::size_t kGuardBytes = 64;
constexpr std::byte kGuard{0xa5};
/// What memory holds that another value left: as a float -1.6e-13, as a uint far out of range.
constexpr std::byte kOld{0xae};

std::span<std::byte> bytesOf(BufferView view) {
    return {view.data, view.bytes};
}

} // namespace

PassRun::PassRun(PassType type)
    : type_(std::move(type)), host_(makeHostDevice()), device_(host_.get()), pass_(type_.create()),
      params_(type_) {
    context_.chosen = &host_->encoder();
}

PassRun::PassRun(PassType type, Device& device, bool kernels_on_host) : PassRun(std::move(type)) {
    device_ = &device;
    context_.device = &device.encoder();
    if (!kernels_on_host)
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

PassRun& PassRun::dirtyOutputs() {
    has_dirty_outputs_ = true;
    return *this;
}

PassRun& PassRun::execute() {
    prepareOutputs();
    rememberInputs();

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
    checkMemory();
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

void PassRun::expectStride(std::string_view port, std::size_t stride) {
    const InPort* declared = type_.findIn(port);
    HONE_ASSERT(declared == nullptr || declared->type.stride == stride,
                "another element: " + std::string(port));
}

PassRun& PassRun::bytes(std::string_view port, std::span<const std::byte> elements,
                        std::size_t capacity, std::vector<ParamValue> edge_params) {
    Slot& slot = inputSlot(port);
    const InPort& declared = *type_.findIn(port);
    const std::size_t stride = declared.type.stride;
    for (std::size_t i = edge_params.size(); i < declared.edge_params.size(); ++i)
        edge_params.push_back(declared.edge_params[i].fallback);
    slot.edge_params = std::move(edge_params);
    allocate(slot, std::max(elements.size(), capacity * stride));
    std::ranges::copy(elements, slot.value.buffer.data);
    slot.value.count = static_cast<uint>(elements.size() / stride);
    slot.value.extent = context_.extent;
    return *this;
}

/// Room for at least one element, as an executor gives, and the guard behind it.
void PassRun::allocate(Slot& slot, std::size_t bytes) {
    const std::size_t used = std::max<std::size_t>(bytes, slot.value.type->stride);
    slot.memory = device_->createBuffer(used + kGuardBytes, slot.port);
    slot.value.buffer = slot.memory.view().part(0, used);
    std::ranges::fill(bytesOf(slot.memory.view()).subspan(used), kGuard);
}

void PassRun::rememberInputs() {
    for (Slot& slot : inputs_) {
        slot.before.clear();
        if (std::ranges::find(type_.outputs, slot.port, &OutPort::in_place_of) ==
            type_.outputs.end())
            slot.before.assign(bytesOf(slot.value.buffer).begin(),
                               bytesOf(slot.value.buffer).end());
    }
}

void PassRun::checkMemory() const {
    for (const Slot& slot : inputs_)
        if (!slot.before.empty() && !std::ranges::equal(slot.before, bytesOf(slot.value.buffer)))
            ADD_FAILURE() << type_.name << " changed its input " << slot.port;
    for (const std::deque<Slot>* slots : {&inputs_, &outputs_})
        for (const Slot& slot : *slots)
            if (slot.memory && std::ranges::any_of(bytesOf(slot.memory.view()).last(kGuardBytes),
                                                   [](std::byte byte) { return byte != kGuard; }))
                ADD_FAILURE() << type_.name << " wrote past the end of " << slot.port;
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
        const std::size_t bytes = elements * port.type.stride;
        if (!slot.memory || slot.value.buffer.bytes < bytes) {
            slot.value.type = &port.type;
            allocate(slot, bytes);
            slot.value.count = is_list ? 0 : static_cast<uint>(elements);
        }
        if (has_dirty_outputs_ && port.in_place_of.empty()) {
            std::ranges::fill(bytesOf(slot.value.buffer), kOld);
            slot.value.count = static_cast<uint>(elements);
        }
        slot.value.extent = context_.extent;
    }
}

} // namespace hone

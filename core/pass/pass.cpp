// SPDX-License-Identifier: Apache-2.0
#include "hone/core/pass/pass.h"

#include "hone/core/error.h"
#include "hone/core/log.h"
#include "hone/core/pass/pass_type.h"
#include "hone/core/scene/scene_buffers.h"

#include <algorithm>
#include <cstring>

namespace hone {

PassParams::PassParams(const PassType& type) : type_(&type) {
    for (const ParamDecl& decl : type.params)
        values_.push_back(decl.fallback);
}

std::size_t PassParams::index(std::string_view param) const {
    for (std::size_t i = 0; i < values_.size(); ++i)
        if (type_->params[i].name == param)
            return i;
    HONE_ASSERT(false, "the pass did not declare a parameter \"" + std::string(param) + "\"");
}

const ParamValue& PassParams::value(std::string_view param) const {
    return values_[index(param)];
}

void PassParams::set(std::string_view param, ParamValue new_value) {
    ParamValue& slot = values_[index(param)];
    HONE_ASSERT(slot.index() == new_value.index(),
                "another type for parameter \"" + std::string(param) + "\"");
    slot = std::move(new_value);
}

namespace {
uint choiceIndex(const ParamDecl& decl, const ParamValue& value) {
    const auto found = std::ranges::find(decl.choices, std::get<std::string>(value));
    return static_cast<uint>(found - decl.choices.begin());
}
} // namespace

uint PassParams::choice(std::string_view param) const {
    const std::size_t i = index(param);
    return choiceIndex(type_->params[i], values_[i]);
}

void PassParams::writeTo(std::span<std::byte> kernel_params) const {
    for (std::size_t i = 0; i < values_.size(); ++i) {
        const ParamDecl& decl = type_->params[i];
        if (decl.kernel_offset == ParamDecl::npos)
            continue;
        uint word = 0;
        switch (decl.type) {
        case ParamType::kBool:
            word = std::get<bool>(values_[i]) ? 1u : 0u;
            break;
        case ParamType::kUint:
            word = std::get<uint>(values_[i]);
            break;
        case ParamType::kEnum:
            word = choiceIndex(decl, values_[i]);
            break;
        case ParamType::kFloat:
            std::memcpy(&word, &std::get<float>(values_[i]), sizeof word);
            break;
        }
        HONE_ASSERT(decl.kernel_offset + sizeof word <= kernel_params.size(), decl.name);
        std::memcpy(kernel_params.data() + decl.kernel_offset, &word, sizeof word);
    }
}

Counter& Counters::slot(std::string_view name) {
    auto found = std::ranges::find(items_, name, &Counter::name);
    return found != items_.end() ? *found : items_.emplace_back(Counter{name, 0});
}

void Counters::add(std::string_view name, std::uint64_t amount) {
    slot(name).value += amount;
}
void Counters::set(std::string_view name, std::uint64_t amount) {
    slot(name).value = amount;
}

std::uint64_t Counters::get(std::string_view name) const {
    auto found = std::ranges::find(items_, name, &Counter::name);
    return found != items_.end() ? found->value : 0;
}

/// Which of the instances were placed elsewhere, ascending.
static std::vector<uint> movedInstances(std::span<const Instance> before,
                                        std::span<const Instance> now) {
    std::vector<uint> moved;
    for (uint i = 0; i < now.size(); ++i)
        if (std::memcmp(&before[i], &now[i], sizeof(Instance)) != 0)
            moved.push_back(i);
    return moved;
}

/// What "auto" stands for.
TracerChoice& Tracers::choose(const Scene& scene) {
    if (masked_version_ != scene.version) {
        is_masked_ = hasMasked(scene);
        masked_version_ = scene.version;
    }
    TracerChoice& choice = choices_[is_masked_ ? 1 : 0];
    if (choice.name.empty()) {
        choice = chooseTracer(*registry_, devices_, is_masked_);
        logger().info("trace backend {}: {}", choice.name, choice.reason);
    }
    return choice;
}

Tracers::Resolved Tracers::resolve(std::string_view backend, const Scene& scene) {
    if (backend != "auto")
        return {backend, "asked for by name"};
    const TracerChoice& choice = choose(scene);
    return {choice.name, choice.reason};
}

static void requireMasks(const TraceBackend& backend, std::string_view name, const Scene& scene) {
    if (hasMasked(scene) && !backend.caps().masked)
        throw DeviceError("trace backend \"" + std::string(name) +
                          "\" does not honour alpha-masked materials, which scene \"" + scene.name +
                          "\" has; set parameter \"backend\" to \"auto\"");
}

std::unique_ptr<TraceBackend> Tracers::make(std::string_view backend, const Scene& scene) {
    const std::string_view name = resolve(backend, scene).name;
    // The one that was tried need not be made again.
    std::unique_ptr<TraceBackend> made;
    if (backend == "auto")
        made = std::move(choose(scene).backend);
    if (made != nullptr)
        made = registry_->wrap(std::move(made));
    else
        made = registry_->create(name, devices_);
    requireMasks(*made, name, scene);
    return made;
}

TraceBackend& Tracers::get(std::string_view backend, const Value& scene_value) {
    const Scene& scene = *scene_value.scene;
    const std::string_view name = resolve(backend, scene).name;
    auto found = std::ranges::find(built_, name, &Built::name);
    if (found == built_.end())
        found =
            built_.insert(built_.end(), Built{std::string(name), make(backend, scene), 0, 0, {}});
    if (found->version == scene.version)
        return *found->backend;

    requireMasks(*found->backend, name, scene);
    // If it fails halfway, the next call builds anew.
    const bool only_moved = found->version != 0 && found->shape_version == scene.shape_version;
    found->version = 0;
    if (only_moved)
        found->backend->update(movedInstances(found->instances, scene.instances));
    else
        found->copied_bytes = found->backend->build(scene, scene_value.scene_buffers).copied_bytes;
    found->version = scene.version;
    found->shape_version = scene.shape_version;
    found->instances.assign(scene.instances.begin(), scene.instances.end());
    return *found->backend;
}

std::vector<MemoryCopy> Tracers::copies() const {
    std::vector<MemoryCopy> copies;
    for (const Built& built : built_) {
        if (built.copied_bytes > 0)
            copies.push_back({"the scene in " + built.name, built.copied_bytes,
                              built.name + " keeps arrays of the scene in a memory of its own",
                              "another trace backend; hone bench tracers compares them"});
        if (const std::size_t bytes = built.backend->copiedBytes(); bytes > 0)
            copies.push_back({"rays and answers of " + built.name, bytes,
                              built.name + " cannot use the memory that they lay in",
                              "passes that keep their lists in buffers of PassContext::memory, or "
                              "another trace backend"});
    }
    return copies;
}

namespace {
const BoundPort& findPort(const PassContext& context, std::span<const BoundPort> ports,
                          std::string_view name, std::uint32_t element, const char* kind) {
    for (const BoundPort& port : ports)
        if (port.name == name && port.element == element)
            return port;
    HONE_ASSERT(false, "pass \"" + context.type->name + "\" asked for " + kind + " \"" +
                           std::string(name) + "\", which it did not declare");
}
} // namespace

const Value& PassContext::in(std::string_view port, std::uint32_t element) const {
    const BoundPort& bound = findPort(*this, inputs, port, element, "input");
    HONE_ASSERT(bound.value != nullptr,
                "input \"" + std::string(port) + "\" is not connected; ask has() first");
    return *bound.value;
}

bool PassContext::has(std::string_view port) const {
    return std::ranges::any_of(
        inputs, [&](const BoundPort& p) { return p.name == port && p.value != nullptr; });
}

uint PassContext::edges(std::string_view port) const {
    return static_cast<uint>(std::ranges::count_if(
        inputs, [&](const BoundPort& p) { return p.name == port && p.value != nullptr; }));
}

const ParamValue& PassContext::edgeParam(std::string_view port, std::uint32_t element,
                                         std::string_view param) const {
    const BoundPort& bound = findPort(*this, inputs, port, element, "input");
    const std::vector<ParamDecl>& decls = type->findIn(port)->edge_params;
    for (std::size_t i = 0; i < decls.size(); ++i)
        if (decls[i].name == param)
            return (*bound.edge_params)[i];
    HONE_ASSERT(false, "input \"" + std::string(port) + "\" declares no edge parameter \"" +
                           std::string(param) + "\"");
}

Value& PassContext::out(std::string_view port) const {
    return *findPort(*this, outputs, port, 0, "output").value;
}

const Value& PassContext::scene() const {
    for (const BoundPort& port : inputs)
        if (port.value != nullptr && port.value->scene != nullptr)
            return *port.value;
    HONE_ASSERT(false, "pass \"" + type->name + "\" has no scene input");
}

const Camera& PassContext::camera() const {
    for (const BoundPort& port : inputs)
        if (port.value != nullptr && port.value->camera != nullptr)
            return *port.value->camera;
    HONE_ASSERT(false, "pass \"" + type->name + "\" has no camera input");
}

Arguments PassContext::arguments() const {
    Arguments result;
    for (const BoundPort& port : inputs) {
        if (port.value == nullptr)
            continue;
        if (port.value->scene_buffers != nullptr)
            result.bind(port.value->scene_buffers->arguments());
        else if (port.value->buffer.handle != 0)
            result.bind(port.name, port.value->buffer, port.element);
    }
    for (const BoundPort& port : outputs)
        if (port.value->buffer.handle != 0)
            result.bind(port.name, port.value->buffer, port.element);
    return result;
}

void PassContext::dispatchBytes(const Kernel& kernel, std::span<const std::byte> kernel_params,
                                uint count, std::span<const Argument> extra) const {
    Arguments all = arguments();
    all.bind(extra);
    chosen->dispatch(kernel, all, kernel_params, count);
}

} // namespace hone

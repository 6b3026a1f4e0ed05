// SPDX-License-Identifier: Apache-2.0
#include "hone/core/pass/pass.h"

#include "hone/core/error.h"
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

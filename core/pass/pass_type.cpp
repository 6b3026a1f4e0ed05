// SPDX-License-Identifier: Apache-2.0
#include "hone/core/pass/pass_type.h"

#include "hone/core/error.h"

#include <algorithm>
#include <array>

namespace hone {
namespace {

template <class Decl>
const Decl* findByName(const std::vector<Decl>& declarations, std::string_view name) {
    const auto found = std::ranges::find(declarations, name, &Decl::name);
    return found != declarations.end() ? &*found : nullptr;
}

/// A pass that is one kernel over one port's elements.
class KernelPass final : public RenderPass {
public:
    KernelPass(const Kernel& kernel, std::string over) : kernel_(&kernel), over_(std::move(over)) {}

    void execute(PassContext& context) override {
        std::array<std::byte, kMaxParams> params{};
        HONE_ASSERT(kernel_->params_bytes <= kMaxParams, kernel_->name);
        const std::span<std::byte> used = std::span(params).first(kernel_->params_bytes);
        context.params->writeTo(used);
        const bool is_output = context.type->findOut(over_) != nullptr;
        const uint count = is_output ? context.out(over_).count : context.in(over_).count;
        context.dispatchBytes(*kernel_, used, count, {});
    }

private:
    static constexpr std::size_t kMaxParams =
        112; // Vulkan promises 128 bytes of push constants; 16 are the machinery's
    const Kernel* kernel_;
    std::string over_;
};

} // namespace

std::string_view describe(Promise promise) {
    return promise == Promise::kPixelwise
               ? "a pixel of the outputs depends on the same pixel of the inputs alone"
               : "a greater error in gives no smaller error out";
}

PassType& PassType::in(std::string port, const PortType& type, std::string port_doc) {
    inputs.push_back(
        {.name = std::move(port), .type = type, .doc = std::move(port_doc), .edge_params = {}});
    return *this;
}

PassType& PassType::inOptional(std::string port, const PortType& type, std::string port_doc) {
    in(std::move(port), type, std::move(port_doc));
    inputs.back().optional = true;
    return *this;
}

PassType& PassType::inMany(std::string port, const PortType& type, std::string port_doc,
                           std::vector<ParamDecl> edge_params) {
    in(std::move(port), type, std::move(port_doc));
    inputs.back().variadic = true;
    inputs.back().edge_params = std::move(edge_params);
    return *this;
}

PassType& PassType::out(std::string port, const PortType& type, std::string port_doc,
                        SizeRule size) {
    HONE_ASSERT(size != nullptr || type.shape == Shape::kPlane,
                "an output that is no plane needs a size rule: " + port);
    outputs.push_back({std::move(port), type, std::move(port_doc), "", std::move(size)});
    return *this;
}

PassType& PassType::outInPlace(std::string port, const PortType& type, std::string input,
                               std::string port_doc, SizeRule size) {
    outputs.push_back(
        {std::move(port), type, std::move(port_doc), std::move(input), std::move(size)});
    return *this;
}

PassType& PassType::param(std::string param_name, bool fallback, std::string param_doc) {
    ParamDecl& decl = params.emplace_back();
    decl.name = std::move(param_name);
    decl.doc = std::move(param_doc);
    decl.type = ParamType::kBool;
    decl.fallback = fallback;
    return *this;
}

PassType& PassType::param(std::string param_name, uint fallback, Range range,
                          std::string param_doc) {
    param(std::move(param_name), false, std::move(param_doc));
    params.back().type = ParamType::kUint;
    params.back().fallback = fallback;
    params.back().min = range.min;
    params.back().max = range.max;
    return *this;
}

PassType& PassType::param(std::string param_name, float fallback, Range range,
                          std::string param_doc) {
    param(std::move(param_name), 0u, range, std::move(param_doc));
    params.back().type = ParamType::kFloat;
    params.back().fallback = fallback;
    return *this;
}

PassType& PassType::param(std::string param_name, std::vector<std::string> choices,
                          std::string param_doc) {
    param(std::move(param_name), false, std::move(param_doc));
    params.back().type = ParamType::kEnum;
    params.back().fallback = choices.front();
    params.back().choices = std::move(choices);
    return *this;
}

PassType& PassType::backendParam(std::string param_name, std::string param_doc) {
    param(std::move(param_name), std::vector<std::string>{"auto"}, std::move(param_doc));
    params.back().from_trace_backends = true;
    return *this;
}

PassType& PassType::unit(std::string of_last_param) {
    HONE_ASSERT(!params.empty(), "unit() comes after the parameter it is of");
    params.back().unit = std::move(of_last_param);
    return *this;
}

PassType& PassType::into(std::size_t kernel_offset) {
    params.back().kernel_offset = kernel_offset;
    return *this;
}

PassType& PassType::promises(Promise promise) {
    promised.push_back(promise);
    return *this;
}

PassType& PassType::kernel(const Kernel& the_kernel, std::string over) {
    domain = Domain::kEither;
    create = [&the_kernel, over = std::move(over)] {
        return std::make_unique<KernelPass>(the_kernel, over);
    };
    return *this;
}

const InPort* PassType::findIn(std::string_view port) const {
    return findByName(inputs, port);
}
const OutPort* PassType::findOut(std::string_view port) const {
    return findByName(outputs, port);
}
const ParamDecl* PassType::findParam(std::string_view param) const {
    return findByName(params, param);
}

void PassRegistry::add(PassType type) {
    HONE_ASSERT(find(type.name) == nullptr, "two pass types are called " + type.name);
    types_.insert(std::ranges::upper_bound(types_, type.name, {}, &PassType::name),
                  std::move(type));
}

const PassType* PassRegistry::find(std::string_view type_name) const {
    return findByName(types_, type_name);
}

std::vector<PortType> graphTypes(const PassRegistry& registry) {
    std::vector<PortType> result(std::begin(types::kAll), std::end(types::kAll));
    for (const PassType& pass : registry.all()) {
        for (const InPort& port : pass.inputs)
            result.push_back(port.type);
        for (const OutPort& port : pass.outputs)
            result.push_back(port.type);
    }
    std::ranges::sort(result, {}, &PortType::name);
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/device/kernel.h"
#include "hone/core/pass/param.h"
#include "hone/core/pass/pass.h"
#include "hone/core/pass/port_type.h"

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace hone {

struct InPort {
    std::string name;
    PortType type;
    std::string doc;
    bool optional = false;
    bool variadic = false; ///< takes a list of edges, at most kMaxEdges, each with parameters of
                           ///< its own (edge_params)
    std::vector<ParamDecl> edge_params;
    static constexpr std::size_t kMaxEdges = 8;
};

/// How many elements an output needs, when planes' "one a pixel" is not the answer.
struct SizeQuery {
    uvec2 extent;
    const PassParams& params;
    const Scene* scene; ///< of the first scene input, or null
    /// Capacity in elements of the named input (its edges' sum where variadic); 0 when unconnected.
    std::function<std::size_t(std::string_view)> input;
};
using SizeRule = std::function<std::size_t(const SizeQuery&)>;

struct OutPort {
    std::string name;
    PortType type;
    std::string doc;
    /// The input whose memory this output takes over: execute() finds the input's content there and
    /// updates it. Zeros, where the input is optional and not connected.
    std::string in_place_of;
    SizeRule size = nullptr; ///< null: planes one element a pixel
};

/// Where a pass may run. kEither: its kernel has both builds and the executor picks.
enum class Domain : std::uint8_t { kHost, kDevice, kEither };

/// What a pass says of itself beyond its ports' types; tests generated from its declaration hold it
/// to its word.
enum class Promise : std::uint8_t {
    kPixelwise, ///< a pixel of the outputs depends on the same pixel of the inputs alone
    kMonotone,  ///< a greater error in gives no smaller error out
};

/// The promise as a sentence, for manuals.
[[nodiscard]] std::string_view describe(Promise promise);

/// A kind of pass: its ports and parameters, declared once. Manual, schema, validation, bindings
/// and generated tests come from here. Built with the chained calls below, by the function in the
/// pass's .cpp that its room's list names.
class PassType {
public:
    PassType(std::string type_name, std::string type_doc)
        : name(std::move(type_name)), doc(std::move(type_doc)) {}

    PassType& in(std::string port, const PortType& type, std::string port_doc);
    PassType& inOptional(std::string port, const PortType& type, std::string port_doc);
    PassType& inMany(std::string port, const PortType& type, std::string port_doc,
                     std::vector<ParamDecl> edge_params);
    PassType& out(std::string port, const PortType& type, std::string port_doc,
                  SizeRule size = nullptr);
    /// `size`: of what takes the input's place, zeroed, where an optional input is not connected;
    /// null as for out().
    PassType& outInPlace(std::string port, const PortType& type, std::string input,
                         std::string port_doc, SizeRule size = nullptr);

    struct Range {
        std::optional<double> min, max;
    };
    PassType& param(std::string param_name, bool fallback, std::string param_doc);
    PassType& param(std::string param_name, uint fallback, Range range, std::string param_doc);
    PassType& param(std::string param_name, float fallback, Range range, std::string param_doc);
    PassType& param(std::string param_name, std::vector<std::string> choices,
                    std::string param_doc);    ///< first = default
    PassType& unit(std::string of_last_param); ///< "m", "px", "ms"
    PassType& backendParam(std::string param_name, std::string param_doc);
    /// The parameter declared last is also the kernel's: it is written to Params at this offset
    /// (offsetof).
    PassType& into(std::size_t kernel_offset);
    PassType& promises(Promise promise);

    /// A pass that is one kernel: it runs once an element of `over` (an output or input port; a
    /// plane's pixels or a list's valid elements). No class to write; every port is bound by its
    /// name, a scene brings its buffers.
    PassType& kernel(const Kernel& the_kernel, std::string over);
    /// A pass with code of its own.
    template <class Pass> PassType& implementedBy(Domain where) {
        domain = where;
        create = [] { return std::make_unique<Pass>(); };
        return *this;
    }

    [[nodiscard]] const InPort* findIn(std::string_view port) const;
    [[nodiscard]] const OutPort* findOut(std::string_view port) const;
    [[nodiscard]] const ParamDecl* findParam(std::string_view param) const;

    std::string name;   ///< "error.shadow"
    std::string doc;    ///< one sentence
    std::string plugin; ///< who brought it; "" = hone
    std::vector<InPort> inputs;
    std::vector<OutPort> outputs;
    std::vector<ParamDecl> params;
    std::vector<Promise> promised;
    Domain domain = Domain::kHost;
    std::function<std::unique_ptr<RenderPass>()> create;
};

/// The pass types that a program knows, by name.
class PassRegistry {
public:
    /// Throws std::logic_error for a second type of the same name.
    void add(PassType type);
    [[nodiscard]] const PassType* find(std::string_view type_name) const;
    [[nodiscard]] std::span<const PassType> all() const { return types_; } ///< sorted by name

private:
    std::vector<PassType> types_;
};

/// All port types of a program: hone's own and those that only its passes' ports have; sorted by
/// name.
[[nodiscard]] std::vector<PortType> graphTypes(const PassRegistry& registry);

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/device/devices.h"
#include "hone/core/device/memory_copy.h"
#include "hone/core/interrupt.h"
#include "hone/core/pass/param.h"
#include "hone/core/pass/value.h"
#include "hone/core/trace/choice/tracer_choice.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hone {

class PassType;

/// A pass's parameters with their values, in the order of its declaration.
class PassParams {
public:
    PassParams() = default;
    explicit PassParams(const PassType& type); ///< all at their defaults

    /// Throws std::logic_error for a name that the pass did not declare, or another type.
    template <class T> [[nodiscard]] const T& get(std::string_view param) const {
        return std::get<T>(value(param));
    }
    /// Index of the chosen enum value among its choices.
    [[nodiscard]] uint choice(std::string_view param) const;
    [[nodiscard]] const ParamValue& value(std::string_view param) const;
    void set(std::string_view param, ParamValue new_value);
    /// The kernel's Params, filled from the parameters that were declared into() it.
    void writeTo(std::span<std::byte> kernel_params) const;

    friend bool operator==(const PassParams& a, const PassParams& b) {
        return a.values_ == b.values_;
    }

private:
    [[nodiscard]] std::size_t index(std::string_view param) const;
    const PassType* type_ = nullptr;
    std::vector<ParamValue> values_;
};

/// Something that was counted while a graph ran: "rays.primary", "error_pixels".
struct Counter {
    std::string_view name; ///< static
    std::uint64_t value = 0;
};

/// Named counters; adding to one that is there does not allocate.
class Counters {
public:
    void add(std::string_view name, std::uint64_t amount);
    void set(std::string_view name, std::uint64_t amount);
    [[nodiscard]] std::uint64_t get(std::string_view name) const;
    [[nodiscard]] std::span<const Counter> all() const { return items_; }
    void clear() { items_.clear(); }

private:
    Counter& slot(std::string_view name);
    std::vector<Counter> items_;
};

/// Gives out trace backends that are built for a scene; owned by the executor. Throws DeviceError
/// for a backend that cannot be made here, or cannot do what the scene needs.
class Tracers {
public:
    Tracers(const TraceBackendRegistry& registry, const Devices& devices)
        : registry_(&registry), devices_(devices) {}
    /// The backend of that name (or "auto"), built for the current version of a value of type
    /// Scene. Where only instances moved since, it is updated.
    [[nodiscard]] TraceBackend& get(std::string_view backend, const Value& scene);
    /// A backend of that name (or "auto") for the caller alone, not built: to ask about another
    /// scene than the graph's.
    [[nodiscard]] std::unique_ptr<TraceBackend> make(std::string_view backend, const Scene& scene);

    struct Resolved {
        std::string_view name;
        std::string_view reason; ///< for people
    };
    /// What a name stands for: itself, or what chooseTracer() picks for "auto". It picks once, and
    /// once more for scenes with masked materials.
    [[nodiscard]] Resolved resolve(std::string_view backend, const Scene& scene);
    /// What exists twice or was carried between memories because of those that get() gave out.
    [[nodiscard]] std::vector<MemoryCopy> copies() const;

private:
    struct Built {
        std::string name;
        std::unique_ptr<TraceBackend> backend;
        std::uint64_t version = 0;
        std::uint64_t shape_version = 0;
        std::vector<Instance> instances{}; ///< as they were placed then
        std::size_t copied_bytes = 0;      ///< BuildStats::copied_bytes of the last build
    };
    [[nodiscard]] TracerChoice& choose(const Scene& scene);

    const TraceBackendRegistry* registry_;
    Devices devices_;
    std::vector<Built> built_;
    TracerChoice choices_[2]; ///< without and with masked materials; no name: not yet made
    bool is_masked_ = false;  ///< whether the scene of this version has some:
    std::uint64_t masked_version_ = 0;
};

/// An input or output of a running pass, with its port's name.
struct BoundPort {
    std::string_view name;
    std::uint32_t element = 0;                            ///< which edge of a variadic input
    Value* value = nullptr;                               ///< null: optional and not connected
    const std::vector<ParamValue>* edge_params = nullptr; ///< in the order of InPort::edge_params
};

/// What a pass sees while it runs: what it reflected, and nothing else. Asking for another name
/// throws std::logic_error naming both.
class PassContext {
public:
    std::string_view pass_name; ///< the node's name in the graph
    const PassType* type = nullptr;
    std::span<BoundPort> inputs;
    std::span<BoundPort> outputs;
    const PassParams* params = nullptr;
    uvec2 extent{0, 0}; ///< of the frame
    std::uint64_t seed = 0;
    Device* memory = nullptr;         ///< where buffers live; every device can use them
    CommandEncoder* host = nullptr;   ///< runs kernels on all cores, at once
    CommandEncoder* device = nullptr; ///< rasterises; null when the program has no such device
    CommandEncoder* chosen = nullptr; ///< of the two, the one that this node's kernels shall use
    Tracers* tracers = nullptr;
    Counters* counters = nullptr;
    uint iteration = 0; ///< inside a loop, from 1; outside 0
    Interrupt interrupt{};
    /// The last execution threw Interrupted, and nothing that the pass sees changed since: it goes
    /// on where it gave up. Outputs hold what it left in them.
    bool goes_on = false;

    [[nodiscard]] const Value& in(std::string_view port, std::uint32_t element = 0) const;
    [[nodiscard]] bool has(std::string_view port) const;   ///< connected?
    [[nodiscard]] uint edges(std::string_view port) const; ///< of a variadic input
    [[nodiscard]] const ParamValue& edgeParam(std::string_view port, std::uint32_t element,
                                              std::string_view param) const;
    [[nodiscard]] Value& out(std::string_view port) const;

    /// The first scene / camera input.
    [[nodiscard]] const Value& scene() const;
    [[nodiscard]] const Camera& camera() const;
    template <class T> [[nodiscard]] const T& param(std::string_view param_name) const {
        return params->get<T>(param_name);
    }

    /// Every connected port that has a buffer, by its name, and the scene's buffers.
    [[nodiscard]] Arguments arguments() const;
    /// Runs a kernel over `count` invocations with all ports bound; `extra` binds what is no port.
    template <class P>
    void dispatch(const Kernel& kernel, const P& kernel_params, uint count,
                  std::span<const Argument> extra = {}) const {
        dispatchBytes(kernel, std::as_bytes(std::span(&kernel_params, 1)), count, extra);
    }
    void dispatchBytes(const Kernel& kernel, std::span<const std::byte> kernel_params, uint count,
                       std::span<const Argument> extra) const;
};

/// One pass of a graph, alive from the first run to the executor's end. It may keep what it needs
/// to be fast; its outputs may depend on inputs, parameters, extent and seed only, for it runs only
/// when one of them changed.
class RenderPass {
public:
    virtual ~RenderPass() = default;
    /// Does the work. Throws DeviceError; SceneError when the scene lacks what the pass needs.
    /// Allocates only when extent, scene or parameters grew. May throw Interrupted once
    /// context.interrupt is due, but each execution gets a little further, so that many short ones
    /// come to the end of one long one.
    virtual void execute(PassContext& context) = 0;
};

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
//
// Write a pass for hone in C++20: one struct, one line. Header only, on top of hone_pass.h, which
// says what a pass may do.
//
//     struct Edges {
//         hone::plugin::In<float> depth;                      // what it reads,
//         hone::plugin::Out<hone::plugin::Error> error;       // what it writes,
//         float threshold = 0.1f;                             // a parameter and its default
//
//         static void declare(hone::plugin::Declare<Edges>& pass) {
//             pass.called("error.edges", "Flags pixels where the depth jumps");
//             pass.in(&Edges::depth, "depth", "Depth", "of the raster image");
//             pass.out(&Edges::error, "error", "Error", "1 at jumps, else 0");
//             pass.param(&Edges::threshold, "threshold", "share of the depth", {.min = 0});
//         }
//         void execute(const hone::plugin::Run& run) {        // members are filled in by then
//             run.forEachPixel([&](int x, int y) { error(x, y) = …; });
//         }
//     };
//     HONE_PASS_PLUGIN(Edges, {.name = "edges", .version = "1.0", .license = "MIT", .doc = "…"})
//
// - One object is made for each node of a graph and stays: what it keeps besides is its own.
//   Outputs may depend on inputs, parameters, size of the frame and seed only.
// - The types of ports are those of `hone passes NAME`; elements must have as many bytes as theirs.
//   Scene and Camera are members `const hone_scene*` and `const hone_camera*`; a type of one's own
//   is a hone_port_type, given instead of the name.
// - execute may throw: what() becomes the reason that hone reports.
// - Several passes in one plug-in: using All = hone::plugin::Passes<Edges, Others>, given to
//   HONE_PASS_PLUGIN instead.
#ifndef HONE_PASS_HPP
#define HONE_PASS_HPP

// Not rooted: plug-ins have these headers alone.
#include "hone_pass_run.hpp"

#include <algorithm>
#include <deque>
#include <functional>
#include <initializer_list>
#include <optional>
#include <type_traits>
#include <vector>

#pragma GCC visibility push(hidden)

namespace hone::plugin {

struct Limits {
    std::optional<double> min{}, max{};
    const char* unit = nullptr; ///< "m", "px", "ms"
};

namespace detail {

template <class T>
hone_param paramOf(const char* name, T fallback, const char* doc, Limits limits) {
    hone_param param{};
    param.struct_size = sizeof param;
    param.type = std::is_same_v<T, bool>    ? HONE_PARAM_BOOL
                 : std::is_same_v<T, float> ? HONE_PARAM_FLOAT
                                            : HONE_PARAM_UINT;
    param.name = name;
    param.doc = doc;
    param.unit = limits.unit;
    param.fallback = static_cast<double>(fallback);
    param.min = limits.min.value_or(0);
    param.max = limits.max.value_or(0);
    param.flags = (limits.min ? HONE_HAS_MIN : 0u) | (limits.max ? HONE_HAS_MAX : 0u);
    return param;
}

/// Tables stay where they are, and lists of pointers to them.
template <class Table> class Tables {
public:
    Table& add(const Table& table) {
        pointers_.push_back(&tables_.emplace_back(table));
        return tables_.back();
    }
    [[nodiscard]] const Table* const* data() const { return pointers_.data(); }
    [[nodiscard]] std::size_t size() const { return pointers_.size(); }

private:
    std::deque<Table> tables_;
    std::vector<const Table*> pointers_;
};

} // namespace detail

/// A parameter of a variadic input's edges; read it by In::param().
[[nodiscard]] inline hone_param edgeParam(const char* name, float fallback, const char* doc,
                                          Limits limits = {}) {
    return detail::paramOf(name, fallback, doc, limits);
}

/// Takes down what a pass is made of; see the top of this file. Texts are kept by pointer:
/// literals.
template <class Pass> class Declare {
public:
    Declare() { Pass::declare(*this); }
    Declare(const Declare&) = delete;
    Declare& operator=(const Declare&) = delete;

    /// What graphs call it, and one sentence.
    void called(const char* name, const char* doc) {
        name_ = name;
        doc_ = doc;
    }

    template <class T>
    void in(In<T> Pass::*member, const char* name, const char* type, const char* doc) {
        inputs_.add(port(name, type, doc, sizeof(T)));
        edges_.push_back(
            [member](Pass& pass, const hone_input& edge, bool) { pass.*member = In<T>(edge); });
    }
    void in(const hone_scene* Pass::*member, const char* name, const char* doc) {
        inputs_.add(port(name, "Scene", doc, 0));
        edges_.push_back(
            [member](Pass& pass, const hone_input& edge, bool) { pass.*member = edge.scene; });
    }
    void in(const hone_camera* Pass::*member, const char* name, const char* doc) {
        inputs_.add(port(name, "Camera", doc, 0));
        edges_.push_back(
            [member](Pass& pass, const hone_input& edge, bool) { pass.*member = edge.camera; });
    }
    /// May be left unconnected.
    template <class T>
    void inOptional(In<T> Pass::*member, const char* name, const char* type, const char* doc) {
        inputs_.add(port(name, type, doc, sizeof(T))).flags = HONE_PORT_OPTIONAL;
        edges_.push_back(
            [member](Pass& pass, const hone_input& edge, bool) { pass.*member = In<T>(edge); });
    }
    /// Takes several edges, each with parameters of its own.
    template <class T>
    void inMany(Many<T> Pass::*member, const char* name, const char* type, const char* doc,
                std::initializer_list<hone_param> edge_params = {}) {
        detail::Tables<hone_param>& params = edge_params_.emplace_back();
        for (const hone_param& param : edge_params)
            params.add(param);
        hone_port& table = inputs_.add(port(name, type, doc, sizeof(T)));
        table.flags = HONE_PORT_VARIADIC;
        table.params = params.data();
        table.param_count = static_cast<std::uint32_t>(params.size());
        edges_.push_back([member](Pass& pass, const hone_input& edge, bool is_first) {
            if (is_first)
                (pass.*member).clear();
            if (edge.data != nullptr)
                (pass.*member).emplace_back(edge);
        });
    }

    /// `size`: how many elements there must be room for, of lists and records (hone_port::size).
    template <class T>
    void out(Out<T> Pass::*member, const char* name, const char* type, const char* doc,
             std::size_t (*size)(const hone_size_query*) = nullptr) {
        addOut(member, port(name, type, doc, sizeof(T))).size = size;
    }
    /// Begins with the content of `input`, whose memory it takes over.
    template <class T>
    void outInPlace(Out<T> Pass::*member, const char* name, const char* type, const char* input,
                    const char* doc, std::size_t (*size)(const hone_size_query*) = nullptr) {
        hone_port& table = addOut(member, port(name, type, doc, sizeof(T)));
        table.in_place_of = input;
        table.size = size;
    }

    // With a type of the plug-in's own in the place of its name; it must stay where it is.
    template <class Member>
    void in(Member member, const char* name, const hone_port_type& type, const char* doc) {
        in(member, name, typeName(type), doc);
    }
    template <class Member>
    void out(Member member, const char* name, const hone_port_type& type, const char* doc,
             std::size_t (*size)(const hone_size_query*) = nullptr) {
        out(member, name, typeName(type), doc, size);
    }

    /// A parameter; its default is what the member begins with. T: bool, uint32_t, float.
    template <class T>
    void param(T Pass::*member, const char* name, const char* doc, Limits limits = {}) {
        static_assert(std::is_same_v<T, bool> || std::is_same_v<T, std::uint32_t> ||
                      std::is_same_v<T, float>);
        params_.add(detail::paramOf(name, Pass{}.*member, doc, limits));
        settings_.push_back([member](Pass& pass, hone_word word) {
            if constexpr (std::is_same_v<T, float>)
                pass.*member = word.f;
            else
                pass.*member = static_cast<T>(word.u);
        });
    }
    /// A choice among words; the member is an enum (class) whose values count them from 0.
    template <class T>
    void choice(T Pass::*member, const char* name, std::initializer_list<const char*> choices,
                const char* doc) {
        choices_.emplace_back(choices);
        hone_param& table =
            params_.add(detail::paramOf(name, static_cast<std::uint32_t>(Pass{}.*member), doc, {}));
        table.type = HONE_PARAM_ENUM;
        table.choices = choices_.back().data();
        table.choice_count = static_cast<std::uint32_t>(choices.size());
        settings_.push_back(
            [member](Pass& pass, hone_word word) { pass.*member = static_cast<T>(word.u); });
    }
    /// Something that is counted while it runs: Run::count().
    void counter(const char* name) { counters_.push_back(name); }

    /// Without functions; it points into this.
    [[nodiscard]] hone_pass_type table() const {
        hone_pass_type table{};
        table.struct_size = sizeof table;
        table.name = name_;
        table.doc = doc_;
        table.inputs = inputs_.data();
        table.input_count = inputs_.size();
        table.outputs = outputs_.data();
        table.output_count = outputs_.size();
        table.params = params_.data();
        table.param_count = params_.size();
        table.counters = counters_.data();
        table.counter_count = counters_.size();
        return table;
    }
    [[nodiscard]] const std::vector<const hone_port_type*>& types() const { return types_; }

    /// Fills in the members of `pass`.
    void bind(Pass& pass, const hone_run& run) const {
        std::uint32_t port = HONE_NONE;
        for (std::size_t i = 0; i < run.input_count; ++i) {
            const hone_input& edge = *run.inputs[i];
            edges_[edge.port](pass, edge, edge.port != port);
            port = edge.port;
        }
        for (std::size_t i = 0; i < run.output_count; ++i)
            results_[i](pass, *run.outputs[i]);
        for (std::size_t i = 0; i < run.param_count; ++i)
            settings_[i](pass, run.params[i]);
    }

private:
    static hone_port port(const char* name, const char* type, const char* doc, std::size_t bytes) {
        hone_port table{};
        table.struct_size = sizeof table;
        table.name = name;
        table.type = type;
        table.doc = doc;
        table.stride = static_cast<std::uint32_t>(bytes);
        return table;
    }
    template <class T> hone_port& addOut(Out<T> Pass::*member, const hone_port& table) {
        results_.push_back(
            [member](Pass& pass, hone_output& output) { pass.*member = Out<T>(output); });
        return outputs_.add(table);
    }
    const char* typeName(const hone_port_type& type) {
        types_.push_back(&type);
        return type.name;
    }

    const char* name_ = nullptr;
    const char* doc_ = nullptr;
    detail::Tables<hone_port> inputs_, outputs_;
    detail::Tables<hone_param> params_;
    std::deque<detail::Tables<hone_param>> edge_params_;
    std::deque<std::vector<const char*>> choices_;
    std::vector<const char*> counters_;
    std::vector<const hone_port_type*> types_;
    std::vector<std::function<void(Pass&, const hone_input&, bool is_first)>> edges_; ///< by port
    std::vector<std::function<void(Pass&, hone_output&)>> results_;
    std::vector<std::function<void(Pass&, hone_word)>> settings_;
};

/// The functions of hone_pass_type over a struct.
template <class Pass> class PassBorder {
public:
    static hone_pass_type table() {
        hone_pass_type table = declared().table();
        table.create = create;
        table.destroy = destroy;
        table.execute = execute;
        return table;
    }
    static const Declare<Pass>& declared() {
        static const Declare<Pass> declared;
        return declared;
    }

private:
    static Pass& own(hone_pass* pass) { return *reinterpret_cast<Pass*>(pass); }

    static hone_status create(const hone_host*, hone_pass** pass, hone_error* error) {
        return detail::guarded(error, [&] { *pass = reinterpret_cast<hone_pass*>(new Pass()); });
    }

    static void destroy(hone_pass* pass) { delete &own(pass); }

    static hone_status execute(hone_pass* pass, const hone_host* the_host, const hone_run* run,
                               hone_error* error) {
        bool gave_up = false;
        const hone_status status = detail::guarded(error, [&] {
            try {
                const Host host(*the_host);
                declared().bind(own(pass), *run);
                own(pass).execute(Run(*run, host));
            } catch (const GiveUp&) {
                gave_up = true;
            }
        });
        return gave_up ? HONE_INTERRUPTED : status;
    }
};

/// Several passes of one plug-in.
template <class... Pass> struct Passes {};

/// The tables of a plug-in that offers passes. Must not move.
template <class Pass> struct PassTables : PassTables<Passes<Pass>> {
    using PassTables<Passes<Pass>>::PassTables;
};
template <class... Pass> struct PassTables<Passes<Pass...>> {
    explicit PassTables(const About& about) : plugin(detail::describe(about)) {
        (list.add(PassBorder<Pass>::table()), ...);
        for (const std::vector<const hone_port_type*>& brought :
             {std::cref(PassBorder<Pass>::declared().types())...})
            for (const hone_port_type* type : brought)
                if (std::find(types.begin(), types.end(), type) == types.end())
                    types.push_back(type);
        plugin.passes = list.data();
        plugin.pass_count = list.size();
        plugin.port_types = types.data();
        plugin.port_type_count = types.size();
    }
    PassTables(const PassTables&) = delete;
    PassTables& operator=(const PassTables&) = delete;

    detail::Tables<hone_pass_type> list;
    std::vector<const hone_port_type*> types;
    hone_plugin plugin;
};

} // namespace hone::plugin

#pragma GCC visibility pop

/// Makes this library a plug-in that offers a pass, or hone::plugin::Passes. Once, outside of
/// namespaces. `...`: a hone::plugin::About in braces.
#define HONE_PASS_PLUGIN(Pass, ...)                                                                \
    const hone_plugin* hone_plugin_entry(uint32_t, uint32_t) {                                     \
        static const ::hone::plugin::PassTables<Pass> tables(::hone::plugin::About __VA_ARGS__);   \
        return &tables.plugin;                                                                     \
    }

#endif

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/plugin/plugin_pass_tables.h"

#include "hone/core/plugin/plugin_tables.h"

namespace hone {
namespace {

constexpr std::size_t kMostPasses = 256;
constexpr std::size_t kMostCounters = 16;

// ---- Ports ----

/// A type of hone, or of the plug-in.
const PortType& typeOf(const hone_port& table, const PluginLibrary& library,
                       const std::string& what) {
    const std::string name = textOf(table.type, what + ": type");
    const PortType* type = findOwnType(name);
    for (const PluginPortType& brought : library.port_types)
        if (type == nullptr && brought.name == name)
            type = &brought.type;
    if (type == nullptr)
        throw Refusal(what + ": nobody knows type " + inQuotes(name) +
                      ": a type that is not hone's stands in hone_plugin::port_types");
    if (type->shape == Shape::kCurve)
        throw Refusal(what + ": plug-ins are given no Curve");
    if (type->stride != table.stride)
        throw Refusal(what + ": it takes an element for " + std::to_string(table.stride) +
                      " bytes, but " + name + " has " + std::to_string(type->stride));
    return *type;
}

hone_port copyPort(const hone_port& offered, const std::string& kind, std::size_t index,
                   const std::string& owner) {
    return copyTable(offered, sizeof(hone_port),
                     owner + ": the table of its " + kind + " " + std::to_string(index));
}

void readInput(const hone_port& offered, std::size_t index, const PluginLibrary& library,
               PassType& pass, const std::string& owner) {
    const hone_port table = copyPort(offered, "input", index, owner);
    InPort port{.name = memberNameOf(table.name,
                                     owner + ": the name of its input " + std::to_string(index)),
                .type = types::kScene,
                .doc = {},
                .edge_params = {}};
    const std::string what = owner + ": input " + inQuotes(port.name);
    checkIsNew(pass.inputs, port.name, owner, "inputs");
    port.type = typeOf(table, library, what);
    port.doc = textOf(table.doc, what + ": doc");
    checkFlags(table.flags, HONE_PORT_OPTIONAL | HONE_PORT_VARIADIC, library.info.abi_minor, what);
    port.optional = (table.flags & HONE_PORT_OPTIONAL) != 0;
    port.variadic = (table.flags & HONE_PORT_VARIADIC) != 0;
    if (table.in_place_of != nullptr || table.size != nullptr)
        throw Refusal(what + ": only outputs have in_place_of and size");
    if (table.param_count > 0 && !port.variadic)
        throw Refusal(what + ": only edges of HONE_PORT_VARIADIC inputs have parameters");
    port.edge_params = readParams(table.params, table.param_count, library, what);
    if (std::ranges::find(port.edge_params, "from", &ParamDecl::name) != port.edge_params.end())
        throw Refusal(what + ": an edge's parameter cannot be called \"from\": that is where it "
                             "comes from");
    pass.inputs.push_back(std::move(port));
}

void readOutput(const hone_port& offered, std::size_t index, const PluginLibrary& library,
                PluginPassType& pass, const std::string& owner) {
    const hone_port table = copyPort(offered, "output", index, owner);
    OutPort port{.name = memberNameOf(table.name,
                                      owner + ": the name of its output " + std::to_string(index)),
                 .type = types::kScene,
                 .doc = {},
                 .in_place_of = {}};
    const std::string what = owner + ": output " + inQuotes(port.name);
    checkIsNew(pass.type.outputs, port.name, owner, "outputs");
    port.type = typeOf(table, library, what);
    port.doc = textOf(table.doc, what + ": doc");
    checkFlags(table.flags, 0, library.info.abi_minor, what);
    if (table.param_count > 0)
        throw Refusal(what + ": only edges of inputs have parameters");
    if (port.type.stride == 0)
        throw Refusal(what + ": a plug-in's pass makes planes, lists and records, no " +
                      std::string(port.type.name));
    const InPort* input = nullptr;
    if (table.in_place_of != nullptr) {
        port.in_place_of = textOf(table.in_place_of, what + ": in_place_of");
        input = pass.type.findIn(port.in_place_of);
        if (input == nullptr)
            throw Refusal(what + ": it is in place of " + inQuotes(port.in_place_of) +
                          ", which is no input");
        if (input->type != port.type || input->variadic)
            throw Refusal(what + ": it is in place of " + inQuotes(port.in_place_of) + ", which " +
                          (input->variadic ? "takes several edges"
                                           : "has type " + std::string(input->type.name)));
        if (std::ranges::find(pass.type.outputs, port.in_place_of, &OutPort::in_place_of) !=
            pass.type.outputs.end())
            throw Refusal(what + ": it is in place of " + inQuotes(port.in_place_of) +
                          ", as is another output");
    }
    if (port.type.shape == Shape::kList && table.size == nullptr &&
        (input == nullptr || input->optional))
        throw Refusal(what + ": a list needs a size");
    if (port.type == types::kHits &&
        std::ranges::find(pass.type.inputs, types::kScene, &InPort::type) == pass.type.inputs.end())
        throw Refusal(what + ": hits are those of a scene: the pass needs an input of type Scene");
    pass.type.outputs.push_back(std::move(port));
    pass.sizes.push_back(table.size);
}

// ---- Passes ----

void readPass(const hone_pass_type& offered, std::size_t index, PluginLibrary& library) {
    const std::string which = "pass " + std::to_string(index);
    const hone_pass_type table =
        copyTable(offered, sizeof(hone_pass_type), "the table of its " + which);
    const std::string name = nameOf(table.name, "the name of its " + which);
    if (name == "glsl")
        throw Refusal("its pass cannot be called \"glsl\": that is hone's, for shader files");
    const std::string what = "its pass " + inQuotes(name);
    if (std::ranges::find(library.info.passes, name) != library.info.passes.end())
        throw Refusal("it offers two passes called " + inQuotes(name));

    PluginPassType pass{.type = PassType(name, textOf(table.doc, what + ": doc")),
                        .table = table,
                        .sizes = {},
                        .counters = {}};
    pass.type.plugin = library.info.name;
    checkFlags(table.flags, 0, library.info.abi_minor, what);
    readList(table.inputs, table.input_count, kMostPluginPorts, what + ": its list of inputs",
             what + ": its input", [&](const hone_port& port, std::size_t i) {
                 readInput(port, i, library, pass.type, what);
             });
    readList(table.outputs, table.output_count, kMostPluginPorts, what + ": its list of outputs",
             what + ": its output", [&](const hone_port& port, std::size_t i) {
                 readOutput(port, i, library, pass, what);
             });
    if (pass.type.outputs.empty())
        throw Refusal(what + ": it has no output: nothing could ever need it");
    pass.type.params = readParams(table.params, table.param_count, library, what);
    readList(table.counters, table.counter_count, kMostCounters, what + ": its list of counters",
             what + ": its counter", [&](const char& first, std::size_t i) {
                 pass.counters.push_back(
                     nameOf(&first, what + ": its counter " + std::to_string(i)));
             });
    require(table.execute, what + ": execute");
    if ((table.create == nullptr) != (table.destroy == nullptr))
        throw Refusal(what + ": " + (table.create == nullptr ? "create" : "destroy") +
                      " is missing (NULL), but not " +
                      (table.create == nullptr ? "destroy" : "create"));
    library.info.passes.push_back(name);
    library.passes.push_back(std::move(pass));
}

} // namespace

void readPasses(const hone_plugin& plugin, PluginLibrary& library) {
    readPortTypes(plugin, library);
    readList(plugin.passes, plugin.pass_count, kMostPasses, "its list of passes", "its pass",
             [&](const hone_pass_type& pass, std::size_t i) { readPass(pass, i, library); });
}

} // namespace hone

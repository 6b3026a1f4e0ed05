// SPDX-License-Identifier: Apache-2.0
#include "hone/core/graph/compilation.h"

#include <algorithm>

namespace hone {
namespace {

ValueId addValue(CompiledGraph& graph, std::string name, const PortType& type, NodeId writer,
                 NodeId scope) {
    PlannedValue& value = graph.values.emplace_back();
    value.name = std::move(name);
    value.type = type;
    value.writer = writer;
    value.scope = scope;
    return static_cast<ValueId>(graph.values.size() - 1);
}

void declareInputs(Compilation& c) {
    struct InputType {
        const char* name;
        PortType type;
    };
    const InputType known[] = {
        {"scene", types::kScene}, {"camera", types::kCamera}, {"extent", types::kExtent}};
    for (const GraphInputDesc& input : c.desc.inputs) {
        const auto found =
            std::ranges::find(known, input.type.text, [](const InputType& t) { return t.name; });
        ValueId id = kNoId;
        if (found != std::end(known))
            id = addValue(c.graph, "$" + input.name.text, found->type, kNoId, kNoId);
        else if (!input.type.text.empty())
            c.reporter.error("E0307", input.type.place,
                             "there is no graph input of type \"" + input.type.text + "\"",
                             suggest(input.type.text, {"scene", "camera", "extent"}, "there are"));
        c.graph.inputs.push_back({input.name.text, id});
        for (const GraphParamDesc& param : c.desc.params)
            if (param.name.text == input.name.text) {
                c.reporter.error("E0206", input.name.place,
                                 "\"" + input.name.text + "\" is an input and a parameter",
                                 "rename one: both are written \"$" + input.name.text + "\"");
                c.reporter.note(param.name.place, "the parameter is declared here");
            }
    }
}

const PassType* findType(Compilation& c, const PassDesc& pass) {
    const PassType* type = c.catalog.passes->find(pass.type.text);
    if (type != nullptr || pass.type.text.empty())
        return type;
    std::vector<std::string> names;
    for (const PassType& known : c.catalog.passes->all())
        names.push_back(known.name);
    c.reporter.error("E0301", pass.type.place, "there is no pass type \"" + pass.type.text + "\"",
                     suggest(pass.type.text, names, "this program has"));
    return nullptr;
}

void placeNode(Compilation& c, const PassDesc& pass, PlannedNode& node) {
    const std::string& on = pass.on.text;
    if (on == "host")
        node.on = Placement::kHost;
    else if (on == "device")
        node.on = Placement::kDevice;
    else if (!on.empty() && on != "auto")
        c.reporter.error("E0701", pass.on.place, "there is no place \"" + on + "\" to run on",
                         suggest(on, {"host", "device", "auto"}, "there are"));
    if (node.type == nullptr)
        return;
    const bool is_impossible =
        (node.on == Placement::kHost && node.type->domain == Domain::kDevice) ||
        (node.on == Placement::kDevice && node.type->domain == Domain::kHost);
    if (is_impossible)
        c.reporter.error("E0702", pass.on.place,
                         "pass \"" + node.name + "\" cannot run on the " + on,
                         "\"" + node.type->name + "\" runs on the " +
                             (node.on == Placement::kHost ? "device" : "host") + " only");
}

void declarePasses(Compilation& c, const std::vector<PassDesc>& passes, NodeId scope,
                   const std::string& prefix);

void declareLoop(Compilation& c, const PassDesc& pass, NodeId id) {
    const std::string name = c.graph.nodes[id].name;
    const std::uint32_t index = static_cast<std::uint32_t>(c.graph.loops.size());
    c.graph.nodes[id].loop = index;
    PlannedLoop& loop = c.graph.loops.emplace_back();
    loop.node = id;
    loop.check_every = pass.loop->check_every;
    for (const CarryDesc& carry : pass.loop->carry) {
        PlannedCarry& planned = loop.carries.emplace_back();
        planned.name = carry.name.text;
        // Its type is that of what it begins with; checkTypes finds it.
        planned.value = addValue(c.graph, name + "." + carry.name.text, PortType{}, id, id);
        c.graph.nodes[id].outputs.push_back({.value = planned.value});
    }
    loop.stats = addValue(c.graph, name + ".stats", types::kCurve, id, c.graph.nodes[id].parent);
    c.graph.nodes[id].outputs.push_back({.value = loop.stats});
    declarePasses(c, pass.loop->passes, id, name + ".");
}

void declarePass(Compilation& c, const PassDesc& pass, NodeId id) {
    const PassType* type = findType(c, pass);
    PlannedNode& node = c.graph.nodes[id];
    node.type = type;
    placeNode(c, pass, node);
    if (type == nullptr)
        return;
    node.params = PassParams(*type);
    for (const OutPort& port : type->outputs)
        node.outputs.push_back(
            {.value = addValue(c.graph, node.name + "." + port.name, port.type, id, node.parent)});
}

void declarePasses(Compilation& c, const std::vector<PassDesc>& passes, NodeId scope,
                   const std::string& prefix) {
    for (const PassDesc& pass : passes) {
        const NodeId id = static_cast<NodeId>(c.graph.nodes.size());
        // One name means one thing: an inner pass must not hide an outer one.
        for (NodeId outer = scope; outer != kNoId;) {
            outer = c.graph.nodes[outer].parent;
            const auto hidden = c.node_names.find({outer, pass.name.text});
            if (hidden == c.node_names.end())
                continue;
            c.reporter.error("E0206", pass.name.place,
                             "\"" + pass.name.text + "\" is also a pass outside this loop",
                             "rename one of them");
            c.reporter.note(c.written[hidden->second]->name.place, "the other one is here");
        }
        PlannedNode& node = c.graph.nodes.emplace_back();
        node.name = prefix + pass.name.text;
        node.parent = scope;
        c.written.push_back(&pass);
        c.node_names.emplace(std::pair(scope, pass.name.text), id);
        if (pass.loop)
            declareLoop(c, pass, id);
        else
            declarePass(c, pass, id);
    }
}

} // namespace

void declareNames(Compilation& c) {
    c.graph.name = c.desc.name;
    c.graph.doc = c.desc.doc;
    c.graph.file = c.desc.source.file();
    declareInputs(c);
    declarePasses(c, c.desc.passes, kNoId, "");
    c.edge_places.resize(c.graph.nodes.size());
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/graph/compilation.h"

#include <algorithm>

namespace hone {
namespace {

constexpr std::size_t kMaxNodes = 4096;

ValueId addValue(CompiledGraph& graph, std::string name, const PortType& type, NodeId writer,
                 NodeId scope) {
    PlannedValue& value = graph.values.emplace_back();
    value.name = std::move(name);
    value.type = type;
    value.writer = writer;
    value.scope = scope;
    return static_cast<ValueId>(graph.values.size() - 1);
}

class Declarer {
public:
    explicit Declarer(Compilation& c) : c_(&c) {}

    void declareGraph(const GraphDesc& desc, ScopeId parent, NodeId loop, const PassDesc* use,
                      const std::string& prefix) {
        const ScopeId id = static_cast<ScopeId>(c_->scopes.size());
        std::uint32_t used = kNoId;
        if (use != nullptr) {
            c_->scopes[parent].graphs.emplace(use->name.text, id);
            used = static_cast<std::uint32_t>(c_->graph.graphs.size());
            c_->graph.graphs.push_back({.name = prefix.substr(0, prefix.size() - 1),
                                        .file = use->graph.text,
                                        .parent = loop,
                                        .graph = c_->scopes[parent].planned,
                                        .outputs = {}});
        }
        c_->scopes.push_back({.parent = parent,
                              .loop = loop,
                              .graph = &desc,
                              .use = use,
                              .planned = used,
                              .prefix = prefix,
                              .nodes = {},
                              .graphs = {},
                              .params = {}});
        checkPlugins(desc);
        declareInputs(desc, id);
        for (const GraphParamDesc& param : desc.params) {
            c_->scopes[id].params.emplace(param.name.text,
                                          static_cast<ParamId>(c_->graph.params.size()));
            PlannedParam& planned = c_->graph.params.emplace_back();
            planned.decl = param.decl;
            planned.decl.name = prefix + param.decl.name;
        }
        declarePasses(desc.passes, id);
    }

private:
    /// Only values of the outermost graph come from outside; those of others are edges.
    void declareInputs(const GraphDesc& desc, ScopeId scope) {
        std::vector<std::string> names{"scene", "camera", "extent"};
        const std::vector<PortType> known = graphTypes(*c_->catalog.passes);
        for (const PortType& type : known)
            names.emplace_back(type.name);
        for (const GraphInputDesc& input : desc.inputs) {
            const std::string& type = input.type.text;
            const std::string_view meant = type == "scene"    ? types::kScene.name
                                           : type == "camera" ? types::kCamera.name
                                           : type == "extent" ? types::kExtent.name
                                                              : std::string_view(type);
            const auto found = std::ranges::find(known, meant, &PortType::name);
            if (found == known.end() && !type.empty())
                c_->reporter.error("E0307", input.type.place,
                                   "there is no graph input of type \"" + type + "\"",
                                   suggest(type, names, "there are"));
            c_->scopes[scope].input_types.push_back(found != known.end() ? *found : PortType{});
            if (c_->scopes[scope].use == nullptr) {
                const ValueId value =
                    found == known.end()
                        ? kNoId
                        : addValue(c_->graph, "$" + input.name.text, *found, kNoId, kNoId);
                c_->scopes[scope].inputs.push_back(value);
                c_->graph.inputs.push_back({input.name.text, value});
            }
            for (const GraphParamDesc& param : desc.params)
                if (param.name.text == input.name.text) {
                    c_->reporter.error("E0206", input.name.place,
                                       "\"" + input.name.text + "\" is an input and a parameter",
                                       "rename one: both are written \"$" + input.name.text + "\"");
                    c_->reporter.note(param.name.place, "the parameter is declared here");
                }
        }
    }

    /// What a graph takes from a plug-in must be there.
    void checkPlugins(const GraphDesc& desc) {
        for (const PluginDesc& plugin : desc.plugins) {
            const auto all = c_->catalog.passes->all();
            const bool is_loaded = std::ranges::any_of(
                all, [&](const PassType& type) { return type.plugin == plugin.name.text; });
            std::vector<std::string> lacking;
            for (const Word& pass : plugin.passes) {
                const PassType* type = c_->catalog.passes->find(pass.text);
                if (type != nullptr && type->plugin == plugin.name.text)
                    continue;
                lacking.push_back(pass.text);
                missing_.push_back(pass.text);
                if (is_loaded)
                    c_->reporter.error("E0309", pass.place,
                                       "plug-in \"" + plugin.name.text + "\" has no pass type \"" +
                                           pass.text + "\"",
                                       "is it another version of the plug-in? \"hone passes\" "
                                       "lists what there is");
            }
            if (!is_loaded)
                c_->reporter.error(
                    "E0308", plugin.name.place,
                    "plug-in \"" + plugin.name.text + "\" is not loaded" +
                        (lacking.empty() ? std::string()
                                         : "; the graph takes " + quotedList(lacking) + " from it"),
                    "name its file with --plugin, or its folder in HONE_PLUGIN_PATH");
        }
    }

    const PassType* findType(const PassDesc& pass) {
        if (pass.type.text == "glsl")
            return compileShader(pass);
        const PassType* type = c_->catalog.passes->find(pass.type.text);
        const bool is_told = std::ranges::find(missing_, pass.type.text) != missing_.end();
        if (type != nullptr || pass.type.text.empty() || is_told)
            return type;
        std::vector<std::string> names{"glsl"};
        for (const PassType& known : c_->catalog.passes->all())
            names.push_back(known.name);
        c_->reporter.error("E0301", pass.type.place,
                           "there is no pass type \"" + pass.type.text + "\"",
                           suggest(pass.type.text, names, "this program has"));
        return nullptr;
    }

    /// A shader is compiled once, however many passes use it.
    const PassType* compileShader(const PassDesc& pass) {
        if (pass.code == nullptr)
            return nullptr;
        if (c_->catalog.shaders == nullptr) {
            c_->reporter.error("E0313", pass.type.place,
                               "this program cannot compile shaders for passes of type \"glsl\"",
                               "it was given no shader compiler");
            return nullptr;
        }
        const auto known = shaders_.find(pass.code);
        if (known != shaders_.end())
            return known->second;
        const PassType*& type = shaders_[pass.code];
        ShaderPass made = (*c_->catalog.shaders)(pass.code->file(), pass.code->text());
        for (const ShaderProblem& problem : made.problems)
            c_->reporter.error("E0314", placeOf(*pass.code, problem), problem.message,
                               problem.hint);
        if (made.type && made.problems.empty()) {
            c_->graph.shader_types.push_back(
                std::make_shared<const PassType>(std::move(*made.type)));
            type = c_->graph.shader_types.back().get();
        }
        return type;
    }

    static Place placeOf(const SourceText& code, const ShaderProblem& problem) {
        const std::size_t line = std::clamp<std::size_t>(problem.line, 1, code.lineCount());
        const std::string_view text = code.line(line);
        const std::size_t column = std::clamp<std::size_t>(problem.column, 1, text.size() + 1);
        const std::size_t length =
            problem.column == 0 ? text.size() : std::min(problem.length, text.size() + 1 - column);
        return {{code.begin(line) + static_cast<std::uint32_t>(column - 1),
                 static_cast<std::uint32_t>(length)},
                "",
                &code};
    }

    void placeNode(const PassDesc& pass, PlannedNode& node) {
        const std::string& on = pass.on.text;
        if (on == "host")
            node.on = Placement::kHost;
        else if (on == "device")
            node.on = Placement::kDevice;
        else if (!on.empty() && on != "auto")
            c_->reporter.error("E0701", pass.on.place, "there is no place \"" + on + "\" to run on",
                               suggest(on, {"host", "device", "auto"}, "there are"));
        if (node.type == nullptr)
            return;
        const bool is_impossible =
            (node.on == Placement::kHost && node.type->domain == Domain::kDevice) ||
            (node.on == Placement::kDevice && node.type->domain == Domain::kHost);
        if (is_impossible)
            c_->reporter.error("E0702", pass.on.place,
                               "pass \"" + pass.name.text + "\" cannot run on the " + on,
                               "\"" + node.type->name + "\" runs on the " +
                                   (node.on == Placement::kHost ? "device" : "host") + " only");
    }

    void declareLoop(const PassDesc& pass, NodeId id, ScopeId around) {
        const std::string name = c_->graph.nodes[id].name;
        const std::uint32_t index = static_cast<std::uint32_t>(c_->graph.loops.size());
        c_->graph.nodes[id].loop = index;
        PlannedLoop& loop = c_->graph.loops.emplace_back();
        loop.node = id;
        loop.check_every = pass.loop->check_every;
        for (const CarryDesc& carry : pass.loop->carry) {
            PlannedCarry& planned = loop.carries.emplace_back();
            planned.name = carry.name.text;
            // Its type is that of what it begins with; checkTypes finds it.
            planned.value = addValue(c_->graph, name + "." + carry.name.text, PortType{}, id, id);
            c_->graph.nodes[id].outputs.push_back({.value = planned.value});
        }
        loop.stats =
            addValue(c_->graph, name + ".stats", types::kCurve, id, c_->graph.nodes[id].parent);
        c_->graph.nodes[id].outputs.push_back({.value = loop.stats});
        const ScopeId body = static_cast<ScopeId>(c_->scopes.size());
        c_->loop_scopes.emplace(id, body);
        c_->scopes.push_back({.parent = around,
                              .loop = id,
                              .graph = nullptr,
                              .use = nullptr,
                              .planned = c_->scopes[around].planned,
                              .prefix = name + ".",
                              .nodes = {},
                              .graphs = {},
                              .params = {}});
        declarePasses(pass.loop->passes, body);
    }

    void declarePass(const PassDesc& pass, NodeId id) {
        const PassType* type = findType(pass);
        PlannedNode& node = c_->graph.nodes[id];
        node.type = type;
        placeNode(pass, node);
        if (type == nullptr)
            return;
        node.params = PassParams(*type);
        for (const OutPort& port : type->outputs)
            node.outputs.push_back({.value = addValue(c_->graph, node.name + "." + port.name,
                                                      port.type, id, node.parent)});
    }

    /// One name means one thing: an inner pass must not hide an outer one.
    void reportHidden(const PassDesc& pass, ScopeId scope) {
        while (c_->scopes[scope].graph == nullptr) {
            scope = c_->scopes[scope].parent;
            const Scope& outer = c_->scopes[scope];
            const auto node = outer.nodes.find(pass.name.text);
            const auto graph = outer.graphs.find(pass.name.text);
            if (node == outer.nodes.end() && graph == outer.graphs.end())
                continue;
            c_->reporter.error("E0206", pass.name.place,
                               "\"" + pass.name.text + "\" is also a pass outside this loop",
                               "rename one of them");
            c_->reporter.note(node != outer.nodes.end() ? c_->written[node->second].desc->name.place
                                                        : c_->scopes[graph->second].use->name.place,
                              "the other one is here");
        }
    }

    void declarePasses(const std::vector<PassDesc>& passes, ScopeId scope) {
        for (const PassDesc& pass : passes) {
            if (c_->graph.nodes.size() + c_->scopes.size() > kMaxNodes) {
                c_->reporter.error("E0104", pass.name.place,
                                   "with the graphs that it uses, the graph has more than 4096 "
                                   "passes");
                return;
            }
            reportHidden(pass, scope);
            const std::string name = c_->scopes[scope].prefix + pass.name.text;
            const NodeId loop = c_->scopes[scope].loop;
            if (!pass.graph.text.empty()) {
                if (pass.body != nullptr)
                    declareGraph(*pass.body, scope, loop, &pass, name + ".");
                else
                    c_->scopes[scope].graphs.emplace(pass.name.text, kNoId);
                continue;
            }
            const NodeId id = static_cast<NodeId>(c_->graph.nodes.size());
            PlannedNode& node = c_->graph.nodes.emplace_back();
            node.name = name;
            node.parent = loop;
            node.graph = c_->scopes[scope].planned;
            c_->written.push_back({.desc = &pass, .scope = scope, .edges = {}, .conditions = {}});
            c_->scopes[scope].nodes.emplace(pass.name.text, id);
            if (pass.loop)
                declareLoop(pass, id, scope);
            else
                declarePass(pass, id);
        }
    }

    Compilation* c_;
    std::vector<std::string> missing_; ///< pass types of plug-ins that are not there
    std::map<const SourceText*, const PassType*> shaders_;
};

} // namespace

void declareNames(Compilation& c) {
    c.graph.name = c.desc.name;
    c.graph.doc = c.desc.doc;
    c.graph.file = c.desc.source->file();
    Declarer(c).declareGraph(c.desc, kNoId, kNoId, nullptr, "");
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/graph/compilation.h"
#include "hone/core/graph/parameters.h"

#include <algorithm>
#include <set>

namespace hone {
namespace {

class ParamBinder {
public:
    ParamBinder(Compilation& c, const Overrides& overrides) : c_(&c), overrides_(&overrides) {}

    void bind() {
        // Graphs come before those that they use, so a value is known before it is handed on.
        for (ScopeId id = 0; id < c_->scopes.size(); ++id)
            if (c_->scopes[id].graph != nullptr) {
                declareParams(id);
                markLost(id, c_->scopes[id].graph->passes);
                if (c_->scopes[id].use != nullptr)
                    feedGraph(id);
                override([&](const std::string& path) {
                    const PlannedParam* param = c_->graph.findParam(path);
                    return param != nullptr && owns(id, *param);
                });
            }
        for (NodeId id = 0; id < c_->graph.nodes.size(); ++id) {
            if (c_->graph.nodes[id].loop != kNoId)
                bindStopRules(id);
            else
                bindPass(id);
        }
        bindConditions();
        // Passes' own come last, because they win.
        override([&](const std::string& path) { return c_->graph.findParam(path) == nullptr; });
        reportUnread();
    }

private:
    void report(const ParamProblem& problem, const Place& place) {
        c_->reporter.error(problem.code, place, problem.message, problem.hint);
    }

    bool owns(ScopeId scope, const PlannedParam& param) const {
        const auto id = static_cast<ParamId>(&param - c_->graph.params.data());
        return std::ranges::any_of(c_->scopes[scope].params,
                                   [&](const auto& entry) { return entry.second == id; });
    }

    void declareParams(ScopeId scope) {
        for (const GraphParamDesc& desc : c_->scopes[scope].graph->params) {
            PlannedParam& param = c_->graph.params[c_->scopes[scope].params.at(desc.name.text)];
            param.decl.choices = choicesOf(desc.decl, c_->catalog);
            param.value = desc.decl.fallback;
            if (desc.decl.min && desc.decl.max && *desc.decl.min > *desc.decl.max)
                c_->reporter.error("E0507", desc.name.place,
                                   "parameter \"" + desc.decl.name +
                                       "\" has a \"min\" above its \"max\"");
            checkDefault(desc);
        }
    }

    void checkDefault(const GraphParamDesc& desc) {
        const ParamValue& fallback = desc.decl.fallback;
        ParamLiteral literal;
        if (const bool* flag = std::get_if<bool>(&fallback))
            literal = *flag;
        else if (const uint* whole = std::get_if<uint>(&fallback))
            literal = static_cast<double>(*whole);
        else if (const float* number = std::get_if<float>(&fallback))
            literal = static_cast<double>(*number);
        else
            literal = std::get<std::string>(fallback);
        // A default of another type was reported where it was read, and left its mark: the index.
        const bool is_read = (desc.decl.type == ParamType::kBool && fallback.index() == 0) ||
                             (desc.decl.type == ParamType::kUint && fallback.index() == 1) ||
                             (desc.decl.type == ParamType::kFloat && fallback.index() == 2) ||
                             (desc.decl.type == ParamType::kEnum && fallback.index() == 3);
        if (!is_read)
            return;
        const auto value = readParam(desc.decl, literal, c_->catalog,
                                     "the default of parameter \"" + desc.decl.name + "\"");
        if (const ParamProblem* problem = std::get_if<ParamProblem>(&value))
            report(*problem, desc.default_place);
    }

    /// Gives the parameters of a graph that is used as a pass the values that its user wrote.
    void feedGraph(ScopeId id) {
        const Scope& scope = c_->scopes[id];
        for (const ParamText& text : scope.use->params) {
            const auto found = scope.params.find(text.name.text);
            if (found == scope.params.end()) {
                markRead(scope.parent, text);
                reportUnknown(text, namesOf(scope), "graph \"" + scope.use->name.text + "\"");
                continue;
            }
            PlannedParam& param = c_->graph.params[found->second];
            param.value = valueOf(scope.parent, text, param.decl,
                                  "parameter \"" + text.name.text + "\" of graph \"" +
                                      scope.use->name.text + "\"",
                                  {.graph_param = found->second, .place = {}}, param.value);
        }
    }

    static std::vector<std::string> namesOf(const Scope& scope) {
        std::vector<std::string> names;
        for (const auto& [name, param] : scope.params)
            names.push_back(name);
        return names;
    }

    template <class Concerns> void override(const Concerns& concerns) {
        for (const auto& [path, text] : *overrides_) {
            if (!concerns(path))
                continue;
            std::vector<NodeId> changed;
            if (auto problem = assignParam(c_->graph, c_->catalog, path, text, changed)) {
                problem->message = "override " + path + "=" + text + ": " + problem->message;
                report(*problem, {});
            }
        }
    }

    /// The graph parameter that "$name" means in a scope; null when there is none, which is then
    /// reported.
    PlannedParam* findParam(ScopeId scope, const std::string& name, const Place& place) {
        const Scope& graph = c_->scopes[c_->graphOf(scope)];
        if (const auto found = graph.params.find(name); found != graph.params.end()) {
            read_.insert(found->second);
            return &c_->graph.params[found->second];
        }
        std::vector<std::string> names;
        for (const std::string& known : namesOf(graph))
            names.push_back("$" + known);
        c_->reporter.error("E0505", place, "the graph has no parameter \"$" + name + "\"",
                           suggest("$" + name, names, "it has"));
        markMeant(graph, nearest("$" + name, names));
        return nullptr;
    }

    /// The value that was written, or `fallback` if it was wrong. A reference becomes `use`.
    ParamValue valueOf(ScopeId scope, const ParamText& text, const ParamDecl& decl,
                       const std::string& whose, ParamUse use, const ParamValue& fallback) {
        std::variant<ParamValue, ParamProblem> value = fallback;
        if (text.isReference()) {
            PlannedParam* param =
                findParam(scope, std::get<std::string>(text.value).substr(1), text.place);
            if (param == nullptr)
                return fallback;
            value = convertParam(*param, decl, c_->catalog, whose);
            use.place = text.place;
            param->uses.push_back(use);
        } else {
            value = readParam(decl, text.value, c_->catalog, whose);
        }
        if (const ParamProblem* problem = std::get_if<ParamProblem>(&value)) {
            report(withReference(*problem, scope, text, decl), text.place);
            return fallback;
        }
        return std::get<ParamValue>(value);
    }

    /// A word that is no value may be a graph parameter's name without its "$".
    ParamProblem withReference(ParamProblem problem, ScopeId scope, const ParamText& text,
                               const ParamDecl& decl) {
        const std::string* word = std::get_if<std::string>(&text.value);
        if (word == nullptr || text.isReference())
            return problem;
        const Scope& graph = c_->scopes[c_->graphOf(scope)];
        std::vector<std::string> meant;
        if (decl.type == ParamType::kEnum)
            meant = choicesOf(decl, c_->catalog);
        for (const std::string& known : namesOf(graph))
            meant.push_back("$" + known);
        if (const std::string near = nearest(*word, meant); near.starts_with('$')) {
            problem.hint = "did you mean \"" + near + "\"?";
            markMeant(graph, near);
        }
        return problem;
    }

    /// What a mistake was meant to read is not unread: one report is enough. `reference`: "$name".
    void markMeant(const Scope& graph, const std::string& reference) {
        if (!reference.empty())
            read_.insert(graph.params.at(reference.substr(1)));
    }

    void bindPass(NodeId id) {
        const PassDesc& desc = *c_->written[id].desc;
        const ScopeId scope = c_->written[id].scope;
        PlannedNode& node = c_->graph.nodes[id];
        if (node.type == nullptr) {
            for (const ParamText& text : desc.params)
                markRead(scope, text);
            for (const InputDesc& input : desc.inputs)
                for (const EdgeDesc& edge : input.edges)
                    for (const ParamText& text : edge.params)
                        markRead(scope, text);
            return;
        }
        for (const ParamText& text : desc.params) {
            const ParamDecl* decl = node.type->findParam(text.name.text);
            if (decl == nullptr) {
                markRead(scope, text);
                reportUnknown(text, namesOf(node.type->params),
                              "pass \"" + c_->nameOf(id) + "\" (" + node.type->name + ")");
                continue;
            }
            const auto index = static_cast<std::uint32_t>(decl - node.type->params.data());
            node.params.set(
                decl->name,
                valueOf(scope, text, *decl,
                        "parameter \"" + decl->name + "\" of pass \"" + c_->nameOf(id) + "\"",
                        {.node = id, .param = index, .place = {}}, decl->fallback));
        }
        bindEdges(id);
    }

    void bindEdges(NodeId id) {
        PlannedNode& node = c_->graph.nodes[id];
        std::uint32_t index = 0;
        for (const InputDesc& input : c_->written[id].desc->inputs) {
            const InPort* port = node.type->findIn(input.port.text);
            for (std::size_t i = 0; i < input.edges.size(); ++i) {
                if (port == nullptr || i >= InPort::kMaxEdges)
                    for (const ParamText& text : input.edges[i].params)
                        markRead(c_->written[id].scope, text);
                else
                    bindEdge(id, index++, *port, input.edges[i]);
            }
        }
    }

    void bindEdge(NodeId id, std::uint32_t index, const InPort& port, const EdgeDesc& desc) {
        PlannedNode& node = c_->graph.nodes[id];
        const ScopeId scope = c_->written[id].scope;
        PlannedEdge& edge = node.inputs[index];
        const std::string into = "an edge into \"" + c_->nameOf(id) + "." + port.name + "\"";
        for (const ParamDecl& decl : port.edge_params)
            edge.params.push_back(decl.fallback);
        for (const ParamText& text : desc.params) {
            const auto decl = std::ranges::find(port.edge_params, text.name.text, &ParamDecl::name);
            if (decl == port.edge_params.end()) {
                markRead(scope, text);
                reportUnknown(text, namesOf(port.edge_params), into);
                continue;
            }
            const auto param = static_cast<std::uint32_t>(decl - port.edge_params.begin());
            edge.params[param] = valueOf(
                scope, text, *decl, "\"" + decl->name + "\" of " + into,
                {.node = id, .edge = index, .edge_param = param, .place = {}}, decl->fallback);
        }
    }

    void bindStopRules(NodeId id) {
        const LoopDesc& desc = *c_->written[id].desc->loop;
        PlannedLoop& loop = c_->graph.loops[c_->graph.nodes[id].loop];
        for (std::uint32_t i = 0; i < loop.stop.size(); ++i)
            if (loop.stop[i].kind != StopRule::Kind::kEmpty)
                loop.stop[i].limit = limitOf(c_->written[id].scope, desc.stop[i].rule,
                                             {.node = id, .stop_rule = i, .place = {}});
        if (!isBounded(loop))
            c_->reporter.error(
                "E0601", desc.place, "loop \"" + c_->nameOf(id) + "\" may never end",
                "add { \"iterations\": 64 } (or \"rays\", \"ms\") above 0 to its \"stop\"");
    }

    double limitOf(ScopeId scope, const ParamText& text, ParamUse use) {
        ParamDecl decl;
        decl.name = text.name.text;
        decl.type = ParamType::kFloat;
        decl.min = 0;
        const std::string whose = "stop rule \"" + decl.name + "\"";
        if (!text.isReference()) {
            // Not as a float: rays are counted beyond its 24 bits.
            const auto value = readParam(decl, text.value, c_->catalog, whose);
            if (const ParamProblem* problem = std::get_if<ParamProblem>(&value)) {
                report(withReference(*problem, scope, text, decl), text.place);
                return 1; // bounded: one report is enough
            }
            return std::get<double>(text.value);
        }
        PlannedParam* param =
            findParam(scope, std::get<std::string>(text.value).substr(1), text.place);
        if (param == nullptr)
            return 1;
        use.place = text.place;
        const auto value = convertParam(*param, decl, c_->catalog, whose);
        if (const ParamProblem* problem = std::get_if<ParamProblem>(&value)) {
            report(*problem, text.place);
            return 1;
        }
        param->uses.push_back(use);
        if (const uint* whole = std::get_if<uint>(&param->value))
            return *whole;
        return static_cast<double>(std::get<float>(param->value));
    }

    /// What a `when` means; nothing, with a report, where it means nothing.
    std::optional<Condition> readWhen(const WhenDesc& when, ScopeId scope) {
        PlannedParam* param = findParam(scope, when.param.text.substr(1), when.param.place);
        if (param == nullptr)
            return std::nullopt;
        param->is_switch = true;
        Condition condition{static_cast<ParamId>(param - c_->graph.params.data()), {}};
        const ParamType wanted = when.choices.empty() ? ParamType::kBool : ParamType::kEnum;
        if (param->decl.type != wanted) {
            c_->reporter.error("E0512", when.param.place,
                               "\"" + when.param.text + "\" is of type " + name(param->decl.type) +
                                   "; \"when\" needs " + name(wanted) + " here",
                               wanted == ParamType::kBool
                                   ? "for an enum write {\"" + when.param.text +
                                         "\": [\"choice\", ...]}"
                                   : "for a bool write \"" + when.param.text + "\" or \"!" +
                                         when.param.text + "\"");
            return std::nullopt;
        }
        if (when.choices.empty())
            condition.on.emplace_back(!when.is_negated);
        for (const Word& choice : when.choices) {
            const auto value = readParam(param->decl, choice.text, c_->catalog,
                                         "parameter \"" + when.param.text + "\"");
            if (const ParamProblem* problem = std::get_if<ParamProblem>(&value))
                report(*problem, choice.place);
            else
                condition.on.push_back(std::get<ParamValue>(value));
        }
        return condition;
    }

    /// A node runs when its own condition holds and those of all loops and graphs around it.
    void bindConditions() {
        std::vector<std::vector<Condition>> of_scope(c_->scopes.size());
        const auto add = [&](std::vector<Condition>& conditions, const PassDesc& pass,
                             ScopeId scope) {
            if (pass.when)
                if (std::optional<Condition> condition = readWhen(*pass.when, scope))
                    conditions.push_back(std::move(*condition));
        };
        std::vector<NodeId> loop_of(c_->scopes.size(), kNoId);
        for (const auto& [loop, body] : c_->loop_scopes)
            loop_of[body] = loop;
        for (ScopeId id = 0; id < c_->scopes.size(); ++id) {
            const Scope& scope = c_->scopes[id];
            if (scope.parent != kNoId)
                of_scope[id] = of_scope[scope.parent];
            if (scope.use != nullptr)
                add(of_scope[id], *scope.use, scope.parent);
            else if (loop_of[id] != kNoId)
                add(of_scope[id], *c_->written[loop_of[id]].desc, scope.parent);
        }
        for (WrittenNode& node : c_->written) {
            node.conditions = of_scope[node.scope];
            add(node.conditions, *node.desc, node.scope);
        }
    }

    static std::vector<std::string> namesOf(const std::vector<ParamDecl>& decls) {
        std::vector<std::string> names;
        for (const ParamDecl& decl : decls)
            names.push_back(decl.name);
        return names;
    }

    void reportUnknown(const ParamText& text, const std::vector<std::string>& names,
                       const std::string& what) {
        c_->reporter.error(
            "E0501", text.name.place, what + " has no parameter \"" + text.name.text + "\"",
            names.empty() ? "it has none" : suggest(text.name.text, names, "it has"));
    }

    void markRead(ScopeId scope, const ParamText& text) {
        const Scope& graph = c_->scopes[c_->graphOf(scope)];
        if (!text.isReference())
            return;
        const auto found = graph.params.find(std::get<std::string>(text.value).substr(1));
        if (found != graph.params.end())
            read_.insert(found->second);
    }

    /// What is handed to graphs that could not be read: that is the report.
    void markLost(ScopeId scope, const std::vector<PassDesc>& passes) {
        for (const PassDesc& pass : passes) {
            if (pass.loop)
                markLost(scope, pass.loop->passes);
            if (!pass.graph.text.empty() && pass.body == nullptr)
                for (const ParamText& text : pass.params)
                    markRead(scope, text);
        }
    }

    void reportUnread() {
        for (const Scope& scope : c_->scopes)
            for (const auto& [name, id] : scope.params)
                if (!read_.contains(id)) {
                    const auto desc = std::ranges::find(
                        scope.graph->params, name,
                        [](const GraphParamDesc& param) { return param.name.text; });
                    c_->reporter.error(
                        "E0506", desc->name.place, "nothing reads parameter \"" + name + "\"",
                        "write \"$" + name + "\" where it should count, or remove it");
                }
    }

    Compilation* c_;
    const Overrides* overrides_;
    std::set<ParamId> read_;
};

} // namespace

void bindParams(Compilation& c, const Overrides& overrides) {
    ParamBinder(c, overrides).bind();
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/graph/compilation.h"
#include "hone/core/graph/parameters.h"

#include <algorithm>
#include <set>

namespace hone {
namespace {

class ParamBinder {
public:
    explicit ParamBinder(Compilation& c) : c_(&c) {}

    void bind(const Overrides& overrides) {
        declareParams();
        overrideParams(overrides, true);
        for (NodeId id = 0; id < c_->graph.nodes.size(); ++id) {
            if (c_->graph.nodes[id].loop != kNoId)
                bindStopRules(id);
            else
                bindPass(id);
        }
        overrideParams(overrides, false);
        reportUnread();
    }

private:
    void report(const ParamProblem& problem, const Place& place) {
        c_->reporter.error(problem.code, place, problem.message, problem.hint);
    }

    void declareParams() {
        for (const GraphParamDesc& desc : c_->desc.params) {
            PlannedParam& param = c_->graph.params.emplace_back();
            param.decl = desc.decl;
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

    /// Graph parameters first, because passes take their values; passes' own after that, because
    /// they win.
    void overrideParams(const Overrides& overrides, bool graph_params) {
        for (const auto& [path, text] : overrides) {
            if ((c_->graph.findParam(path) != nullptr) != graph_params)
                continue;
            std::vector<NodeId> changed;
            if (auto problem = assignParam(c_->graph, c_->catalog, path, text, changed)) {
                problem->message = "override " + path + "=" + text + ": " + problem->message;
                report(*problem, {});
            }
        }
    }

    /// The graph parameter that "$name" means; null when there is none, which is then reported.
    PlannedParam* findParam(const ParamText& text) {
        const std::string name = std::get<std::string>(text.value).substr(1);
        read_.insert(name);
        std::vector<std::string> names;
        for (PlannedParam& param : c_->graph.params) {
            if (param.decl.name == name)
                return &param;
            names.push_back("$" + param.decl.name);
        }
        c_->reporter.error("E0505", text.place, "the graph has no parameter \"$" + name + "\"",
                           suggest("$" + name, names, "it has"));
        return nullptr;
    }

    /// The value that was written, or `fallback` if it was wrong. A reference becomes `use`.
    ParamValue valueOf(const ParamText& text, const ParamDecl& decl, const std::string& whose,
                       ParamUse use, const ParamValue& fallback) {
        std::variant<ParamValue, ParamProblem> value = fallback;
        if (text.isReference()) {
            PlannedParam* param = findParam(text);
            if (param == nullptr)
                return fallback;
            value = convertParam(*param, decl, c_->catalog, whose);
            use.place = text.place;
            param->uses.push_back(use);
        } else {
            value = readParam(decl, text.value, c_->catalog, whose);
        }
        if (const ParamProblem* problem = std::get_if<ParamProblem>(&value)) {
            report(*problem, text.place);
            return fallback;
        }
        return std::get<ParamValue>(value);
    }

    void bindPass(NodeId id) {
        const PassDesc& desc = *c_->written[id];
        PlannedNode& node = c_->graph.nodes[id];
        if (node.type == nullptr) {
            markRead(desc);
            return;
        }
        for (const ParamText& text : desc.params) {
            const ParamDecl* decl = node.type->findParam(text.name.text);
            if (decl == nullptr) {
                markRead(text);
                reportUnknown(text, node.type->params,
                              "pass \"" + node.name + "\" (" + node.type->name + ")");
                continue;
            }
            const auto index = static_cast<std::uint32_t>(decl - node.type->params.data());
            node.params.set(
                decl->name,
                valueOf(text, *decl,
                        "parameter \"" + decl->name + "\" of pass \"" + node.name + "\"",
                        {.node = id, .param = index, .place = {}}, decl->fallback));
        }
        bindEdges(id);
    }

    void bindEdges(NodeId id) {
        PlannedNode& node = c_->graph.nodes[id];
        std::uint32_t index = 0;
        for (const InputDesc& input : c_->written[id]->inputs) {
            const InPort* port = node.type->findIn(input.port.text);
            for (std::size_t i = 0; i < input.edges.size(); ++i) {
                if (port == nullptr || i >= InPort::kMaxEdges)
                    for (const ParamText& text : input.edges[i].params)
                        markRead(text);
                else
                    bindEdge(id, index++, *port, input.edges[i]);
            }
        }
    }

    void bindEdge(NodeId id, std::uint32_t index, const InPort& port, const EdgeDesc& desc) {
        PlannedNode& node = c_->graph.nodes[id];
        PlannedEdge& edge = node.inputs[index];
        for (const ParamDecl& decl : port.edge_params)
            edge.params.push_back(decl.fallback);
        for (const ParamText& text : desc.params) {
            const auto decl = std::ranges::find(port.edge_params, text.name.text, &ParamDecl::name);
            if (decl == port.edge_params.end()) {
                markRead(text);
                reportUnknown(text, port.edge_params,
                              "an edge into \"" + node.name + "." + port.name + "\"");
                continue;
            }
            const auto param = static_cast<std::uint32_t>(decl - port.edge_params.begin());
            edge.params[param] = valueOf(
                text, *decl,
                "\"" + decl->name + "\" of an edge into \"" + node.name + "." + port.name + "\"",
                {.node = id, .edge = index, .edge_param = param, .place = {}}, decl->fallback);
        }
    }

    void bindStopRules(NodeId id) {
        const LoopDesc& desc = *c_->written[id]->loop;
        const std::string& name = c_->graph.nodes[id].name;
        PlannedLoop& loop = c_->graph.loops[c_->graph.nodes[id].loop];
        for (std::uint32_t i = 0; i < loop.stop.size(); ++i)
            if (loop.stop[i].kind != StopRule::Kind::kEmpty)
                loop.stop[i].limit =
                    limitOf(desc.stop[i].rule, {.node = id, .stop_rule = i, .place = {}});
        if (!isBounded(loop))
            c_->reporter.error(
                "E0601", desc.place, "loop \"" + name + "\" may never end",
                "add { \"iterations\": 64 } (or \"rays\", \"ms\") above 0 to its \"stop\"");
    }

    double limitOf(const ParamText& text, ParamUse use) {
        ParamDecl decl;
        decl.name = text.name.text;
        decl.type = ParamType::kFloat;
        decl.min = 0;
        const std::string whose = "stop rule \"" + decl.name + "\"";
        if (!text.isReference()) {
            // Not as a float: rays are counted beyond its 24 bits.
            const auto value = readParam(decl, text.value, c_->catalog, whose);
            if (const ParamProblem* problem = std::get_if<ParamProblem>(&value)) {
                report(*problem, text.place);
                return 1; // bounded: one report is enough
            }
            return std::get<double>(text.value);
        }
        PlannedParam* param = findParam(text);
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

    void reportUnknown(const ParamText& text, const std::vector<ParamDecl>& decls,
                       const std::string& what) {
        std::vector<std::string> names;
        for (const ParamDecl& decl : decls)
            names.push_back(decl.name);
        c_->reporter.error(
            "E0501", text.name.place, what + " has no parameter \"" + text.name.text + "\"",
            names.empty() ? "it has none" : suggest(text.name.text, names, "it has"));
    }

    void markRead(const ParamText& text) {
        if (text.isReference())
            read_.insert(std::get<std::string>(text.value).substr(1));
    }

    void markRead(const PassDesc& pass) {
        for (const ParamText& text : pass.params)
            markRead(text);
        for (const InputDesc& input : pass.inputs)
            for (const EdgeDesc& edge : input.edges)
                for (const ParamText& text : edge.params)
                    markRead(text);
    }

    void reportUnread() {
        for (const GraphParamDesc& param : c_->desc.params)
            if (!read_.contains(param.decl.name))
                c_->reporter.error("E0506", param.name.place,
                                   "nothing reads parameter \"" + param.decl.name + "\"",
                                   "write \"$" + param.decl.name +
                                       "\" where it should count, or remove it");
    }

    Compilation* c_;
    std::set<std::string> read_;
};

} // namespace

void bindParams(Compilation& c, const Overrides& overrides) {
    ParamBinder(c).bind(overrides);
}

} // namespace hone

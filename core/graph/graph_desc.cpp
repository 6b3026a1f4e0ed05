// SPDX-License-Identifier: Apache-2.0
#include "hone/core/graph/graph_desc.h"

#include "hone/core/graph/json_source.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

namespace hone {
namespace {

constexpr int kVersion = 1;
constexpr std::size_t kMaxPasses = 4096;
constexpr std::size_t kMaxEdges = 16384;

using Kind = JsonValue::Kind;

/// A value together with its JSON pointer.
struct Node {
    const JsonValue* value = nullptr;
    std::string pointer;

    Place place() const { return {value->span, pointer, true}; }
    Node child(const JsonMember& member) const {
        return {&member.value, pointerTo(pointer, member.key)};
    }
    Node child(std::size_t index) const {
        return {&value->elements[index], pointerTo(pointer, std::to_string(index))};
    }
    Place keyPlace(const JsonMember& member) const {
        return {member.key_span, pointerTo(pointer, member.key), true};
    }
};

/// Turns the JSON tree into a GraphDesc; anything that has no meaning is reported.
class GraphReader {
public:
    GraphReader(Reporter& reporter, GraphDesc& graph) : reporter_(&reporter), graph_(&graph) {}

    void read(const Node& root) {
        if (!expect(root, Kind::kObject, "a graph") || !readVersion(root))
            return;
        graph_->is_readable = true;
        graph_->outputs_place = root.place();
        forEach(root, {"$schema", "hone", "name", "doc", "params", "inputs", "passes", "outputs"},
                "a graph", [&](const JsonMember& member) {
                    const Node node = root.child(member);
                    if (member.key == "name")
                        graph_->name = text(node, "the graph's name");
                    else if (member.key == "doc")
                        graph_->doc = text(node, "the graph's documentation");
                    else if (member.key == "$schema")
                        text(node, "the schema's name");
                    else if (member.key == "params")
                        readParams(node);
                    else if (member.key == "inputs")
                        readInputs(node);
                    else if (member.key == "passes")
                        readPasses(node, graph_->passes);
                    else if (member.key == "outputs")
                        readOutputs(node, root.keyPlace(member));
                });
    }

private:
    bool expect(const Node& node, Kind kind, const std::string& what) {
        if (node.value->kind == kind)
            return true;
        JsonValue wanted;
        wanted.kind = kind;
        reporter_->error("E0202", node.place(),
                         what + " must be " + wanted.kindName() + ", not " +
                             node.value->kindName());
        return false;
    }

    std::string text(const Node& node, const std::string& what) {
        return expect(node, Kind::kString, what) ? node.value->text : std::string();
    }

    Word word(const Node& node, const std::string& what) {
        return {text(node, what), node.place()};
    }

    /// Calls `visit` for every member; keys that are not in `known` are errors.
    template <class Visit>
    void forEach(const Node& node, const std::vector<std::string>& known, const std::string& what,
                 const Visit& visit) {
        for (const JsonMember& member : node.value->members) {
            if (std::ranges::find(known, member.key) != known.end())
                visit(member);
            else
                reporter_->error("E0201", node.keyPlace(member),
                                 what + " has no key \"" + member.key + "\"",
                                 suggest(member.key, known, "it has"));
        }
    }

    /// A name given in the file: a word that needs no quoting in references.
    Word name(const Node& parent, const JsonMember& member, const std::string& what) {
        Word result{member.key, parent.keyPlace(member)};
        const auto is_word = [](char c) {
            return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                   c == '_' || c == '-';
        };
        if (member.key.empty() || !std::ranges::all_of(member.key, is_word))
            reporter_->error("E0205", result.place,
                             "\"" + member.key + "\" cannot be the name of " + what,
                             "use letters, digits, \"_\" and \"-\"; \".\", \"$\" and \"~\" have a "
                             "meaning in references");
        return result;
    }

    bool readVersion(const Node& root) {
        const JsonMember* member = root.value->find("hone");
        if (member == nullptr) {
            reporter_->error("E0203", root.place(), "the graph does not say its version",
                             "add \"hone\": 1");
            return false;
        }
        const Node node = root.child(*member);
        if (!expect(node, Kind::kNumber, "the version"))
            return false;
        if (node.value->number == kVersion)
            return true;
        const bool is_newer = node.value->number > kVersion;
        reporter_->error("E0204", node.place(),
                         std::string("the graph is of ") + (is_newer ? "a newer" : "an unknown") +
                             " version; this program reads version 1",
                         is_newer ? "update hone" : "write \"hone\": 1");
        return false;
    }

    void readParams(const Node& node) {
        if (!expect(node, Kind::kObject, "\"params\""))
            return;
        for (const JsonMember& member : node.value->members) {
            GraphParamDesc& param = graph_->params.emplace_back();
            param.name = name(node, member, "a parameter");
            param.decl.name = member.key;
            readParam(node.child(member), param);
        }
    }

    void readParam(const Node& node, GraphParamDesc& param) {
        param.default_place = node.place();
        if (!expect(node, Kind::kObject, "a parameter's declaration"))
            return;
        readParamType(node, param);
        ParamDecl& decl = param.decl;
        bool has_default = false;
        forEach(node, {"type", "from", "default", "min", "max", "choices", "doc"}, "a parameter",
                [&](const JsonMember& member) {
                    const Node child = node.child(member);
                    if (member.key == "doc")
                        decl.doc = text(child, "a parameter's documentation");
                    else if (member.key == "min" && expect(child, Kind::kNumber, "\"min\""))
                        decl.min = child.value->number;
                    else if (member.key == "max" && expect(child, Kind::kNumber, "\"max\""))
                        decl.max = child.value->number;
                    else if (member.key == "choices" && expect(child, Kind::kArray, "\"choices\""))
                        for (std::size_t i = 0; i < child.value->elements.size(); ++i)
                            decl.choices.push_back(text(child.child(i), "a choice"));
                    else if (member.key == "from")
                        readChoicesSource(child, decl);
                    else if (member.key == "default") {
                        has_default = true;
                        param.default_place = child.place();
                        readDefault(child, decl);
                    }
                });
        if (!has_default)
            reporter_->error("E0203", node.place(),
                             "parameter \"" + decl.name + "\" has no \"default\"",
                             "add one: a graph must run without being told anything");
        if (decl.type == ParamType::kEnum && decl.choices.empty() && !decl.from_trace_backends)
            reporter_->error("E0203", node.place(),
                             "parameter \"" + decl.name + "\" is an enum without choices",
                             "add \"choices\": [\"...\"], or \"from\": \"trace_backends\"");
    }

    void readParamType(const Node& node, GraphParamDesc& param) {
        const JsonMember* member = node.value->find("type");
        if (member == nullptr) {
            reporter_->error("E0203", node.place(),
                             "parameter \"" + param.decl.name + "\" has no \"type\"",
                             "add \"type\": \"bool\", \"uint\", \"float\" or \"enum\"");
            return;
        }
        const std::string type = text(node.child(*member), "a parameter's type");
        for (const ParamType candidate :
             {ParamType::kBool, ParamType::kUint, ParamType::kFloat, ParamType::kEnum})
            if (type == hone::name(candidate)) {
                param.decl.type = candidate;
                return;
            }
        if (member->value.kind == Kind::kString)
            reporter_->error("E0507", node.child(*member).place(),
                             "there is no parameter type \"" + type + "\"",
                             suggest(type, {"bool", "uint", "float", "enum"}, "there are"));
    }

    void readChoicesSource(const Node& node, ParamDecl& decl) {
        const std::string source = text(node, "\"from\"");
        decl.from_trace_backends = source == "trace_backends";
        if (!decl.from_trace_backends && node.value->kind == Kind::kString)
            reporter_->error("E0507", node.place(), "choices cannot come from \"" + source + "\"",
                             "write \"trace_backends\", or list them under \"choices\"");
    }

    void readDefault(const Node& node, ParamDecl& decl) {
        const double number = node.value->number;
        if (decl.type == ParamType::kBool && expect(node, Kind::kBool, "a bool's default"))
            decl.fallback = node.value->flag;
        else if (decl.type == ParamType::kEnum && expect(node, Kind::kString, "an enum's default"))
            decl.fallback = node.value->text;
        else if (decl.type == ParamType::kFloat && expect(node, Kind::kNumber, "a float's default"))
            decl.fallback = static_cast<float>(number);
        else if (decl.type == ParamType::kUint && expect(node, Kind::kNumber, "a uint's default")) {
            if (number == std::floor(number) && number >= 0 &&
                number <= std::numeric_limits<uint>::max())
                decl.fallback = static_cast<uint>(number);
            else
                reporter_->error("E0502", node.place(),
                                 "parameter \"" + decl.name +
                                     "\" is a uint: a whole number from 0 to 4294967295");
        }
    }

    void readInputs(const Node& node) {
        if (!expect(node, Kind::kObject, "\"inputs\""))
            return;
        for (const JsonMember& member : node.value->members)
            graph_->inputs.push_back(
                {name(node, member, "an input"), word(node.child(member), "an input's type")});
    }

    void readOutputs(const Node& node, const Place& key) {
        graph_->outputs_place = key;
        if (!expect(node, Kind::kObject, "\"outputs\""))
            return;
        for (const JsonMember& member : node.value->members)
            graph_->outputs.push_back(
                {name(node, member, "an output"), word(node.child(member), "an output's source")});
    }

    void readPasses(const Node& node, std::vector<PassDesc>& passes) {
        if (!expect(node, Kind::kObject, "\"passes\""))
            return;
        for (const JsonMember& member : node.value->members) {
            if (++pass_count_ > kMaxPasses) {
                if (pass_count_ == kMaxPasses + 1)
                    reporter_->error("E0104", node.keyPlace(member),
                                     "the graph has more than 4096 passes");
                return;
            }
            PassDesc& pass = passes.emplace_back();
            pass.name = name(node, member, "a pass");
            const Node child = node.child(member);
            if (!expect(child, Kind::kObject, "a pass"))
                continue;
            if (const JsonMember* loop = child.value->find("loop"))
                readLoopPass(child, *loop, pass);
            else
                readPass(child, pass);
        }
    }

    void readPass(const Node& node, PassDesc& pass) {
        forEach(node, {"type", "in", "params", "on", "doc", "loop"}, "a pass",
                [&](const JsonMember& member) {
                    const Node child = node.child(member);
                    if (member.key == "type")
                        pass.type = word(child, "a pass's type");
                    else if (member.key == "doc")
                        pass.doc = text(child, "a pass's documentation");
                    else if (member.key == "on")
                        pass.on = word(child, "\"on\"");
                    else if (member.key == "in")
                        readEdges(child, pass);
                    else if (member.key == "params")
                        readParamTexts(child, {}, "\"params\"", pass.params);
                });
        if (node.value->find("type") == nullptr)
            reporter_->error("E0203", pass.name.place,
                             "pass \"" + pass.name.text +
                                 "\" has neither a \"type\" nor a \"loop\"");
    }

    void readLoopPass(const Node& node, const JsonMember& loop_member, PassDesc& pass) {
        LoopDesc& loop = pass.loop.emplace();
        loop.place = node.keyPlace(loop_member);
        forEach(node, {"loop", "doc"}, "a loop", [&](const JsonMember& member) {
            if (member.key == "doc")
                pass.doc = text(node.child(member), "a loop's documentation");
        });
        const Node body = node.child(loop_member);
        if (!expect(body, Kind::kObject, "\"loop\""))
            return;
        forEach(body, {"carry", "passes", "next", "stop", "check_every"}, "a loop",
                [&](const JsonMember& member) {
                    const Node child = body.child(member);
                    if (member.key == "carry")
                        readCarry(child, loop);
                    else if (member.key == "passes")
                        readPasses(child, loop.passes);
                    else if (member.key == "next")
                        readNext(child, loop);
                    else if (member.key == "stop")
                        readStop(child, loop);
                    else if (member.key == "check_every")
                        readCheckEvery(child, loop);
                });
    }

    void readCarry(const Node& node, LoopDesc& loop) {
        if (!expect(node, Kind::kObject, "\"carry\""))
            return;
        for (const JsonMember& member : node.value->members) {
            const Word carried = name(node, member, "a carried value");
            if (carried.text == "stats")
                reporter_->error(
                    "E0205", carried.place, "a carried value cannot be called \"stats\"",
                    "every loop has an output of that name: what it did, by iteration");
            loop.carry.push_back({carried, readEdge(node.child(member), true)});
        }
    }

    void readNext(const Node& node, LoopDesc& loop) {
        if (!expect(node, Kind::kObject, "\"next\""))
            return;
        for (const JsonMember& member : node.value->members)
            loop.next.push_back({{member.key, node.keyPlace(member)},
                                 word(node.child(member), "the next value's source")});
    }

    void readStop(const Node& node, LoopDesc& loop) {
        if (!expect(node, Kind::kArray, "\"stop\""))
            return;
        for (std::size_t i = 0; i < node.value->elements.size(); ++i) {
            const Node rule = node.child(i);
            std::vector<ParamText> texts;
            if (expect(rule, Kind::kObject, "a stop rule"))
                readParamTexts(rule, {"empty", "rays", "ms", "iterations"}, "a stop rule", texts);
            for (ParamText& text : texts)
                loop.stop.push_back({std::move(text)});
        }
    }

    void readCheckEvery(const Node& node, LoopDesc& loop) {
        if (!expect(node, Kind::kNumber, "\"check_every\""))
            return;
        const double number = node.value->number;
        if (number >= 1 && number <= 1e6 && number == std::floor(number))
            loop.check_every = static_cast<std::uint32_t>(number);
        else
            reporter_->error("E0503", node.place(),
                             "\"check_every\" is a whole number from 1 to 1000000");
    }

    void readEdges(const Node& node, PassDesc& pass) {
        if (!expect(node, Kind::kObject, "\"in\""))
            return;
        for (const JsonMember& member : node.value->members) {
            InputDesc& input = pass.inputs.emplace_back();
            input.port = {member.key, node.keyPlace(member)};
            const Node child = node.child(member);
            input.is_list = child.value->kind == Kind::kArray;
            if (!input.is_list)
                input.edges.push_back(readEdge(child, false));
            for (std::size_t i = 0; i < child.value->elements.size(); ++i)
                input.edges.push_back(readEdge(child.child(i), false));
        }
    }

    EdgeDesc readEdge(const Node& node, bool may_be_zero) {
        EdgeDesc edge;
        edge.from.place = node.place();
        if (++edge_count_ == kMaxEdges + 1)
            reporter_->error("E0104", node.place(), "the graph has more than 16384 edges");
        if (edge_count_ > kMaxEdges)
            return edge;
        if (node.value->kind == Kind::kString) {
            edge.from.text = node.value->text;
            return edge;
        }
        if (node.value->kind != Kind::kObject) {
            reporter_->error("E0202", node.place(),
                             std::string("an edge must be a string or an object, not ") +
                                 node.value->kindName(),
                             "write \"pass.port\" or {\"from\": \"pass.port\", ...}");
            return edge;
        }
        for (const JsonMember& member : node.value->members) {
            if (member.key == "from") {
                edge.from = word(node.child(member), "an edge's source");
            } else if (may_be_zero && member.key == "zero") {
                edge.is_zero = true;
                edge.from = word(node.child(member), "a zeroed value's type");
            } else if (may_be_zero) {
                reporter_->error("E0201", node.keyPlace(member),
                                 "a carried value has no key \"" + member.key + "\"",
                                 suggest(member.key, {"from", "zero"}, "it has"));
            } else {
                addParamText(node, member, edge.params);
            }
        }
        if (node.value->find("from") == nullptr && !edge.is_zero)
            reporter_->error("E0203", node.place(), "this edge does not say where it comes from",
                             may_be_zero ? "add \"from\": \"pass.port\" or \"zero\": \"Type\""
                                         : "add \"from\": \"pass.port\"");
        return edge;
    }

    /// Literals and references by name; `known` empty: any name (the pass type decides later).
    void readParamTexts(const Node& node, const std::vector<std::string>& known,
                        const std::string& what, std::vector<ParamText>& texts) {
        if (!expect(node, Kind::kObject, what))
            return;
        for (const JsonMember& member : node.value->members) {
            if (known.empty() || std::ranges::find(known, member.key) != known.end())
                addParamText(node, member, texts);
            else
                reporter_->error("E0201", node.keyPlace(member),
                                 what + " has no key \"" + member.key + "\"",
                                 suggest(member.key, known, "it has"));
        }
    }

    void addParamText(const Node& node, const JsonMember& member, std::vector<ParamText>& texts) {
        const Node child = node.child(member);
        ParamText result{{member.key, node.keyPlace(member)}, false, child.place()};
        if (child.value->kind == Kind::kBool)
            result.value = child.value->flag;
        else if (child.value->kind == Kind::kNumber)
            result.value = child.value->number;
        else if (child.value->kind == Kind::kString)
            result.value = child.value->text;
        else {
            reporter_->error("E0202", child.place(),
                             "\"" + member.key +
                                 "\" must be a boolean, a number or a string, not " +
                                 child.value->kindName());
            return;
        }
        texts.push_back(std::move(result));
    }

    Reporter* reporter_;
    GraphDesc* graph_;
    std::size_t pass_count_ = 0;
    std::size_t edge_count_ = 0;
};

} // namespace

GraphDesc parseGraph(std::string file, std::string text, std::vector<Diagnostic>& diagnostics) {
    GraphDesc graph;
    graph.source = SourceText(std::move(file), std::move(text));
    Reporter reporter(graph.source, diagnostics);
    JsonValue root;
    if (parseJson(graph.source, reporter, root))
        GraphReader(reporter, graph).read({&root, ""});
    return graph;
}

GraphDesc parseGraphFile(const std::string& path, std::vector<Diagnostic>& diagnostics) {
    std::ifstream file(path, std::ios::binary);
    std::string text;
    // A little past the limit is enough to know that it was passed; devices and pipes never end.
    constexpr std::size_t kEnough = (std::size_t{16} << 20) + 1;
    char chunk[std::size_t{1} << 14];
    while (file && text.size() < kEnough) {
        file.read(chunk, sizeof chunk);
        text.append(chunk, static_cast<std::size_t>(file.gcount()));
    }
    GraphDesc graph;
    if (file.is_open() && !file.bad()) {
        graph = parseGraph(path, std::move(text), diagnostics);
        if (graph.name.empty())
            graph.name = std::filesystem::path(path).stem().string();
        return graph;
    }
    graph.source = SourceText(path, "");
    Reporter(graph.source, diagnostics)
        .error("E0106", {}, "the graph file cannot be read", "does it exist, and may you read it?");
    return graph;
}

} // namespace hone

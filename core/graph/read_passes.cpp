// SPDX-License-Identifier: Apache-2.0
//
// Passes, loops, graphs used as passes, and the edges between them.
#include "hone/core/graph/json_reader.h"

#include <cmath>

namespace hone {
namespace {

using Kind = JsonValue::Kind;

constexpr std::size_t kMaxPasses = 4096;
constexpr std::size_t kMaxEdges = 16384;

/// Where an edge is written decides what it may say.
enum class EdgeUse : std::uint8_t {
    kInput,   ///< of a pass: parameters of the edge, history
    kCarry,   ///< what a carried value begins with: zeroes, history
    kInitial, ///< what a history begins with: zeroes
    kBypass,  ///< no more than its source
};

class PassReader {
public:
    PassReader(const JsonReader& reader, ReadCounts& counts) : reader_(&reader), counts_(&counts) {}

    void readPasses(const JsonNode& node, std::vector<PassDesc>& passes) {
        if (!reader_->expect(node, Kind::kObject, "\"passes\""))
            return;
        for (const JsonMember& member : node.value->members) {
            if (++counts_->passes > kMaxPasses) {
                if (counts_->passes == kMaxPasses + 1)
                    error("E0104", node.keyPlace(member), "the graph has more than 4096 passes");
                return;
            }
            PassDesc& pass = passes.emplace_back();
            pass.name = reader_->name(node, member, "a pass");
            const JsonNode child = node.child(member);
            if (!reader_->expect(child, Kind::kObject, "a pass"))
                continue;
            if (child.value->find("loop") != nullptr)
                readLoopPass(child, pass);
            else if (child.value->find("graph") != nullptr)
                readGraphPass(child, pass);
            else
                readPass(child, pass);
        }
    }

private:
    void error(const char* code, const Place& place, std::string message, std::string hint = {}) {
        reader_->reporter().error(code, place, std::move(message), std::move(hint));
    }

    void readPass(const JsonNode& node, PassDesc& pass) {
        reader_->forEach(
            node,
            {"type", "in", "params", "on", "doc", "shader", "when", "bypass", "loop", "graph"},
            "a pass", [&](const JsonMember& member) {
                const JsonNode child = node.child(member);
                if (member.key == "type")
                    pass.type = reader_->word(child, "a pass's type");
                else if (member.key == "on")
                    pass.on = reader_->word(child, "\"on\"");
                else if (member.key == "shader")
                    pass.shader = reader_->word(child, "\"shader\"");
                else if (member.key == "in")
                    readInputs(child, pass);
                else if (member.key == "params")
                    readParamTexts(child, pass.params);
                else
                    readCommon(child, member.key, pass);
            });
        if (node.value->find("type") == nullptr)
            error("E0203", pass.name.place,
                  "pass \"" + pass.name.text +
                      "\" has neither a \"type\" nor a \"loop\" nor a \"graph\"");
        if (pass.type.text == "glsl" && node.value->find("shader") == nullptr)
            error("E0203", pass.name.place,
                  "pass \"" + pass.name.text + "\" does not say its \"shader\"",
                  "add \"shader\": \"file.comp\", beside the graph");
        if (!pass.type.text.empty() && pass.type.text != "glsl" && !pass.shader.text.empty())
            error("E0201", node.keyPlace(*node.value->find("shader")),
                  "a pass of type \"" + pass.type.text + "\" has no key \"shader\"",
                  "passes of type \"glsl\" have one");
    }

    void readGraphPass(const JsonNode& node, PassDesc& pass) {
        reader_->forEach(node, {"graph", "in", "params", "doc", "when", "bypass"},
                         "a pass that is a graph", [&](const JsonMember& member) {
                             const JsonNode child = node.child(member);
                             if (member.key == "graph")
                                 pass.graph = reader_->word(child, "\"graph\"");
                             else if (member.key == "in")
                                 readInputs(child, pass);
                             else if (member.key == "params")
                                 readParamTexts(child, pass.params);
                             else
                                 readCommon(child, member.key, pass);
                         });
    }

    void readLoopPass(const JsonNode& node, PassDesc& pass) {
        LoopDesc& loop = pass.loop.emplace();
        reader_->forEach(node, {"loop", "doc", "when", "bypass"}, "a loop",
                         [&](const JsonMember& member) {
                             if (member.key != "loop")
                                 return readCommon(node.child(member), member.key, pass);
                             loop.place = node.keyPlace(member);
                             readLoop(node.child(member), loop);
                         });
    }

    void readCommon(const JsonNode& node, const std::string& key, PassDesc& pass) {
        if (key == "doc")
            pass.doc = reader_->text(node, "a pass's documentation");
        else if (key == "when")
            readWhen(node, pass);
        else if (key == "bypass" && reader_->expect(node, Kind::kObject, "\"bypass\""))
            for (const JsonMember& member : node.value->members)
                pass.bypass.push_back({{member.key, node.keyPlace(member)},
                                       readEdge(node.child(member), EdgeUse::kBypass)});
    }

    void readWhen(const JsonNode& node, PassDesc& pass) {
        WhenDesc when;
        when.param.place = node.place();
        if (node.value->kind == Kind::kString) {
            std::string_view text = node.value->text;
            when.is_negated = text.starts_with('!');
            text.remove_prefix(when.is_negated ? 1 : 0);
            when.param.text = text;
        } else if (node.value->kind == Kind::kObject && node.value->members.size() == 1) {
            const JsonMember& member = node.value->members.front();
            when.param = {member.key, node.keyPlace(member)};
            const JsonNode choices = node.child(member);
            if (choices.value->kind != Kind::kArray)
                when.choices.push_back(reader_->word(choices, "a choice"));
            for (std::size_t i = 0; i < choices.value->elements.size(); ++i)
                when.choices.push_back(reader_->word(choices.child(i), "a choice"));
        }
        if (when.param.text.starts_with('$'))
            pass.when = std::move(when);
        else
            error("E0202", node.place(), "\"when\" must name a parameter of the graph",
                  "write \"$flag\", \"!$flag\" or {\"$mode\": [\"choice\", ...]}");
    }

    void readLoop(const JsonNode& node, LoopDesc& loop) {
        if (!reader_->expect(node, Kind::kObject, "\"loop\""))
            return;
        reader_->forEach(node, {"carry", "passes", "next", "stop", "check_every"}, "a loop",
                         [&](const JsonMember& member) {
                             const JsonNode child = node.child(member);
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

    void readCarry(const JsonNode& node, LoopDesc& loop) {
        if (!reader_->expect(node, Kind::kObject, "\"carry\""))
            return;
        for (const JsonMember& member : node.value->members) {
            const Word carried = reader_->name(node, member, "a carried value");
            if (carried.text == "stats")
                error("E0205", carried.place, "a carried value cannot be called \"stats\"",
                      "every loop has an output of that name: what it did, by iteration");
            loop.carry.push_back({carried, readEdge(node.child(member), EdgeUse::kCarry)});
        }
    }

    void readNext(const JsonNode& node, LoopDesc& loop) {
        if (!reader_->expect(node, Kind::kObject, "\"next\""))
            return;
        for (const JsonMember& member : node.value->members)
            loop.next.push_back({{member.key, node.keyPlace(member)},
                                 reader_->word(node.child(member), "the next value's source")});
    }

    void readStop(const JsonNode& node, LoopDesc& loop) {
        if (!reader_->expect(node, Kind::kArray, "\"stop\""))
            return;
        for (std::size_t i = 0; i < node.value->elements.size(); ++i)
            if (const JsonNode rule = node.child(i);
                reader_->expect(rule, Kind::kObject, "a stop rule"))
                readStopRule(rule, loop);
    }

    void readStopRule(const JsonNode& node, LoopDesc& loop) {
        const bool is_below = node.value->find("below") != nullptr;
        std::vector<ParamText> texts;
        Word of;
        const std::vector<std::string> known =
            is_below ? std::vector<std::string>{"below", "of"}
                     : std::vector<std::string>{"empty", "below", "rays", "ms", "iterations"};
        reader_->forEach(node, known, "a stop rule", [&](const JsonMember& member) {
            if (member.key == "of")
                of = reader_->word(node.child(member), "\"of\"");
            else
                addParamText(node, member, texts);
        });
        if (is_below && node.value->find("of") == nullptr)
            error("E0203", node.place(), "this rule does not say what must be below its limit",
                  "add \"of\": \"pass.port\", an output of type Scalar");
        for (ParamText& text : texts)
            loop.stop.push_back({std::move(text), of});
    }

    void readCheckEvery(const JsonNode& node, LoopDesc& loop) {
        if (!reader_->expect(node, Kind::kNumber, "\"check_every\""))
            return;
        const double number = node.value->number;
        if (number >= 1 && number <= 1e6 && number == std::floor(number))
            loop.check_every = static_cast<std::uint32_t>(number);
        else
            error("E0503", node.place(), "\"check_every\" is a whole number from 1 to 1000000");
    }

    void readInputs(const JsonNode& node, PassDesc& pass) {
        if (!reader_->expect(node, Kind::kObject, "\"in\""))
            return;
        for (const JsonMember& member : node.value->members) {
            InputDesc& input = pass.inputs.emplace_back();
            input.port = {member.key, node.keyPlace(member)};
            const JsonNode child = node.child(member);
            input.is_list = child.value->kind == Kind::kArray;
            if (!input.is_list)
                input.edges.push_back(readEdge(child, EdgeUse::kInput));
            for (std::size_t i = 0; i < child.value->elements.size(); ++i)
                input.edges.push_back(readEdge(child.child(i), EdgeUse::kInput));
        }
    }

    EdgeDesc readEdge(const JsonNode& node, EdgeUse use) {
        EdgeDesc edge;
        edge.from.place = node.place();
        if (++counts_->edges == kMaxEdges + 1)
            error("E0104", node.place(), "the graph has more than 16384 edges");
        if (counts_->edges > kMaxEdges)
            return edge;
        if (node.value->kind == Kind::kString) {
            edge.from = reader_->word(node, "an edge's source");
        } else if (node.value->kind == Kind::kObject) {
            readEdgeObject(node, use, edge);
        } else {
            error("E0202", node.place(),
                  std::string("an edge must be a string or an object, not ") +
                      node.value->kindName(),
                  "write \"pass.port\" or {\"from\": \"pass.port\", ...}");
            return edge;
        }
        readHistory(use, edge);
        return edge;
    }

    void readEdgeObject(const JsonNode& node, EdgeUse use, EdgeDesc& edge) {
        const bool may_be_zero = use == EdgeUse::kCarry || use == EdgeUse::kInitial;
        const bool may_be_history = use == EdgeUse::kInput || use == EdgeUse::kCarry;
        const bool has_source = node.value->find("from") != nullptr ||
                                (may_be_zero && node.value->find("zero") != nullptr);
        // Keys that are not known are the edge's parameters: a misspelt "from" would be one.
        const JsonMember* from = has_source || use != EdgeUse::kInput
                                     ? nullptr
                                     : reader_->misspelt(node, "from", {"from"}, "this edge");
        for (const JsonMember& member : node.value->members) {
            if (member.key == "from" || &member == from) {
                edge.from = reader_->word(node.child(member), "an edge's source");
            } else if (may_be_zero && member.key == "zero") {
                edge.is_zero = true;
                edge.from = reader_->word(node.child(member), "a zeroed value's type");
            } else if (may_be_history && member.key == "initial") {
                edge.initial =
                    std::make_unique<EdgeDesc>(readEdge(node.child(member), EdgeUse::kInitial));
            } else if (use == EdgeUse::kInput) {
                addParamText(node, member, edge.params);
            } else {
                reader_->unknownKey(node, member,
                                    use == EdgeUse::kCarry
                                        ? std::vector<std::string>{"from", "zero", "initial"}
                                    : may_be_zero ? std::vector<std::string>{"from", "zero"}
                                                  : std::vector<std::string>{"from"},
                                    use == EdgeUse::kCarry ? "a carried value" : "this edge");
            }
        }
        if (const JsonMember* zero = node.value->find("zero");
            may_be_zero && zero != nullptr && node.value->find("from") != nullptr)
            error("E0201", node.keyPlace(*zero), "\"zero\" and \"from\" exclude each other",
                  "remove one of them");
        if (!has_source && from == nullptr)
            error("E0203", node.place(), "this edge does not say where it comes from",
                  may_be_zero ? "add \"from\": \"pass.port\" or \"zero\": \"Type\""
                              : "add \"from\": \"pass.port\"");
    }

    /// Takes "@-1" off the source.
    void readHistory(EdgeUse use, EdgeDesc& edge) {
        const std::size_t at = edge.is_zero ? std::string::npos : edge.from.text.find('@');
        if (at == std::string::npos) {
            if (edge.initial != nullptr)
                error("E0611", edge.from.place, "\"initial\" belongs to a value of the last frame",
                      "write \"from\": \"" + edge.from.text + "@-1\", or remove \"initial\"");
            return;
        }
        const std::string written = edge.from.text;
        edge.from.text.resize(at);
        edge.is_history = true;
        if (written.substr(at) != "@-1")
            error("E0610", edge.from.place,
                  "\"" + written.substr(at) + "\" is no frame that is kept",
                  "\"" + edge.from.text +
                      "@-1\" is the value of the last frame; older ones can be "
                      "handed on by a pass");
        else if (use != EdgeUse::kInput && use != EdgeUse::kCarry)
            error("E0610", edge.from.place, "the last frame's value cannot be used here",
                  "inputs of passes and carried values may begin with it");
        else if (edge.initial == nullptr)
            error("E0611", edge.from.place,
                  "\"" + written + "\" does not say what it is in the first frame",
                  "write { \"from\": \"" + written +
                      "\", \"initial\": \"pass.port\" }, or \"initial\": { \"zero\": \"Type\" }");
    }

    /// Literals and references by name; the pass's type decides later what there is.
    void readParamTexts(const JsonNode& node, std::vector<ParamText>& texts) {
        if (!reader_->expect(node, Kind::kObject, "\"params\""))
            return;
        for (const JsonMember& member : node.value->members)
            addParamText(node, member, texts);
    }

    void addParamText(const JsonNode& node, const JsonMember& member,
                      std::vector<ParamText>& texts) {
        const JsonNode child = node.child(member);
        ParamText result{{member.key, node.keyPlace(member)}, false, child.place()};
        if (child.value->kind == Kind::kBool)
            result.value = child.value->flag;
        else if (child.value->kind == Kind::kNumber)
            result.value = child.value->number;
        else if (child.value->kind == Kind::kString)
            result.value = child.value->text;
        else
            return error("E0202", child.place(),
                         "\"" + member.key + "\" must be a boolean, a number or a string, not " +
                             child.value->kindName());
        texts.push_back(std::move(result));
    }

    const JsonReader* reader_;
    ReadCounts* counts_;
};

} // namespace

void readPasses(const JsonReader& reader, ReadCounts& counts, const JsonNode& node,
                std::vector<PassDesc>& passes) {
    PassReader(reader, counts).readPasses(node, passes);
}

} // namespace hone

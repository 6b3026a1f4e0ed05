// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/draw_dot.h"

#include "hone/core/graph/plan_sizes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace hone::cli {
namespace {

constexpr const char* kInk = "#1f2933";
constexpr const char* kLabel = "#3e4c59";
constexpr const char* kFaint = "#7b8794";
constexpr const char* kCulled = "#b8c0c8";

/// Text inside an HTML-like label or a tooltip: no byte of it is markup.
std::string escape(std::string_view text) {
    std::string result;
    for (const char c : text) {
        if (c == '&')
            result += "&amp;";
        else if (c == '<')
            result += "&lt;";
        else if (c == '>')
            result += "&gt;";
        else if (c == '"')
            result += "&quot;";
        else if (c == '\\')
            result += "&#92;";
        else
            // Other bytes than printable ASCII might be broken UTF-8, which dot refuses.
            result += c >= ' ' && c <= '~' ? c : '?';
    }
    return result;
}

std::string small(const std::string& escaped, const char* color = kFaint) {
    return std::string("<FONT POINT-SIZE=\"8\" COLOR=\"") + color + "\">" + escaped + "</FONT>";
}

std::string bold(std::string_view text) {
    return "<B>" + escape(text) + "</B>";
}

/// Values that mean alike look alike.
const char* colorOf(const PortType& type) {
    if (type == types::kRadiance || type == types::kDisplay || type == types::kAccumulation)
        return "#2f6fb5";
    if (type == types::kError || type == types::kTolerance)
        return "#c0453b";
    switch (type.shape) {
    case Shape::kPlane:
        return "#3c8f5a";
    case Shape::kList:
        return "#7d4fb0";
    case Shape::kRecord:
        return "#a06a1c";
    default:
        return "#52606d";
    }
}

std::string number(double value, const char* format) {
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

class Drawing {
public:
    Drawing(const CompiledGraph& graph, const DrawOptions& options)
        : graph_(&graph), options_(&options),
          sizes_(planSizes(graph, options.size, options.scene)) {
        for (const NodeReport& report : options.times)
            if (report.type != "loop")
                slowest_ms_ = std::max(slowest_ms_, report.ms);
    }

    std::string text() {
        text_ = "digraph hone {\n"
                "graph [rankdir=TB, fontname=\"Helvetica\", fontsize=11, nodesep=0.3, ranksep=0.45,"
                " pad=0.3, bgcolor=\"white\", labelloc=t, labeljust=l, label=<" +
                title() +
                ">]\n"
                "node [shape=plain, fontname=\"Helvetica\", fontsize=10, fontcolor=\"" +
                kInk +
                "\"]\n"
                "edge [fontname=\"Helvetica\", fontsize=8, arrowsize=0.6, penwidth=1.2]\n";
        writeScope(kNoId, kNoId);
        writeOutputs();
        for (NodeId id = 0; id < graph_->nodes.size(); ++id)
            writeEdges(id);
        return text_ + "}\n";
    }

private:
    std::string title() const {
        std::string line = bold(graph_->name.empty() ? "graph" : graph_->name);
        std::string inputs;
        for (const NamedValue& input : graph_->inputs)
            if (graph_->values[input.value].is_needed)
                inputs += (inputs.empty() ? "" : ", ") + escape("$" + input.name);
        std::string facts = std::to_string(options_->size.x) + "x" +
                            std::to_string(options_->size.y) + ": " + byteText(sizes_.bytes) +
                            " in " + std::to_string(graph_->memories.size()) + " memories" +
                            (sizes_.unknown > 0 ? " and what the scene decides" : "") + ", " +
                            byteText(sizes_.saved) + " saved by sharing";
        if (!inputs.empty())
            facts += "; reads " + inputs;
        double ms = 0;
        for (const NodeReport& report : options_->times)
            if (const PlannedNode* node = graph_->findNode(report.name);
                node != nullptr && node->parent == kNoId)
                ms += report.ms;
        if (!options_->times.empty())
            facts += "; " + number(ms, "%.1f") + " ms";
        return line + "<BR ALIGN=\"LEFT\"/>" + small(facts) + "<BR ALIGN=\"LEFT\"/>";
    }

    // ---- nodes

    /// What is in a loop and in a graph that is used as a pass, and in none within them.
    void writeScope(NodeId loop, std::uint32_t graph) {
        for (NodeId id = 0; id < graph_->nodes.size(); ++id) {
            const PlannedNode& node = graph_->nodes[id];
            if (node.parent != loop || node.graph != graph)
                continue;
            if (node.loop == kNoId)
                writePass(id);
            else
                writeLoop(id);
        }
        for (std::uint32_t used = 0; used < graph_->graphs.size(); ++used)
            if (graph_->graphs[used].parent == loop && graph_->graphs[used].graph == graph)
                writeGraph(used);
    }

    void writeGraph(std::uint32_t used) {
        const PlannedGraph& graph = graph_->graphs[used];
        text_ += "subgraph cluster_graph_" + std::to_string(used) +
                 " {\ngraph [style=\"rounded,dashed\", color=\"#9fb3c8\", labeljust=l, margin=12, "
                 "tooltip=\"" +
                 escape(graph.name) + "\", label=<" + bold(lastOf(graph.name)) + " " +
                 small(escape(graph.file)) + ">]\n";
        writeScope(graph.parent, used);
        text_ += "}\n";
    }

    static std::string nameOf(NodeId id) { return "n" + std::to_string(id); }

    static std::string cell(const std::string& port, const std::string& text) {
        return "<TD PORT=\"" + port + "\">" + text + "</TD>";
    }

    static std::string row(const std::string& cells) {
        return cells.empty() ? ""
                             : "<TR><TD CELLPADDING=\"0\"><TABLE BORDER=\"0\" CELLBORDER=\"0\" "
                               "CELLSPACING=\"6\" CELLPADDING=\"1\"><TR>" +
                                   cells + "</TR></TABLE></TD></TR>";
    }

    void writeNode(const std::string& id, const std::string& rows, const std::string& color,
                   const std::string& fill, bool is_dashed, const std::string& tooltip) {
        text_ += id + " [tooltip=\"" + escape(tooltip) +
                 "\", label=<<TABLE BORDER=\"1\" CELLBORDER=\"0\" CELLSPACING=\"0\" "
                 "CELLPADDING=\"3\" STYLE=\"" +
                 (is_dashed ? "ROUNDED,DASHED" : "ROUNDED") + "\" COLOR=\"" + color +
                 "\" BGCOLOR=\"" + fill + "\">" + rows + "</TABLE>>]\n";
    }

    /// "Radiance, 5.8 MB"
    std::string typeAndSize(ValueId id) const {
        const PlannedValue& value = graph_->values[id];
        std::string text = escape(value.type.name);
        if (value.is_needed && sizes_.values[id])
            text += ", " + byteText(*sizes_.values[id]);
        return text;
    }

    void writePass(NodeId id) {
        const PlannedNode& node = graph_->nodes[id];
        const bool is_culled = !node.culled.empty();
        std::string inputs;
        for (std::size_t port = 0; port < node.type->inputs.size(); ++port) {
            const auto edge = std::ranges::find_if(
                node.inputs, [&](const PlannedEdge& e) { return e.port == port; });
            if (edge == node.inputs.end())
                continue;
            const PlannedValue& value = graph_->values[edge->value];
            const std::string& name = node.type->inputs[port].name;
            // Inputs of the graph go nearly everywhere: their name is clearer than their edges.
            const std::string text = value.writer != kNoId      ? name
                                     : value.name == "$" + name ? value.name
                                                                : name + " = " + value.name;
            inputs +=
                cell("i" + std::to_string(port), small(escape(text), is_culled ? kCulled : kLabel));
        }
        std::string outputs;
        for (std::size_t port = 0; port < node.outputs.size(); ++port) {
            const PlannedOutput& output = node.outputs[port];
            const char* const color =
                is_culled ? kCulled : colorOf(graph_->values[output.value].type);
            std::string text = "<FONT POINT-SIZE=\"9\" COLOR=\"" + std::string(color) + "\">" +
                               escape(node.type->outputs[port].name) + "</FONT><BR/>" +
                               small(typeAndSize(output.value), is_culled ? kCulled : kFaint);
            if (!is_culled && output.in_place != InPlace::kNo)
                text +=
                    "<BR/>" +
                    small(output.in_place == InPlace::kTakesOver ? "in place" : "updates a copy",
                          output.in_place == InPlace::kTakesOver ? kFaint : "#c0453b");
            outputs += cell("o" + std::to_string(port), text);
        }
        std::string head = "<FONT COLOR=\"" + std::string(is_culled ? kFaint : kInk) + "\">" +
                           bold(lastOf(node.name)) + "</FONT> " + small(escape(node.type->name));
        if (is_culled)
            head += "<BR/>" + small("not run: " + escape(node.culled));
        if (node.on != Placement::kAuto)
            head += "<BR/>" + small(node.on == Placement::kHost ? "on the host" : "on the device");
        if (const NodeReport* report = reportOf(node))
            head += "<BR/>" + small(timesOf(*report), kInk);
        writeNode(nameOf(id),
                  row(inputs) + "<TR><TD CELLPADDING=\"5\">" + head + "</TD></TR>" + row(outputs),
                  is_culled ? kCulled : "#52606d", is_culled ? "white" : fillOf(node), is_culled,
                  node.name + ": " + node.type->doc);
    }

    /// What it carries on top, its passes, and what it carries on below: no edge goes back.
    void writeLoop(NodeId id) {
        const PlannedNode& node = graph_->nodes[id];
        const PlannedLoop& loop = graph_->loops[node.loop];
        const bool is_culled = !node.culled.empty();
        std::string label = bold(lastOf(node.name)) + " " +
                            small("loop" + (is_culled ? ", not run: " + escape(node.culled) : ""));
        if (const NodeReport* report = reportOf(node))
            label += " " + small(timesOf(*report), kInk);
        text_ += "subgraph cluster_" + std::to_string(id) +
                 " {\ngraph [style=\"rounded,filled\", fillcolor=\"" +
                 (is_culled              ? "#fafafa"
                  : depthOf(id) % 2 == 0 ? "#eef4fa"
                                         : "#e3ecf5") +
                 "\", color=\"" + (is_culled ? kCulled : "#9fb3c8") +
                 "\", labeljust=l, margin=12, tooltip=\"" + escape(node.name) + "\", label=<" +
                 label + ">]\n";
        std::string carries;
        std::string nexts;
        std::string results;
        for (std::size_t i = 0; i < loop.carries.size(); ++i) {
            const PlannedCarry& carry = loop.carries[i];
            const bool is_off = is_culled || carry.is_culled;
            const char* const color = is_off ? kCulled : colorOf(graph_->values[carry.value].type);
            const std::string name = "<FONT POINT-SIZE=\"9\" COLOR=\"" + std::string(color) +
                                     "\">" + escape(carry.name) + "</FONT>";
            carries += cell("c" + std::to_string(i),
                            name + "<BR/>" +
                                small(is_off ? "not carried"
                                      : carry.initial == kNoId
                                          ? typeAndSize(carry.value) + "<BR/>zeroes at first"
                                          : typeAndSize(carry.value)));
            nexts += cell("c" + std::to_string(i),
                          name + (is_off || (carry.next_by != NextBy::kCopy &&
                                             carry.next_by != NextBy::kStagedCopy)
                                      ? ""
                                      : "<BR/>" + small("copied", "#c0453b")));
            if (isReadOutside(carry.value, id))
                results += cell("r" + std::to_string(i), name);
        }
        if (graph_->values[loop.stats].is_needed)
            results += cell("stats", small("stats", colorOf(types::kCurve)));
        if (!carries.empty())
            writeNode(nameOf(id) + "_begin",
                      "<TR><TD>" + small("each iteration begins with") + "</TD></TR>" +
                          row(carries),
                      "#9fb3c8", "white", is_culled, node.name);
        writeScope(id, node.graph);
        writeNode(nameOf(id) + "_end",
                  row(nexts) + "<TR><TD PORT=\"stop\">" +
                      small("again, until " + escape(stopText(*graph_, loop))) + "</TD></TR>" +
                      row(results),
                  "#9fb3c8", "white", is_culled, node.name);
        text_ += "}\n";
    }

    void writeOutputs() {
        for (std::size_t i = 0; i < graph_->outputs.size(); ++i) {
            const NamedValue& output = graph_->outputs[i];
            const PortType& type = graph_->values[output.value].type;
            writeNode("out" + std::to_string(i),
                      "<TR><TD PORT=\"i\">" + bold(output.name) + "<BR/>" +
                          small(escape(type.name)) + "</TD></TR>",
                      colorOf(type), "#f7f9fb", false,
                      "output " + output.name + ": " + graph_->values[output.value].name);
            writeEdge(output.value, kNoId, "out" + std::to_string(i) + ":i:n", "", false);
        }
    }

    // ---- edges

    void writeEdges(NodeId id) {
        const PlannedNode& node = graph_->nodes[id];
        for (const PlannedEdge& edge : node.inputs) {
            std::string label;
            const InPort& port = node.type->inputs[edge.port];
            for (std::size_t i = 0; i < edge.params.size(); ++i)
                label += (label.empty() ? "" : ", ") + port.edge_params[i].name + " " +
                         toString(edge.params[i]);
            writeEdge(edge.value, node.parent, nameOf(id) + ":i" + std::to_string(edge.port) + ":n",
                      label, !node.culled.empty());
        }
        if (node.loop == kNoId)
            return;
        const PlannedLoop& loop = graph_->loops[node.loop];
        for (std::size_t i = 0; i < loop.carries.size(); ++i) {
            const PlannedCarry& carry = loop.carries[i];
            const bool is_off = carry.is_culled || !node.culled.empty();
            const std::string port = ":c" + std::to_string(i) + ":n";
            if (carry.initial != kNoId)
                writeEdge(carry.initial, node.parent, nameOf(id) + "_begin" + port, "", is_off);
            if (carry.next != kNoId)
                writeEdge(carry.next, id, nameOf(id) + "_end" + port, "", is_off);
        }
        for (const StopRule& rule : loop.stop)
            if (rule.value != kNoId)
                writeEdge(rule.value, id, nameOf(id) + "_end:stop:w", "", !node.culled.empty());
    }

    bool isInside(NodeId node, NodeId loop) const {
        while (node != kNoId && node != loop)
            node = graph_->nodes[node].parent;
        return node == loop;
    }

    /// Does an edge lead from a loop's carried value out of the loop?
    bool isReadOutside(ValueId value, NodeId loop) const {
        for (NodeId id = 0; id < graph_->nodes.size(); ++id) {
            const PlannedNode& node = graph_->nodes[id];
            if (!isInside(node.parent, loop) &&
                std::ranges::find(node.inputs, value, &PlannedEdge::value) != node.inputs.end())
                return true;
            if (node.loop == kNoId || id == loop)
                continue;
            for (const PlannedCarry& carry : graph_->loops[node.loop].carries)
                if ((carry.initial == value && !isInside(node.parent, loop)) ||
                    (carry.next == value && !isInside(id, loop)))
                    return true;
        }
        return std::ranges::find(graph_->outputs, value, &NamedValue::value) !=
               graph_->outputs.end();
    }

    /// Where an edge from a value begins, seen from a scope; "" for inputs of the graph.
    std::string sourceOf(ValueId value, NodeId scope) const {
        const NodeId writer = graph_->values[value].writer;
        if (writer == kNoId)
            return "";
        const PlannedNode& node = graph_->nodes[writer];
        if (node.loop == kNoId) {
            for (std::size_t port = 0; port < node.outputs.size(); ++port)
                if (node.outputs[port].value == value)
                    return nameOf(writer) + ":o" + std::to_string(port);
            return "";
        }
        const PlannedLoop& loop = graph_->loops[node.loop];
        const bool is_inside = isInside(scope, writer);
        for (std::size_t i = 0; i < loop.carries.size(); ++i)
            if (loop.carries[i].value == value)
                return nameOf(writer) + (is_inside ? "_begin:c" : "_end:r") + std::to_string(i);
        return nameOf(writer) + "_end:stats";
    }

    void writeEdge(ValueId value, NodeId scope, const std::string& target, const std::string& label,
                   bool is_culled) {
        const std::string source = sourceOf(value, scope);
        if (source.empty())
            return;
        const PortType& type = graph_->values[value].type;
        text_ += source + ":s -> " + target + " [color=\"" + (is_culled ? kCulled : colorOf(type)) +
                 "\", tooltip=\"" + escape(graph_->values[value].name + ": ") + escape(type.name) +
                 "\"" + (is_culled ? ", style=dashed" : "") +
                 (label.empty() ? ""
                                : ", fontcolor=\"" + std::string(kFaint) + "\", label=\" " +
                                      escape(label) + "\"") +
                 "]\n";
    }

    // ---- facts

    /// A name without the loops and graphs around it, whose boxes say them.
    static std::string lastOf(const std::string& name) { return name.substr(name.rfind('.') + 1); }

    std::size_t depthOf(NodeId id) const {
        std::size_t depth = 0;
        for (NodeId at = graph_->nodes[id].parent; at != kNoId; at = graph_->nodes[at].parent)
            ++depth;
        return depth;
    }

    const NodeReport* reportOf(const PlannedNode& node) const {
        const auto found = std::ranges::find(options_->times, node.name, &NodeReport::name);
        return found != options_->times.end() ? &*found : nullptr;
    }

    static std::string timesOf(const NodeReport& report) {
        return number(report.ms, "%.2f") + " ms" +
               (report.runs > 1 ? ", " + std::to_string(report.runs) + " runs" : "") +
               (*report.where != '\0' ? std::string(", ") + report.where : "");
    }

    /// White, or the warmer the more time it took.
    std::string fillOf(const PlannedNode& node) const {
        const NodeReport* report = reportOf(node);
        if (report == nullptr || slowest_ms_ <= 0)
            return "white";
        const double heat = std::sqrt(std::clamp(report->ms / slowest_ms_, 0.0, 1.0));
        char text[8];
        std::snprintf(text, sizeof text, "#ff%02x%02x", static_cast<unsigned>(255 - 55 * heat),
                      static_cast<unsigned>(255 - 135 * heat));
        return text;
    }

    const CompiledGraph* graph_;
    const DrawOptions* options_;
    PlanSizes sizes_;
    double slowest_ms_ = 0;
    std::string text_;
};

} // namespace

std::string toDot(const CompiledGraph& graph, const DrawOptions& options) {
    return Drawing(graph, options).text();
}

} // namespace hone::cli

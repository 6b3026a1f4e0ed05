// SPDX-License-Identifier: Apache-2.0
//
// Phases parse and upgrade: graph files become a GraphDesc.
#include "hone/core/graph/json_reader.h"
#include "hone/core/graph/upgrade.h"

#include <cmath>
#include <filesystem>
#include <fstream>

namespace hone {
namespace {

namespace fs = std::filesystem;
using Kind = JsonValue::Kind;

constexpr std::size_t kMaxBytes = std::size_t{16} << 20;

const std::vector<std::string> kGraphKeys{"$schema", "hone",   "name",   "doc",     "plugins",
                                          "params",  "inputs", "passes", "outputs", "meta"};

/// Reads one graph, without the files that it names.
class GraphReader {
public:
    GraphReader(Reporter& reporter, GraphDesc& graph) : reader_(reporter), graph_(&graph) {}

    void read(const JsonNode& root) {
        graph_->is_readable = true;
        graph_->outputs_place = root.place();
        reader_.forEach(root, kGraphKeys, "a graph", [&](const JsonMember& member) {
            const JsonNode node = root.child(member);
            if (member.key == "name")
                graph_->name = reader_.text(node, "the graph's name");
            else if (member.key == "doc")
                graph_->doc = reader_.text(node, "the graph's documentation");
            else if (member.key == "$schema")
                (void)reader_.text(node, "the schema's name");
            else if (member.key == "plugins")
                readPlugins(node);
            else if (member.key == "params")
                readParams(node);
            else if (member.key == "inputs")
                readInputs(node);
            else if (member.key == "passes")
                readPasses(reader_, counts_, node, graph_->passes);
            else if (member.key == "outputs")
                readOutputs(node, root.keyPlace(member));
        });
    }

private:
    void readPlugins(const JsonNode& node) {
        if (!reader_.expect(node, Kind::kObject, "\"plugins\""))
            return;
        for (const JsonMember& member : node.value->members) {
            PluginDesc& plugin = graph_->plugins.emplace_back();
            plugin.name = {member.key, node.keyPlace(member)};
            const JsonNode passes = node.child(member);
            if (reader_.expect(passes, Kind::kArray, "the pass types of a plug-in"))
                for (std::size_t i = 0; i < passes.value->elements.size(); ++i)
                    plugin.passes.push_back(reader_.word(passes.child(i), "a pass type"));
        }
    }

    void readParams(const JsonNode& node) {
        if (!reader_.expect(node, Kind::kObject, "\"params\""))
            return;
        for (const JsonMember& member : node.value->members) {
            GraphParamDesc& param = graph_->params.emplace_back();
            param.name = reader_.name(node, member, "a parameter");
            param.decl.name = member.key;
            readGraphParam(reader_, node.child(member), param);
        }
    }

    void readInputs(const JsonNode& node) {
        if (!reader_.expect(node, Kind::kObject, "\"inputs\""))
            return;
        for (const JsonMember& member : node.value->members)
            graph_->inputs.push_back({reader_.name(node, member, "an input"),
                                      reader_.word(node.child(member), "an input's type")});
    }

    void readOutputs(const JsonNode& node, const Place& key) {
        graph_->outputs_place = key;
        if (!reader_.expect(node, Kind::kObject, "\"outputs\""))
            return;
        for (const JsonMember& member : node.value->members) {
            OutputDesc& output = graph_->outputs.emplace_back();
            output.name = reader_.name(node, member, "an output");
            const JsonNode child = node.child(member);
            if (child.value->kind != Kind::kObject) {
                output.from = reader_.word(child, "an output's source");
                continue;
            }
            output.from.place = child.place();
            reader_.forEach(child, {"from", "type", "doc"}, "an output",
                            [&](const JsonMember& part) {
                                const JsonNode value = child.child(part);
                                if (part.key == "from")
                                    output.from = reader_.word(value, "an output's source");
                                else if (part.key == "type")
                                    output.type = reader_.word(value, "an output's type");
                                else
                                    output.doc = reader_.text(value, "an output's documentation");
                            });
            if (child.value->find("from") == nullptr)
                reader_.reporter().error("E0203", child.place(),
                                         "this output does not say where it comes from",
                                         "add \"from\": \"pass.port\"");
        }
    }

    JsonReader reader_;
    GraphDesc* graph_;
    ReadCounts counts_;
};

/// Reads a graph and, through `files`, all that it names.
class GraphLoader {
public:
    GraphLoader(std::vector<Diagnostic>& diagnostics, const ReadFile& files)
        : diagnostics_(&diagnostics), files_(&files) {}

    GraphDesc load(std::string file, std::string text) {
        folder_ = fs::path(file).parent_path();
        const std::string name = fs::path(file).filename().string();
        GraphDesc graph = parse(std::move(file), std::move(text));
        root_ = &graph;
        chain_.push_back(name);
        loadFiles(graph, "");
        return graph;
    }

private:
    GraphDesc parse(std::string file, std::string text) {
        GraphDesc graph;
        graph.source = std::make_unique<const SourceText>(std::move(file), std::move(text));
        Reporter reporter(*graph.source, *diagnostics_);
        JsonValue root;
        if (!parseJson(*graph.source, reporter, root))
            return graph;
        const JsonReader reader(reporter);
        const std::optional<int> version = readVersion(reader, {&root, "", graph.source.get()});
        if (!version)
            return graph;
        graph.version = *version;
        for (const UpgradeEdit& edit : upgradeTree(root, graph.version, *graph.source))
            if (edit.place.pointer != "/hone")
                reporter.warning("W0802", edit.place, edit.reason,
                                 "it is read as that; \"hone upgrade\" rewrites the file");
        GraphReader(reporter, graph).read({&root, "", graph.source.get()});
        return graph;
    }

    void loadFiles(GraphDesc& graph, const fs::path& folder) {
        Reporter reporter(*graph.source, *diagnostics_);
        loadFiles(reporter, graph.passes, folder);
    }

    void loadFiles(Reporter& reporter, std::vector<PassDesc>& passes, const fs::path& folder) {
        for (PassDesc& pass : passes) {
            if (pass.loop)
                loadFiles(reporter, pass.loop->passes, folder);
            if (!pass.shader.text.empty())
                pass.code = loadShader(reporter, pass.shader, folder);
            if (!pass.graph.text.empty())
                pass.body = loadGraph(reporter, pass.graph, folder);
        }
    }

    /// The path of a named file from the first graph's folder; nothing, with a report, where it
    /// leads elsewhere.
    std::optional<std::string> pathOf(Reporter& reporter, const Word& name,
                                      const fs::path& folder) {
        const fs::path path = (folder / name.text).lexically_normal();
        const bool is_inside = !fs::path(name.text).is_absolute() && !path.empty() &&
                               *path.begin() != ".." && path.has_filename() &&
                               name.text.find('\0') == std::string::npos &&
                               name.text.find('\\') == std::string::npos;
        if (is_inside)
            return path.generic_string();
        reporter.error("E0311", name.place,
                       "\"" + name.text + "\" is no file of the graph's folder or below it",
                       "a graph may name files beside it only: \"file.json\", \"parts/file.json\"");
        return std::nullopt;
    }

    std::optional<std::string> readText(Reporter& reporter, const Word& name,
                                        const std::string& path) {
        std::optional<std::string> text = *files_ ? (*files_)(path) : std::nullopt;
        if (!text)
            reporter.error("E0310", name.place, "the file \"" + name.text + "\" cannot be read",
                           "it is looked for at \"" + (folder_ / path).generic_string() +
                               "\": does it exist, and may you read it?");
        return text;
    }

    const SourceText* loadShader(Reporter& reporter, const Word& name, const fs::path& folder) {
        const std::optional<std::string> path = pathOf(reporter, name, folder);
        if (!path)
            return nullptr;
        const std::string shown = (folder_ / *path).generic_string();
        for (const auto& known : root_->shaders)
            if (known->file() == shown)
                return known.get();
        std::optional<std::string> text = readText(reporter, name, *path);
        if (!text)
            return nullptr;
        root_->shaders.push_back(std::make_unique<const SourceText>(shown, std::move(*text)));
        return root_->shaders.back().get();
    }

    const GraphDesc* loadGraph(Reporter& reporter, const Word& name, const fs::path& folder) {
        const std::optional<std::string> path = pathOf(reporter, name, folder);
        if (!path)
            return nullptr;
        if (std::ranges::find(chain_, *path) != chain_.end()) {
            std::string text;
            for (const std::string& file : chain_)
                text += "\"" + file + "\" -> ";
            reporter.error("E0312", name.place,
                           "graphs use each other in a circle: " + text + "\"" + *path + "\"",
                           "to repeat work, use a \"loop\"");
            return nullptr;
        }
        const std::string shown = (folder_ / *path).generic_string();
        for (const auto& known : root_->graphs)
            if (known->source->file() == shown)
                return known->is_readable ? known.get() : nullptr;
        std::optional<std::string> text = readText(reporter, name, *path);
        if (!text)
            return nullptr;
        GraphDesc& graph = *root_->graphs.emplace_back(
            std::make_unique<GraphDesc>(parse(shown, std::move(*text))));
        chain_.push_back(*path);
        loadFiles(graph, fs::path(*path).parent_path());
        chain_.pop_back();
        return graph.is_readable ? &graph : nullptr;
    }

    std::vector<Diagnostic>* diagnostics_;
    const ReadFile* files_;
    GraphDesc* root_ = nullptr;
    fs::path folder_;
    std::vector<std::string> chain_; ///< of graphs that use each other
};

/// A file's bytes, or a few more than are allowed: devices and pipes never end.
std::optional<std::string> readBytes(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::string text;
    char chunk[std::size_t{1} << 14];
    while (file && text.size() <= kMaxBytes) {
        file.read(chunk, sizeof chunk);
        text.append(chunk, static_cast<std::size_t>(file.gcount()));
    }
    if (!file.is_open() || file.bad())
        return std::nullopt;
    return text;
}

} // namespace

std::optional<int> readVersion(const JsonReader& reader, const JsonNode& root) {
    if (!reader.expect(root, Kind::kObject, "a graph"))
        return std::nullopt;
    const JsonMember* member = root.value->find("hone");
    const std::string now = std::to_string(kGraphVersion);
    if (member == nullptr) {
        if (reader.misspelt(root, "hone", kGraphKeys, "a graph") != nullptr)
            return std::nullopt;
        reader.reporter().error("E0203", root.place(), "the graph does not say its version",
                                "add \"hone\": " + now);
        return std::nullopt;
    }
    const JsonNode node = root.child(*member);
    if (!reader.expect(node, Kind::kNumber, "the version"))
        return std::nullopt;
    const double version = node.value->number;
    if (version >= 1 && version <= kGraphVersion && version == std::floor(version))
        return static_cast<int>(version);
    const bool is_newer = version > kGraphVersion;
    reader.reporter().error("E0204", node.place(),
                            std::string("the graph is of ") +
                                (is_newer ? "a newer" : "an unknown") +
                                " version; this program reads versions 1 to " + now,
                            is_newer ? "update hone" : "write \"hone\": " + now);
    return std::nullopt;
}

ReadFile filesBeside(const std::string& path) {
    // Links may lead anywhere; what counts is where they end.
    return [folder = fs::path(path).parent_path()](
               const std::string& name) -> std::optional<std::string> {
        std::error_code problem;
        const fs::path root = fs::canonical(folder.empty() ? "." : folder, problem);
        const fs::path file = problem ? fs::path() : fs::canonical(root / name, problem);
        if (problem || !fs::is_regular_file(file, problem))
            return std::nullopt;
        const fs::path inside = file.lexically_relative(root);
        if (inside.empty() || *inside.begin() == "..")
            return std::nullopt;
        std::optional<std::string> text = readBytes(file);
        return text && text->size() <= kMaxBytes ? text : std::nullopt;
    };
}

GraphDesc parseGraph(std::string file, std::string text, std::vector<Diagnostic>& diagnostics,
                     const ReadFile& files) {
    return GraphLoader(diagnostics, files).load(std::move(file), std::move(text));
}

GraphDesc parseGraphFile(const std::string& path, std::vector<Diagnostic>& diagnostics) {
    GraphDesc graph;
    if (std::optional<std::string> text = readBytes(path)) {
        graph = parseGraph(path, std::move(*text), diagnostics, filesBeside(path));
        if (graph.name.empty())
            graph.name = fs::path(path).stem().string();
        return graph;
    }
    graph.source = std::make_unique<const SourceText>(path, "");
    Reporter(*graph.source, diagnostics)
        .error("E0106", {}, "the graph file cannot be read", "does it exist, and may you read it?");
    return graph;
}

} // namespace hone

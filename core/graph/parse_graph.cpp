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

/// Reads a graph and all that it names: through `files`, or else from the folder `shipped`.
class GraphLoader {
public:
    GraphLoader(std::vector<Diagnostic>& diagnostics, const ReadFile& files,
                const std::string& shipped)
        : diagnostics_(&diagnostics) {
        roots_.push_back({"", files ? files : ReadFile([](const std::string&) {
                              return std::optional<std::string>();
                          })});
        if (!shipped.empty())
            roots_.push_back({shipped, filesBeside((fs::path(shipped) / "").string())});
    }

    GraphDesc load(std::string file, std::string text) {
        roots_.front().folder = fs::path(file).parent_path();
        chain_.push_back(file);
        GraphDesc graph = parse(std::move(file), std::move(text));
        root_ = &graph;
        loadFiles(graph, {});
        return graph;
    }

private:
    /// Files are named from the folder of the graph that names them. Those that are not there are
    /// looked for in the roots that follow; what was found in one names files of that one alone or
    /// of those that follow.
    struct Root {
        fs::path folder;
        ReadFile read;
    };
    struct Folder {
        std::size_t root = 0;
        fs::path path{}; ///< from the root
    };
    struct File {
        std::string shown; ///< its path as reports show it
        Folder folder;
        std::optional<std::string> text; ///< nothing where it was read before
    };

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

    void loadFiles(GraphDesc& graph, const Folder& folder) {
        Reporter reporter(*graph.source, *diagnostics_);
        loadFiles(reporter, graph.passes, folder);
    }

    void loadFiles(Reporter& reporter, std::vector<PassDesc>& passes, const Folder& folder) {
        for (PassDesc& pass : passes) {
            if (pass.loop)
                loadFiles(reporter, pass.loop->passes, folder);
            if (!pass.shader.text.empty())
                pass.code = loadShader(reporter, pass.shader, folder);
            if (!pass.graph.text.empty())
                pass.body = loadGraph(reporter, pass.graph, folder);
        }
    }

    /// The path of a named file from its root; nothing, with a report, where it leads elsewhere.
    static std::optional<fs::path> pathOf(Reporter& reporter, const Word& name,
                                          const fs::path& folder) {
        const fs::path path = (folder / name.text).lexically_normal();
        const bool is_inside = !fs::path(name.text).is_absolute() && !path.empty() &&
                               *path.begin() != ".." && path.has_filename() &&
                               name.text.find('\0') == std::string::npos &&
                               name.text.find('\\') == std::string::npos;
        if (is_inside)
            return path;
        reporter.error("E0311", name.place,
                       "\"" + name.text + "\" is no file of the graph's folder or below it",
                       "a graph may name files beside it only: \"file.json\", \"parts/file.json\"");
        return std::nullopt;
    }

    /// Nothing, with a report, for a file that cannot be read. `is_known` tells of files by their
    /// shown paths: each is read once, however often it is named.
    template <class IsKnown>
    std::optional<File> find(Reporter& reporter, const Word& name, const Folder& folder,
                             const IsKnown& is_known) {
        const std::optional<fs::path> path = pathOf(reporter, name, folder.path);
        if (!path)
            return std::nullopt;
        std::string places;
        for (std::size_t root = folder.root; root < roots_.size(); ++root) {
            File file{(roots_[root].folder / *path).generic_string(),
                      {root, path->parent_path()},
                      std::nullopt};
            if (is_known(file.shown))
                return file;
            file.text = roots_[root].read(path->generic_string());
            if (file.text)
                return file;
            places += (places.empty() ? "\"" : ", then at \"") + file.shown + "\"";
        }
        reporter.error("E0310", name.place, "the file \"" + name.text + "\" cannot be read",
                       "it is looked for at " + places + ": does it exist, and may you read it?");
        return std::nullopt;
    }

    const SourceText* loadShader(Reporter& reporter, const Word& name, const Folder& folder) {
        const SourceText* known = nullptr;
        std::optional<File> file = find(reporter, name, folder, [&](const std::string& shown) {
            for (const auto& shader : root_->shaders)
                if (shader->file() == shown)
                    known = shader.get();
            return known != nullptr;
        });
        if (!file || known != nullptr)
            return known;
        root_->shaders.push_back(
            std::make_unique<const SourceText>(file->shown, std::move(*file->text)));
        return root_->shaders.back().get();
    }

    const GraphDesc* loadGraph(Reporter& reporter, const Word& name, const Folder& folder) {
        const GraphDesc* known = nullptr;
        bool is_circle = false;
        std::optional<File> file = find(reporter, name, folder, [&](const std::string& shown) {
            is_circle = std::ranges::find(chain_, shown) != chain_.end();
            for (const auto& graph : root_->graphs)
                if (graph->source->file() == shown)
                    known = graph.get();
            return is_circle || known != nullptr;
        });
        if (!file)
            return nullptr;
        if (is_circle) {
            std::string text;
            for (const std::string& link : chain_)
                text += "\"" + link + "\" -> ";
            reporter.error("E0312", name.place,
                           "graphs use each other in a circle: " + text + "\"" + file->shown + "\"",
                           "to repeat work, use a \"loop\"");
            return nullptr;
        }
        if (known != nullptr)
            return known->is_readable ? known : nullptr;
        GraphDesc& graph = *root_->graphs.emplace_back(
            std::make_unique<GraphDesc>(parse(file->shown, std::move(*file->text))));
        chain_.push_back(file->shown);
        loadFiles(graph, file->folder);
        chain_.pop_back();
        return graph.is_readable ? &graph : nullptr;
    }

    std::vector<Diagnostic>* diagnostics_;
    std::vector<Root> roots_;
    GraphDesc* root_ = nullptr;
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
                     const ReadFile& files, const std::string& shipped) {
    return GraphLoader(diagnostics, files, shipped).load(std::move(file), std::move(text));
}

GraphDesc parseGraphFile(const std::string& path, std::vector<Diagnostic>& diagnostics,
                         const std::string& shipped) {
    GraphDesc graph;
    if (std::optional<std::string> text = readBytes(path)) {
        graph = parseGraph(path, std::move(*text), diagnostics, filesBeside(path), shipped);
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

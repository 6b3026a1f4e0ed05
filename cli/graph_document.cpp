// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/graph_document.h"

#include "hone/cli/install_paths.h"
#include "hone/core/error.h"
#include "hone/core/graph/upgrade.h"

#include <algorithm>
#include <filesystem>

namespace hone::cli {

std::string GraphDocument::fileBeside() const {
    namespace fs = std::filesystem;
    std::vector<std::string> files;
    for (const auto& graph : desc.graphs)
        files.push_back(graph->source->file());
    for (const auto& shader : desc.shaders)
        files.push_back(shader->file());
    const fs::path shipped = fs::weakly_canonical(shippedGraphs());
    for (const std::string& file : files)
        if (const fs::path from_shipped = fs::weakly_canonical(file).lexically_relative(shipped);
            from_shipped.empty() || *from_shipped.begin() == "..")
            return fs::path(file).lexically_relative(fs::path(path()).parent_path()).string();
    return "";
}

GraphDocument readGraphDocument(const std::string& path) {
    std::vector<Diagnostic> diagnostics;
    GraphDocument document{parseGraphFile(path, diagnostics, shippedGraphs().string()), {}};
    if (std::ranges::any_of(diagnostics,
                            [](const Diagnostic& d) { return d.severity == Severity::kError; }))
        throw GraphError(format(diagnostics));
    // Nothing is left to report, and limits were kept.
    document.json = nlohmann::ordered_json::parse(
        upgradeText(*document.desc.source, diagnostics).text, nullptr, true, true);
    return document;
}

CompiledGraph compileDocument(const GraphDocument& document, const std::string& purpose,
                              const Catalog& catalog, const Overrides& overrides) {
    std::vector<Diagnostic> diagnostics;
    const GraphDesc desc = parseGraph(document.path() + " (" + purpose + ")", document.json.dump(2),
                                      diagnostics, filesBeside(document.path()), catalog.graphs);
    return compileOrThrow(desc, catalog, overrides, std::move(diagnostics));
}

} // namespace hone::cli

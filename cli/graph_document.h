// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/graph/compiled_graph.h"

#include <nlohmann/json.hpp>

#include <string>

namespace hone::cli {

/// A graph file as JSON, to be changed and then compiled or written.
struct GraphDocument {
    GraphDesc desc;              ///< as it was read, with the files that it names
    nlohmann::ordered_json json; ///< of the present version, without comments

    [[nodiscard]] const std::string& path() const { return desc.source->file(); }
    /// "part.json", one of the files beside it that it names; "" if it names none, or shipped ones,
    /// which graphs find wherever they lie.
    [[nodiscard]] std::string fileBeside() const;
};

/// Reads a file as parseGraphFile does, with its limits and the shipped graphs. Throws GraphError
/// with the report if anything that reading can tell is wrong; what compile() tells is not looked
/// for.
[[nodiscard]] GraphDocument readGraphDocument(const std::string& path);

/// Compiles `document.json` with the files beside the graph. Lines are not the file's, so reports
/// name the path with `purpose`: "sir.json (as it is timed)". Throws GraphError.
[[nodiscard]] CompiledGraph compileDocument(const GraphDocument& document,
                                            const std::string& purpose, const Catalog& catalog,
                                            const Overrides& overrides);

} // namespace hone::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/graph/executor.h"

#include <span>
#include <string>

namespace hone::cli {

/// What a drawing shows beside the graph itself.
struct DrawOptions {
    uvec2 size{800, 600};              ///< of images, for the memory that values take
    const Scene* scene = nullptr;      ///< null: what it decides is left out
    std::span<const NodeReport> times; ///< of a run; empty: none
};

/// A compiled graph in Graphviz' language: passes with their ports, loops as boxes around their
/// passes, from what they carry to what they carry on, culled passes grey with the reason. Names
/// may hold any bytes.
[[nodiscard]] std::string toDot(const CompiledGraph& graph, const DrawOptions& options);

} // namespace hone::cli

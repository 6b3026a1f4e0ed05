// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/graph/compiled_graph.h"

#include <string>
#include <string_view>

namespace hone::cli {

/// Pixels of a batch, of the selection and of the refinement that are timed.
inline constexpr uint kBenchBatch = 8192;

/// Sponza where it is there, else builtin:atrium.
[[nodiscard]] std::string defaultBenchScene();

/// sir.json with what else is to be timed in the same frame: nodes "visibility", "depth_only",
/// "noise" (bench_passes.h), "select" and "radix" (sort, over the noisy errors), "tonemap". Throws
/// GraphError.
[[nodiscard]] CompiledGraph makeBenchGraph(const Catalog& catalog);

/// Bytes that a node moves when its lists hold every pixel once.
struct Traffic {
    std::size_t read = 0;
    std::size_t written = 0;
};

/// Counts planes and lists. Records are left out: maps and tables are looked up here and there, not
/// read through.
[[nodiscard]] Traffic trafficOf(const CompiledGraph& graph, std::string_view node,
                                std::size_t pixels);

} // namespace hone::cli

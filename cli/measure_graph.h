// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/graph/compiled_graph.h"

#include <string>
#include <vector>

namespace hone::cli {

/// An output of a graph that estimates errors, under the name that a measurement gives it.
struct GraphMetric {
    std::string name;   ///< "shadow.error"; of another mode of a combiner "combine.error[max]"
    std::string output; ///< of MeasureGraph::graph
    std::string pass;   ///< "combine", or a graph that is used as a pass
    std::string mode;   ///< of a combiner; "" else
};

/// A graph made over to be judged: its outputs are the raster image ("raster") and every error
/// metric, so that none is culled, and refinement is.
struct MeasureGraph {
    CompiledGraph graph;
    std::vector<GraphMetric> metrics; ///< in the order of the file
};

/// Metrics are the outputs of type Error of passes outside loops and of graphs that are used as
/// passes, and each pass of type combine once more in every mode it has; what is inside such graphs
/// is theirs. The raster image is the graph's output "raster", else the first Radiance that a pass
/// outside loops makes. Throws GraphError, also if there is no metric or no such image.
[[nodiscard]] MeasureGraph makeMeasureGraph(const std::string& path, const Catalog& catalog,
                                            const Overrides& overrides);

} // namespace hone::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/graph/compiled_graph.h"
#include "hone/core/math.h"

#include <optional>
#include <string>
#include <vector>

namespace hone {

struct Scene;

/// What a plan's values and memories take, in bytes.
struct PlanSizes {
    /// By ValueId; none for values without elements, and where a scene decides and none was given.
    std::vector<std::optional<std::size_t>> values;
    std::vector<std::optional<std::size_t>> memories; ///< by CompiledGraph::memories
    std::size_t bytes = 0;                            ///< of all memories that are known
    std::size_t saved = 0;   ///< what more they would take if each value had memory of its own
    std::size_t unknown = 0; ///< memories that a scene decides
};

/// For images of `extent`; `scene` may be null. Runs the passes' size rules and nothing else.
[[nodiscard]] PlanSizes planSizes(const CompiledGraph& graph, uvec2 extent,
                                  const Scene* scene = nullptr);

/// "512 B", "5.8 MB": three digits or fewer before a decimal unit.
[[nodiscard]] std::string byteText(std::size_t bytes);

} // namespace hone

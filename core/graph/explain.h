// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/graph/compiled_graph.h"

#include <optional>
#include <string>

namespace hone {

/// Why the compiler did what it did with one thing of a graph, in words, a line a question. For a
/// value ("pass.port", "loop.carried", "graph.output", "$input", or an output's name): who writes
/// and reads it, how long it is needed, where it lies and why there, what is copied and why. For a
/// pass or loop: why it runs at its step, when again, and where; or why it does not run. None for
/// an unknown name.
[[nodiscard]] std::optional<std::string> explain(const CompiledGraph& graph, std::string_view name);

/// What explain() knows a graph's things by, for the nearest name.
[[nodiscard]] std::vector<std::string> explainable(const CompiledGraph& graph);

} // namespace hone

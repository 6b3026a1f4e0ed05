// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/graph/compiled_graph.h"

#include <nlohmann/json.hpp>

namespace hone::cli {

/// The JSON Schema (draft 07) of graph files: the language, and the pass types of the catalog with
/// their ports and parameters. It accepts what compile() accepts, as far as that can be seen from
/// the structure; names of passes and outputs, meanings and cycles are compile()'s alone.
[[nodiscard]] nlohmann::ordered_json graphSchema(const Catalog& catalog);

} // namespace hone::cli

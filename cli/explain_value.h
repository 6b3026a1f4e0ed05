// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/cli/commands.h"

namespace hone::cli {

/// Prints why the compiler culled, ordered, copied or shared what it did with a pass, loop or value
/// of a graph. Opens no device. Throws GraphError, for an unknown name with the nearest one.
int explainValue(const std::string& graph, const std::string& name, const Overrides& overrides,
                 std::span<const std::string> plugins, const Console& console);

} // namespace hone::cli

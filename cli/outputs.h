// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/graph/executor.h"
#include "hone/core/image/image.h"

#include <string>
#include <utility>
#include <vector>

namespace hone::cli {

/// Text pairs that go into every image: where it came from.
using Provenance = std::vector<std::pair<std::string, std::string>>;

/// Writes a run's outputs to `directory`: all planes as layers of GRAPH.exr (float), each plane as
/// a PNG for looking at, each curve as CSV. With a `number`, "0007", files are called
/// color.0007.png. Returns the paths. Throws OutputError; each file is whole or not there.
std::vector<std::string> writeOutputs(const Executor& executor, const std::string& directory,
                                      const Provenance& provenance, const std::string& number = "");

/// Any text as a file's name: only letters, digits, "_" and "-" of it stay, the others become "_",
/// so that the file stays in its folder.
[[nodiscard]] std::string fileStem(std::string name);

/// A plane as a person looks at it: radiance through the sRGB curve, errors and rounds as heat,
/// hits as false colours. Empty for values that are no picture.
[[nodiscard]] std::vector<vec3> picture(const Value& value);

} // namespace hone::cli

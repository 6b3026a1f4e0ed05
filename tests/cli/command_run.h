// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/tests/support/temporary_folder.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace hone::cli {

/// What a command printed and ended with.
struct CommandRun {
    int code = -1;
    std::string out;
    std::string err;

    /// Standard output as the one JSON object that --json promises; throws where it is not.
    [[nodiscard]] nlohmann::json json() const { return nlohmann::json::parse(out); }
};

/// Runs `hone` with these arguments in this process.
[[nodiscard]] CommandRun runHone(const std::vector<std::string>& arguments);

using test::TemporaryFolder;

/// Why graphs that rasterise cannot run here; "" if they can.
[[nodiscard]] std::string whyNoRaster();

} // namespace hone::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
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

/// A folder that goes with its content at the end of its scope.
class TemporaryFolder {
public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    [[nodiscard]] std::string path(const std::string& name = "") const {
        return (folder_ / name).string();
    }
    /// Writes a file into the folder; returns its path.
    [[nodiscard]] std::string write(const std::string& name, const std::string& text) const;

private:
    std::filesystem::path folder_;
};

/// Why graphs that rasterise cannot run here; "" if they can.
[[nodiscard]] std::string whyNoRaster();

} // namespace hone::cli

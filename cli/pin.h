// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/cli/outputs.h"
#include "hone/core/graph/executor.h"

#include <optional>
#include <span>

namespace hone::cli {

/// A value to save, whether it is an output of the graph or not.
struct PinRequest {
    std::string value;             ///< "pass.port", "loop.pass.port", "loop.carried", "loop.stats"
    std::optional<uint> iteration; ///< of its loop, from 1; none: the last with elements
    std::string path;              ///< *.exr for planes, *.csv for the others
};

/// Reads "refine.request.requests@3=requests.csv". Throws std::invalid_argument, which says what is
/// expected.
[[nodiscard]] PinRequest parsePin(const std::string& text);

/// Keeps what was asked for while a graph runs: values may share memory, so each is read right
/// after its pass ran. A value that a later run() does not make again stays as it was.
class Pins {
public:
    Pins() = default; ///< keeps nothing
    /// Throws GraphError with all that is wrong: unknown and culled values, iterations where there
    /// are none, files that cannot hold the type; OutputError where no file could be written.
    Pins(const CompiledGraph& graph, std::span<const PinRequest> requests);

    /// For RunOptions::on_pass.
    void see(const PassEvent& event, const Executor& executor);
    /// Writes each file atomically and adds its path to `paths`; with a number, "0007", to
    /// name.0007.exr. Returns a line for each value that was never made. Throws OutputError.
    std::string write(const CompiledGraph& graph, const Provenance& provenance,
                      std::vector<std::string>& paths, const std::string& number = "") const;

    [[nodiscard]] bool empty() const { return pins_.empty(); }

private:
    struct Pin {
        PinRequest request;
        NodeId writer = kNoId;
        std::size_t port = 0; ///< of a pass; of a loop its value is found by name
        uint last_seen = 0;   ///< iteration that ran last
        bool is_kept = false;
        uvec2 extent{0, 0};
        ImageLayer layer{}; ///< of a plane
        std::string text{}; ///< of the others
    };
    std::vector<Pin> pins_;
};

} // namespace hone::cli

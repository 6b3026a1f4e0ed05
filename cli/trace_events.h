// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/graph/executor.h"

#include <string>
#include <vector>

namespace hone::cli {

/// When each pass ran, as a file that chrome://tracing and Perfetto open: frames hold passes and
/// loops, loops their iterations, iterations their passes; counters show rays and pixels.
class TraceEvents {
public:
    TraceEvents() : began_(Clock::now()) {}

    /// For RunOptions::on_pass. A loop is told after what ran in it.
    void see(const PassEvent& event, const Executor& executor);
    /// A stretch around what was seen: a frame, the loading of a scene.
    void add(const std::string& name, std::chrono::steady_clock::time_point begin,
             std::chrono::steady_clock::time_point end);
    /// Throws OutputError.
    void write(const std::string& path, const std::string& graph) const;

private:
    using Clock = std::chrono::steady_clock;
    struct Span {
        std::string name, type; ///< a pass's type, "loop", "iteration"; "": add()
        uint iteration = 0;
        Clock::time_point begin, end;
        bool is_whole = true;
    };
    struct Count {
        Clock::time_point time;
        std::uint64_t rays = 0, pixels = 0;
    };
    /// The iteration of a loop that its passes are in.
    struct OpenIteration {
        NodeId loop = kNoId;
        Span span{};
    };
    void close(NodeId loop);

    Clock::time_point began_;
    std::vector<Span> spans_;
    std::vector<Count> counts_;
    std::vector<OpenIteration> open_;
};

} // namespace hone::cli

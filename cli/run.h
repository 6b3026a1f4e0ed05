// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/cli/commands.h"
#include "hone/cli/session.h"
#include "hone/cli/trace_events.h"

#include <memory>
#include <span>

namespace hone::cli {

/// A graph, a scene and a camera made ready to run: what render, demo and bench have in common.
struct Stage {
    explicit Stage(std::span<const std::string> plugins) : session(plugins) {}

    Session session;
    Devices devices;
    Scene scene;
    Camera camera{};
    std::unique_ptr<TraceRecorder> recorder; ///< null: nothing is recorded
    std::unique_ptr<Executor> executor;
    Pins pins;
    std::unique_ptr<TraceEvents> trace; ///< null: nobody asked when passes ran
};

/// Loads and compiles the graph, loads the scene (its warnings go to console.err), opens devices.
/// Throws what those throw.
[[nodiscard]] std::unique_ptr<Stage> makeStage(const RenderArguments& arguments,
                                               const Console& console);

/// Runs with live progress; stops within 250 ms when interrupted while it traces.
void runWithProgress(Stage& stage, const RenderArguments& arguments, const Console& console);

/// Who answered the rays, and why it did, for people.
struct UsedBackend {
    std::string name, reason;
};
/// The tracer that the graph's parameter "backend" names, "auto" and "vulkan" resolved; empty for a
/// graph that has no such parameter.
[[nodiscard]] UsedBackend backendOf(const Stage& stage);

/// The curve of the first loop whose statistics are an output; null if there is none.
[[nodiscard]] const Curve* findCurve(const Executor& executor);

} // namespace hone::cli

// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/run.h"

#include "hone/cli/interrupt_guard.h"
#include "hone/cli/progress.h"
#include "hone/core/error.h"
#include "hone/core/image/atomic_file.h"

#include <filesystem>
#include <ostream>

namespace hone::cli {
std::unique_ptr<Stage> makeStage(const RenderArguments& arguments, const Console& console) {
    auto stage = std::make_unique<Stage>(arguments.plugins);
    CompiledGraph graph =
        loadGraph(findGraph(arguments.graph), stage->session.catalog(), arguments.overrides);
    // Before anything is opened: can what is asked for be kept?
    stage->pins = Pins(graph, arguments.pins);
    if (!arguments.trace.empty()) {
        requireWritableDirectory(std::filesystem::path(arguments.trace).parent_path().string());
        stage->trace = std::make_unique<TraceEvents>();
    }
    if (!arguments.record.empty()) {
        stage->recorder = std::make_unique<TraceRecorder>(arguments.record, arguments.record_limit);
        stage->session.record(*stage->recorder);
    }
    stage->scene = loadScene(arguments.scene);
    for (const std::string& warning : stage->scene.warnings)
        console.err << "warning: " << warning << "\n";
    stage->camera = makeCamera(stage->scene.camera(arguments.camera));
    stage->devices = stage->session.openDevices(arguments.device, arguments.validate);
    if (stage->devices.raster == nullptr && !arguments.quiet)
        console.err << "warning: no Vulkan device: " << stage->session.rasterProblem()
                    << "; only graphs without raster passes can run\n";
    stage->executor = std::make_unique<Executor>(std::move(graph), stage->session.catalog(),
                                                 stage->devices, arguments.seed);
    stage->executor->setScene(stage->scene);
    stage->executor->setCamera(stage->camera);
    stage->executor->setExtent(arguments.size);
    return stage;
}

void runWithProgress(Stage& stage, const RenderArguments& arguments, const Console& console) {
    Progress progress(console.err, console.err_is_terminal && !arguments.quiet,
                      std::uint64_t{arguments.size.x} * arguments.size.y);
    RunOptions options;
    options.max_ms = arguments.max_ms;
    options.max_rays = arguments.max_rays;
    options.max_iterations = arguments.iterations;
    options.cancel = InterruptGuard::flag();
    options.on_iteration = [&](const LoopRecord& record) {
        progress.show(record);
        return true;
    };
    if (!stage.pins.empty() || stage.trace != nullptr)
        options.on_pass = [&](const PassEvent& event) {
            stage.pins.see(event, *stage.executor);
            if (stage.trace != nullptr)
                stage.trace->see(event, *stage.executor);
        };
    const auto begin = std::chrono::steady_clock::now();
    stage.executor->run(options);
    if (stage.trace != nullptr)
        stage.trace->add("frame", begin, std::chrono::steady_clock::now());
}

UsedBackend backendOf(const Stage& stage) {
    const PlannedParam* param = stage.executor->graph().findParam("backend");
    if (param == nullptr)
        return {};
    const auto [asked, reason] =
        stage.executor->tracers().resolve(std::get<std::string>(param->value), stage.scene);
    // A name may stand for one of several ways; what is made says which.
    const std::string made =
        stage.session.traceBackends().createBare(asked, stage.devices)->caps().name;
    if (made == asked)
        return {made, std::string(reason)};
    return {made, "what " + std::string(asked) + " stands for on this device"};
}

const Curve* findCurve(const Executor& executor) {
    for (const std::string& name : executor.outputs())
        if (const Curve* curve = executor.output(name).curve)
            return curve;
    return nullptr;
}

} // namespace hone::cli

// SPDX-License-Identifier: Apache-2.0
//
// hone render: runs a graph and writes its outputs.
#include "hone/cli/check_report.h"
#include "hone/cli/commands.h"
#include "hone/cli/copies.h"
#include "hone/cli/interrupt_guard.h"
#include "hone/cli/json.h"
#include "hone/cli/outputs.h"
#include "hone/cli/progress.h"
#include "hone/cli/run.h"

#include "hone/core/image/atomic_file.h"
#include "hone/core/image/compare.h"
#include "hone/core/scene/camera_path.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <iomanip>
#include <optional>
#include <ostream>

namespace hone::cli {
namespace {

using Json = nlohmann::ordered_json;

Json report(const Stage& stage, const RenderArguments& arguments, double frame_ms,
            const std::vector<std::string>& paths) {
    const Executor& executor = *stage.executor;
    Json passes = Json::array();
    for (const NodeReport& node : executor.nodes())
        passes.push_back({{"name", node.name},
                          {"type", node.type},
                          {"ms", node.ms},
                          {"runs", node.runs},
                          {"where", node.where}});
    Json rays = Json::object();
    for (const Counter& counter : executor.counters().all())
        if (counter.name.starts_with("rays."))
            rays[std::string(counter.name.substr(5))] = counter.value;
    const double pixels = static_cast<double>(arguments.size.x) * arguments.size.y;
    const std::uint64_t error_pixels = executor.counters().get("error_pixels");
    const Curve* curve = findCurve(executor);
    const bool has_looped = curve != nullptr && !curve->stop.empty();
    const UsedBackend backend = backendOf(stage);
    return {
        {"graph", executor.graph().name},
        {"scene", stage.scene.name},
        {"size", {arguments.size.x, arguments.size.y}},
        {"device", stage.devices.raster != nullptr ? stage.devices.raster->info().name : "none"},
        {"backend", backend.name},
        {"backend_reason", backend.reason},
        {"seed", arguments.seed},
        {"passes", passes},
        {"frame_ms", frame_ms},
        {"error_pixels", error_pixels},
        {"error_share", static_cast<double>(error_pixels) / pixels},
        {"rays", rays},
        {"iterations", curve != nullptr ? curve->records.size() : 0},
        {"stop", has_looped                    ? curve->stop
                 : InterruptGuard::requested() ? "cancelled"
                                               : ""},
        {"copies", copiesAsJson(executor.copies())},
        {"validation_messages", stage.session.validationMessages()},
        {"outputs", paths}};
}

void summarise(const Json& report, const Console& console) {
    std::ostream& err = console.err;
    err << std::fixed << std::setprecision(1);
    for (const Json& pass : report["passes"])
        err << "  " << std::left << std::setw(20) << pass["name"].get<std::string>()
            << std::setw(20) << pass["type"].get<std::string>() << std::right << std::setw(9)
            << pass["ms"].get<double>() << " ms  " << std::setw(6)
            << pass["runs"].get<std::uint64_t>() << (pass["runs"] == 1 ? " run   " : " runs  ")
            << pass["where"].get<std::string>() << "\n";
    err << "frame " << report["frame_ms"].get<double>() << " ms";
    if (report["error_pixels"].get<std::uint64_t>() > 0)
        err << ", " << 100 * report["error_share"].get<double>() << " % of the pixels flagged";
    std::uint64_t rays = 0;
    for (const auto& [kind, count] : report["rays"].items())
        rays += count.get<std::uint64_t>();
    if (rays > 0)
        err << ", " << shortNumber(static_cast<double>(rays)) << " rays by "
            << report["backend"].get<std::string>() << " in "
            << report["iterations"].get<std::uint64_t>()
            << " iterations (stopped: " << report["stop"].get<std::string>() << ")";
    std::size_t copied_bytes = 0;
    for (const Json& copy : report["copies"])
        copied_bytes += copy["bytes"].get<std::size_t>();
    err << "\ncopies between memories: " << report["copies"].size();
    if (copied_bytes > 0)
        err << " (" << shortNumber(static_cast<double>(copied_bytes)) << "B; --json lists them)";
    err << "\n" << std::defaultfloat;
}

/// A place on a camera path; of a single picture neither.
struct PathPlace {
    std::string path;
    std::string time; ///< seconds; read back, it is the same float
};

/// What it takes to make the image again; compare reads it.
Provenance provenanceOf(const Stage& stage, const RenderArguments& arguments,
                        const PathPlace& place) {
    std::string parameters;
    for (const auto& [name, value] : arguments.overrides)
        parameters += name + "=" + value + "\n";
    return {{"hone.graph", arguments.graph},
            {"hone.parameters", parameters},
            {"hone.scene", stage.scene.name},
            {"hone.camera", arguments.camera},
            {"hone.path", place.path},
            {"hone.time", place.time},
            {"hone.backend", backendOf(stage).name},
            {"hone.seed", std::to_string(arguments.seed)},
            {"hone.version", HONE_VERSION}};
}

double msSince(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
        .count();
}

/// How often each node ran, in the order of the executor's reports.
std::vector<std::uint64_t> runsOf(const Executor& executor) {
    std::vector<std::uint64_t> runs;
    for (const NodeReport& node : executor.nodes())
        runs.push_back(node.runs);
    return runs;
}

/// Renders and writes the pictures along a camera path. Returns a report of each, whose passes
/// count the runs for this picture alone. Ends after a picture that a signal cut.
Json renderFrames(Stage& stage, const RenderArguments& arguments, const Console& console) {
    const CameraPath path = cameraPath(stage.scene, arguments.path);
    const std::size_t digits =
        std::max<std::size_t>(4, std::to_string(arguments.frames - 1).size());
    Json frames = Json::array();
    std::vector<std::uint64_t> runs_before = runsOf(*stage.executor);
    for (uint frame = 0; frame < arguments.frames; ++frame) {
        const float time = frameTime(path, frame, arguments.frames);
        stage.executor->setCamera(makeCamera(cameraAt(path, time)));
        const auto begin = std::chrono::steady_clock::now();
        runWithProgress(stage, arguments, console);
        const double frame_ms = msSince(begin);

        char time_text[64];
        const auto [end, error] = std::to_chars(time_text, std::end(time_text), time);
        std::string number = std::to_string(frame);
        number.insert(0, digits - number.size(), '0');
        const Provenance provenance =
            provenanceOf(stage, arguments, {path.name, std::string(time_text, end)});
        std::vector<std::string> files =
            writeOutputs(*stage.executor, arguments.output_directory, provenance, number);
        console.err << stage.pins.write(stage.executor->graph(), provenance, files, number);

        const Json whole = report(stage, arguments, frame_ms, files);
        Json picture{{"frame", frame}, {"time", time}};
        for (const char* key : {"passes", "frame_ms", "error_pixels", "error_share", "rays",
                                "iterations", "stop", "outputs"})
            picture[key] = whole[key];
        const std::vector<std::uint64_t> runs = runsOf(*stage.executor);
        for (std::size_t i = 0; i < runs.size(); ++i)
            picture["passes"][i]["runs"] = runs[i] - runs_before[i];
        runs_before = runs;
        if (!arguments.quiet)
            console.err << "frame " << number << ": " << std::fixed << std::setprecision(1)
                        << frame_ms << " ms\n"
                        << std::defaultfloat;
        frames.push_back(std::move(picture));
        if (InterruptGuard::requested() != 0)
            break;
    }
    return frames;
}

} // namespace

int render(const RenderArguments& arguments, const Console& console) {
    // Before any work: can the result be kept?
    requireWritableDirectory(arguments.output_directory);
    std::optional<tbb::global_control> threads;
    if (arguments.threads > 0)
        threads.emplace(tbb::global_control::max_allowed_parallelism,
                        static_cast<std::size_t>(arguments.threads));

    const InterruptGuard interrupts;
    const std::unique_ptr<Stage> stage = makeStage(arguments, console);
    const auto begin = std::chrono::steady_clock::now();
    if (arguments.max_copies >= 0) {
        stage->executor->prepare();
        if (!areCopiesAllowed(stage->executor->copies(), arguments.max_copies, console.err))
            return kTargetNotMet;
    }
    std::vector<std::string> paths;
    bool is_all_written = true;
    Json result;
    if (arguments.frames > 0) {
        const Json frames = renderFrames(*stage, arguments, console);
        for (const Json& frame : frames)
            for (const Json& path : frame["outputs"])
                paths.push_back(path.get<std::string>());
        result = report(*stage, arguments, msSince(begin), paths);
        result["path"] = cameraPath(stage->scene, arguments.path).name;
        result["frames"] = frames;
    } else {
        runWithProgress(*stage, arguments, console);
        const double frame_ms = msSince(begin);
        const Provenance provenance = provenanceOf(*stage, arguments, {});
        paths = writeOutputs(*stage->executor, arguments.output_directory, provenance);
        const std::string missing = stage->pins.write(stage->executor->graph(), provenance, paths);
        console.err << missing;
        is_all_written = missing.empty();
        result = report(*stage, arguments, frame_ms, paths);
    }
    if (stage->trace != nullptr) {
        stage->trace->write(arguments.trace, stage->executor->graph().name);
        result["trace"] = arguments.trace;
        paths.push_back(arguments.trace);
    }
    if (stage->recorder != nullptr) {
        stage->recorder->finish();
        result["record"] = {{"path", arguments.record},
                            {"bytes", stage->recorder->bytes()},
                            {"is_cut", stage->recorder->isCut()}};
        paths.push_back(arguments.record);
    }
    if (const CheckReport& checked = stage->session.checkReport();
        checked.closest.lists + checked.occluded.lists > 0) {
        result["check"] = toJson(checked);
        if (!arguments.quiet)
            console.err << toText(checked);
    }
    // A run that was cancelled early may have no colour yet.
    if (!arguments.reference.empty() && stage->executor->output("color").version != 0) {
        const Value& color = stage->executor->output("color");
        const std::span<vec3> pixels = color.as<vec3>();
        const ImageDifference difference =
            compareImages({color.extent, {pixels.begin(), pixels.end()}, false},
                          readRgb(arguments.reference, "color"));
        result["reference"] = {{"mse", difference.mse},
                               {"max", difference.max},
                               {"differing_bits", difference.differing_bits}};
        if (!arguments.quiet)
            console.err << "against " << arguments.reference << ": mse " << difference.mse
                        << ", max " << difference.max << ", differing bits "
                        << difference.differing_bits << "\n";
    }
    if (!arguments.quiet) {
        summarise(result, console);
        for (const std::string& path : paths)
            console.err << "wrote " << path << "\n";
    }
    if (arguments.json)
        print(console.out, result);
    if (const int signal = InterruptGuard::requested())
        return signal;
    // Lists that a tracer had to copy are known only now.
    if (!areCopiesAllowed(stage->executor->copies(), arguments.max_copies, console.err))
        return kTargetNotMet;
    if (stage->session.validationMessages() > 0)
        return kTargetNotMet;
    return is_all_written ? kOk : kNotWritten;
}

} // namespace hone::cli

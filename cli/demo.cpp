// SPDX-License-Identifier: Apache-2.0
//
// hone demo: what smart image refinement does, shown on the built-in atrium.
#include "hone/cli/commands.h"
#include "hone/cli/interrupt_guard.h"
#include "hone/cli/outputs.h"
#include "hone/cli/progress.h"
#include "hone/cli/report.h"
#include "hone/cli/run.h"

#include "hone/core/image/atomic_file.h"
#include "hone/core/image/compare.h"

#include <chrono>
#include <cstdio>
#include <ostream>

namespace hone::cli {
namespace {

struct Timed {
    double ms = 0;
    std::uint64_t rays = 0;
};

Timed timedRun(Stage& stage, const RenderArguments& arguments, const Console& console) {
    const auto begin = std::chrono::steady_clock::now();
    runWithProgress(stage, arguments, console);
    Timed result;
    result.ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    for (const Counter& counter : stage.executor->counters().all())
        if (counter.name.starts_with("rays."))
            result.rays += counter.value;
    return result;
}

RgbImage colorOf(const Executor& executor) {
    const Value& color = executor.output("color");
    const std::span<vec3> pixels = color.as<vec3>();
    return {color.extent, {pixels.begin(), pixels.end()}, false};
}

Image8 pictureOf(const Executor& executor, const char* output) {
    const Value& value = executor.output(output);
    return quantize(value.extent, picture(value));
}

/// The pictures in one row, with a gap of `gap` white pixels.
Image8 sideBySide(const std::vector<ReportPicture>& pictures, uint gap) {
    const uvec2 one = pictures.front().image.extent;
    const uint count = static_cast<uint>(pictures.size());
    Image8 strip{{one.x * count + gap * (count - 1), one.y}, {}};
    strip.rgba.assign(std::size_t{4} * strip.extent.x * strip.extent.y, 255);
    for (uint k = 0; k < count; ++k)
        for (uint y = 0; y < one.y; ++y)
            std::copy_n(pictures[k].image.rgba.begin() + std::ptrdiff_t{4} * y * one.x,
                        std::size_t{4} * one.x,
                        strip.rgba.begin() + std::ptrdiff_t{4} * (std::size_t{y} * strip.extent.x +
                                                                  k * (one.x + gap)));
    return strip;
}

std::string text(const char* pattern, auto... values) {
    char buffer[256];
    std::snprintf(buffer, sizeof buffer, pattern, values...);
    return buffer;
}

} // namespace

int demo(const DemoArguments& arguments, const Console& console) {
    requireWritableDirectory(arguments.output_directory);
    const InterruptGuard interrupts;
    RenderArguments job;
    job.plugins = arguments.plugins;
    job.graph = "sir";
    job.scene = "builtin:atrium";
    job.size = arguments.size;
    job.device = arguments.device;
    job.overrides = {{"samples", "16"}, {"scope", "flagged"}};
    console.err << "rendering the atrium, " << job.size.x << " x " << job.size.y
                << ", 16 samples a pixel\n";
    const std::unique_ptr<Stage> stage = makeStage(job, console);

    // First only what the metrics flag: what smart image refinement saves.
    const Timed flagged = timedRun(*stage, job, console);
    if (const int signal = InterruptGuard::requested())
        return signal;
    const Executor& executor = *stage->executor;
    const double pixels = static_cast<double>(job.size.x) * job.size.y;
    const double share =
        100 * static_cast<double>(executor.counters().get("error_pixels")) / pixels;
    Report report;
    report.title = "hone demo: smart image refinement";
    report.pictures.push_back({"Raster",
                               "rasterised: hard shadow maps, mirrors from an environment probe",
                               pictureOf(executor, "raster")});
    report.pictures.push_back(
        {"Predicted error",
         "how wrong the metrics expect each raster pixel to be: black none, yellow much",
         pictureOf(executor, "error")});
    report.pictures.push_back(
        {"Traced pixels",
         text("the %.1f %% of the pixels that were traced, the brighter the sooner", share),
         pictureOf(executor, "round")});
    const RgbImage after_flagged = colorOf(executor);
    report.pictures.push_back({"Refined", "the traced pixels blended over the raster image",
                               pictureOf(executor, "color")});

    // Then the rest, and pure ray tracing beside it: the two must be the same bits.
    stage->executor->setParameter("scope", "all");
    const Timed all = timedRun(*stage, job, console);
    if (const int signal = InterruptGuard::requested())
        return signal;
    const RgbImage refined = colorOf(executor);
    RenderArguments truth_job = job;
    truth_job.graph = "prt";
    truth_job.overrides = {{"samples", "16"}};
    const std::unique_ptr<Stage> truth_stage = makeStage(truth_job, console);
    const Timed truth = timedRun(*truth_stage, truth_job, console);
    if (const int signal = InterruptGuard::requested())
        return signal;
    const RgbImage reference = colorOf(*truth_stage->executor);
    const ImageDifference of_raster =
        compareImages(toDisplay({reference.extent,
                                 [&] {
                                     const auto p = executor.output("raster").as<vec3>();
                                     return std::vector<vec3>(p.begin(), p.end());
                                 }(),
                                 false}),
                      toDisplay(reference));
    const ImageDifference of_flagged =
        compareImages(toDisplay(after_flagged), toDisplay(reference));
    const ImageDifference of_refined = compareImages(refined, reference);

    report.summary = text("The metrics flagged %.1f %% of the pixels. Tracing only those took %.1f "
                          "M rays of the %.1f M that tracing everything takes, "
                          "and brought the mean squared error from %.2e to %.2e. Refined to the "
                          "end, the image differs from pure ray tracing in %llu bits.",
                          share, static_cast<double>(flagged.rays) / 1e6,
                          static_cast<double>(truth.rays) / 1e6, of_raster.mse, of_flagged.mse,
                          static_cast<unsigned long long>(of_refined.differing_bits));
    report.tables.push_back({"Time, everything included",
                             {"", "ms", "rays"},
                             {{"raster, metrics and flagged pixels", text("%.0f", flagged.ms),
                               shortNumber(static_cast<double>(flagged.rays))},
                              {"all pixels, worst first (raster kept from before)",
                               text("%.0f", all.ms), shortNumber(static_cast<double>(all.rays))},
                              {"pure ray tracing (tree build included)", text("%.0f", truth.ms),
                               shortNumber(static_cast<double>(truth.rays))}}});
    ReportTable passes{"Passes of the graph", {"pass", "type", "ran on", "runs"}, {}};
    for (const NodeReport& node : executor.nodes())
        passes.rows.push_back({node.name, node.type, node.where, std::to_string(node.runs)});
    report.tables.push_back(std::move(passes));

    static constexpr const char* kFiles[] = {"raster", "error", "traced", "refined"};
    const std::string folder = arguments.output_directory + "/";
    for (std::size_t k = 0; k < report.pictures.size(); ++k)
        writePng(folder + kFiles[k] + ".png", report.pictures[k].image);
    writePng(folder + "side_by_side.png", sideBySide(report.pictures, 8));
    const std::string html = toHtml(report);
    writeFileAtomically(folder + "report.html", std::as_bytes(std::span(html)));

    console.out
        << report.summary << "\n\nPictures in " << arguments.output_directory
        << ": raster.png, error.png, traced.png, refined.png, side_by_side.png, report.html\n";
    return of_refined.differing_bits == 0 ? kOk : kTargetNotMet;
}

} // namespace hone::cli

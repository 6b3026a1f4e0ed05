// SPDX-License-Identifier: Apache-2.0
//
// hone measure: how good a graph's error metrics are against the truth. What the numbers
// mean and what came out: docs/measurements.md.
#include "hone/cli/commands.h"
#include "hone/cli/json.h"
#include "hone/cli/measure_pictures.h"
#include "hone/core/image/atomic_file.h"

#include <ostream>

namespace hone::cli {
namespace {

const char* name(MeasuredEffect effect) {
    switch (effect) {
    case MeasuredEffect::kReflection:
        return "reflection";
    case MeasuredEffect::kShadow:
        return "shadow";
    case MeasuredEffect::kDof:
        return "dof";
    case MeasuredEffect::kNone:
        return "none";
    case MeasuredEffect::kAll:
        break;
    }
    return "all";
}

void writeText(const std::string& path, const std::string& text) {
    writeFileAtomically(path, std::as_bytes(std::span(text)));
}

} // namespace

int measure(const MeasureArguments& arguments, const Console& console) {
    const std::string& folder = arguments.output_directory;
    if (!folder.empty())
        requireWritableDirectory(folder);
    MeasureStage stage(arguments, console);
    Measurement measurement{.graph = arguments.graph,
                            .scene = stage.scene().name,
                            .effect = name(arguments.effect),
                            .truth = arguments.truth,
                            .size = arguments.size,
                            .truth_samples = stage.truthSamples(),
                            .is_truth_judged = arguments.truth_samples > 0,
                            .names = {},
                            .views = {}};
    for (const GraphMetric& metric : stage.metrics())
        measurement.names.push_back(metric.name);
    MeasurePictures pictures(folder);
    for (const MeasureView& view : stage.views()) {
        console.err << "measuring " << view.name << " (" << measurement.views.size() + 1 << " of "
                    << stage.views().size() << ")\n";
        const JudgedView judged = stage.judge(view);
        if (!folder.empty())
            pictures.add(judged);
        measurement.views.push_back(measureView(judged, stage.refine(view, judged)));
    }

    nlohmann::ordered_json report = toJson(measurement);
    std::vector<std::string> files;
    if (!folder.empty()) {
        files = pictures.finish(measurement);
        writeText(files.emplace_back(folder + "/metrics.csv"), metricsAsCsv(measurement));
        writeText(files.emplace_back(folder + "/curves.csv"), curvesAsCsv(measurement));
    }
    report["files"] = files;
    if (arguments.json)
        print(console.out, report);
    else if (arguments.markdown)
        printMarkdown(measurement, console.out);
    else
        printTable(measurement, console.out);
    if (!folder.empty())
        console.err << "wrote " << files.size() << " files to " << folder
                    << "; measure.html shows them\n";
    return kOk;
}

} // namespace hone::cli

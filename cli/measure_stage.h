// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/cli/commands.h"
#include "hone/cli/interrupt_guard.h"
#include "hone/cli/measure_graph.h"
#include "hone/cli/measure_views.h"
#include "hone/cli/session.h"

#include "hone/core/measure/quality.h"
#include "hone/core/measure/real_error.h"

#include <memory>
#include <string>
#include <vector>

namespace hone::cli {

/// What a metric says of a view; finite and not negative (what was not finite counts as 1).
struct MetricPlanes {
    std::string name;
    std::vector<float> expect, bound;
    std::size_t repaired = 0; ///< elements that were not finite or negative
};

/// A view with its truth and all metrics.
struct JudgedView {
    std::string name;
    RgbImage raster, truth;
    RealError error;
    std::vector<float> cost;  ///< rays of a pixel, mean over the 4 x 4 pixels that it is in
    std::vector<float> noise; ///< standard error of the truth; empty if it was not asked for
    std::vector<MetricPlanes> metrics;

    [[nodiscard]] ViewTruth known() const {
        return {truth.extent, error.max, error.square, cost, noise};
    }
};

/// A frame of the graph itself, as it is refined.
struct RefinedFrame {
    struct Point {
        double ms = 0; ///< since the frame began: raster and metrics, too
        std::uint64_t rays = 0;
        double mse = 0;
    };
    std::vector<Point> points; ///< after each batch; the first is the raster image's
    double estimate_ms = 0;    ///< of it all, what was no refinement: raster image, metrics, order
    double prt_ms = 0;         ///< of the truth's graph, all at once; 0 if that cannot be timed

    /// Milliseconds until the MSE is `share` of the raster image's or less, for good; NaN if it
    /// never is.
    [[nodiscard]] double msUntil(double share) const;
};

/// Everything that a measurement needs: the graph made over to be judged, the graph that makes the
/// truth, the graph as it is, and the views of the scene. While it lives, SIGINT and SIGTERM end
/// what it does by Interrupted, within 250 ms while it traces.
class MeasureStage {
public:
    /// Warnings and progress go to console.err. Throws GraphError, SceneError, DeviceError.
    MeasureStage(const MeasureArguments& arguments, const Console& console);
    ~MeasureStage();

    [[nodiscard]] const Scene& scene() const { return scene_; }
    [[nodiscard]] const CompiledGraph& graph() const { return estimate_->graph(); }
    [[nodiscard]] const std::vector<GraphMetric>& metrics() const { return metrics_; }
    [[nodiscard]] const std::vector<MeasureView>& views() const { return views_; }
    [[nodiscard]] uint truthSamples() const { return truth_samples_; }

    [[nodiscard]] JudgedView judge(const MeasureView& view);
    /// Refines and times; no points for a graph that has no refinement whose output is "color".
    [[nodiscard]] RefinedFrame refine(const MeasureView& view, const JudgedView& judged);

private:
    std::unique_ptr<Executor> start(CompiledGraph graph, std::uint64_t seed);
    static void run(Executor& executor, RunOptions options = {});
    /// Runs the truth's graph in batches of 16 pixels, so that the rays of each are known.
    void traceTruth(JudgedView& judged, const Camera& camera);

    InterruptGuard interrupts_;
    MeasureArguments arguments_;
    Session session_; // owns the devices: before what lives on them
    Scene scene_;
    Devices devices_;
    std::vector<MeasureView> views_;
    std::vector<GraphMetric> metrics_;
    uint truth_samples_ = 0; ///< 0: the truth's graph has no such parameter
    std::unique_ptr<Executor> estimate_, truth_, second_truth_, refined_;
    bool is_warm_ = false; ///< refined_ ran before
};

} // namespace hone::cli

// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/measure_stage.h"

#include "hone/cli/bench_clock.h"
#include "hone/core/error.h"
#include "hone/core/image/tile_order.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <ostream>

namespace hone::cli {
namespace {

/// Pixels of the truth whose rays are counted together: 4 x 4, by tile order.
constexpr uint kCostBatch = 16;

/// Leaves one effect for raster image and truth to differ by. The metrics see the changed scene,
/// too, so that those of other effects find nothing.
void keepOnly(MeasuredEffect effect, Scene& scene) {
    if (effect == MeasuredEffect::kAll)
        return;
    if (effect != MeasuredEffect::kReflection)
        for (Material& material : scene.materials) {
            material.f0 = vec3(0);
            material.flags &= ~kMaterialMirror;
        }
    if (effect != MeasuredEffect::kShadow)
        for (Light& light : scene.lights)
            light.shadowless = 1;
    if (effect != MeasuredEffect::kDof)
        for (CameraDesc& camera : scene.cameras)
            camera.aperture = 0;
    touch(scene);
}

RgbImage imageOf(const Executor& executor, const char* output) {
    const Value& value = executor.output(output);
    const std::span<vec3> pixels = value.as<vec3>();
    return {value.extent, {pixels.begin(), pixels.end()}, false};
}

bool hasOutput(const CompiledGraph& graph, std::string_view name, const PortType& type) {
    return std::ranges::any_of(graph.outputs, [&](const NamedValue& output) {
        return output.name == name && graph.values[output.value].type == type;
    });
}

MetricPlanes planesOf(const std::string& name, const Value& value) {
    MetricPlanes planes{name, {}, {}, 0};
    const auto repaired = [&planes](float x) {
        if (x >= 0 && std::isfinite(x))
            return x;
        ++planes.repaired;
        return x < 0 && std::isfinite(x) ? 0.0f : 1.0f;
    };
    for (const vec2 error : value.as<vec2>()) {
        planes.expect.push_back(repaired(error.x));
        planes.bound.push_back(repaired(error.y));
    }
    return planes;
}

/// Of a truth, from its difference to another one with other random numbers, which is sqrt(2)
/// standard errors large in the root mean square. One pixel's difference tells little: that of 3 x
/// 3 pixels is taken together.
std::vector<float> standardError(std::span<const float> difference, uvec2 extent) {
    std::vector<float> result(difference.size());
    for (uint y = 0; y < extent.y; ++y)
        for (uint x = 0; x < extent.x; ++x) {
            float squares = 0, count = 0;
            for (uint v = std::max(y, 1u) - 1; v < std::min(y + 2, extent.y); ++v)
                for (uint u = std::max(x, 1u) - 1; u < std::min(x + 2, extent.x); ++u) {
                    const float d = difference[std::size_t{v} * extent.x + u];
                    squares += d * d;
                    ++count;
                }
            result[std::size_t{y} * extent.x + x] = std::sqrt(squares / (2 * count));
        }
    return result;
}

/// Of the last run.
double msInLoops(const Executor& executor) {
    double ms = 0;
    for (const NodeReport& node : executor.nodes())
        if (executor.graph().findNode(node.name)->parent != kNoId)
            ms += node.ms;
    return ms;
}

double meanOf(std::span<const float> values) {
    return std::accumulate(values.begin(), values.end(), 0.0) /
           static_cast<double>(std::max<std::size_t>(values.size(), 1));
}

} // namespace

double RefinedFrame::msUntil(double share) const {
    double ms = std::numeric_limits<double>::quiet_NaN();
    for (auto point = points.rbegin(); point != points.rend(); ++point) {
        if (point->mse > share * points.front().mse)
            break;
        ms = point->ms;
    }
    return ms;
}

MeasureStage::MeasureStage(const MeasureArguments& arguments, const Console& console)
    : arguments_(arguments), session_(arguments.plugins), scene_(loadScene(arguments.scene)) {
    for (const std::string& warning : scene_.warnings)
        console.err << "warning: " << warning << "\n";
    keepOnly(arguments.effect, scene_);

    // Compiled before a device is opened: a bad graph is told at once.
    const Catalog catalog = session_.catalog();
    const std::string path = findGraph(arguments.graph);
    MeasureGraph measured = makeMeasureGraph(path, catalog, arguments.overrides);
    CompiledGraph written = loadGraph(path, catalog, arguments.overrides);
    Overrides same;
    for (const char* shared : {"samples", "backend"})
        if (const PlannedParam* param = written.findParam(shared))
            same.emplace_back(shared, toString(param->value));
    if (arguments.truth_samples > 0)
        same.emplace_back("samples", std::to_string(arguments.truth_samples));
    const std::string truth_path = findGraph(arguments.truth);
    std::erase_if(same, [&, plain = loadGraph(truth_path, catalog, {})](const auto& pair) {
        return plain.findParam(pair.first) == nullptr;
    });
    CompiledGraph truth = loadGraph(truth_path, catalog, same);
    if (!hasOutput(truth, "color", types::kRadiance))
        throw GraphError(truth_path + ": cannot be the truth: it has no output \"color\" of type "
                                      "Radiance");
    if (const PlannedParam* samples = truth.findParam("samples"))
        truth_samples_ = std::get<uint>(samples->value);

    views_ = chooseViews(scene_, arguments.views);
    if (views_.size() < arguments.views)
        console.err << "warning: " << scene_.name << ": found only " << views_.size() << " of "
                    << arguments.views << " views that do not look into a wall\n";
    devices_ = session_.openDevices(arguments.device, false);
    if (devices_.raster == nullptr)
        throw DeviceError("no Vulkan device to rasterise with: " + session_.rasterProblem());

    metrics_ = std::move(measured.metrics);
    if (arguments.truth_samples > 0)
        second_truth_ = start(truth, arguments.seed + 1);
    // Samples of a batch are in memory at once.
    if (second_truth_ != nullptr && truth.findParam("batch") != nullptr)
        second_truth_->setParameter("batch", "8192");
    truth_ = start(std::move(truth), arguments.seed);
    estimate_ = start(std::move(measured.graph), arguments.seed);
    if (hasOutput(written, "color", types::kRadiance) && hasOutput(written, "curve", types::kCurve))
        refined_ = start(std::move(written), arguments.seed);
}

MeasureStage::~MeasureStage() = default;

std::unique_ptr<Executor> MeasureStage::start(CompiledGraph graph, std::uint64_t seed) {
    auto executor =
        std::make_unique<Executor>(std::move(graph), session_.catalog(), devices_, seed);
    executor->setScene(scene_);
    executor->setExtent(arguments_.size);
    return executor;
}

void MeasureStage::run(Executor& executor, RunOptions options) {
    options.cancel = InterruptGuard::flag();
    executor.run(options);
    if (InterruptGuard::requested() != 0)
        throw Interrupted("interrupted while views were measured: there is no result");
}

JudgedView MeasureStage::judge(const MeasureView& view) {
    const Camera camera = makeCamera(view.camera);
    JudgedView judged;
    judged.name = view.name;
    traceTruth(judged, camera);

    estimate_->setCamera(camera);
    run(*estimate_);
    judged.raster = imageOf(*estimate_, "raster");
    judged.error = realError(judged.raster, judged.truth);
    for (const GraphMetric& metric : metrics_)
        judged.metrics.push_back(planesOf(metric.name, estimate_->output(metric.output)));

    if (second_truth_ != nullptr) {
        second_truth_->setCamera(camera);
        run(*second_truth_);
        judged.noise = standardError(realError(imageOf(*second_truth_, "color"), judged.truth).max,
                                     judged.truth.extent);
    }
    return judged;
}

void MeasureStage::traceTruth(JudgedView& judged, const Camera& camera) {
    truth_->setCamera(camera);
    const bool counts = truth_->graph().findParam("batch") != nullptr &&
                        hasOutput(truth_->graph(), "curve", types::kCurve);
    if (counts)
        truth_->setParameter("batch", std::to_string(kCostBatch));
    run(*truth_);
    judged.truth = imageOf(*truth_, "color");
    if (!counts)
        return;

    // Batches are consecutive in tile order.
    const TileOrder tiles(judged.truth.extent);
    std::vector<uint> pixels;
    for (uint tile = 0; tile < tiles.tiles().x * tiles.tiles().y; ++tile)
        tiles.forEachPixel(tile, [&](uint pixel) { pixels.push_back(pixel); });
    judged.cost.resize(pixels.size(), 1);
    LoopRecord before;
    for (const LoopRecord& record : truth_->output("curve").curve->records) {
        if (record.pixels == before.pixels)
            continue;
        const auto rays = static_cast<float>(record.rays - before.rays) /
                          static_cast<float>(record.pixels - before.pixels);
        for (std::size_t i = before.pixels; i < std::min(record.pixels, pixels.size()); ++i)
            judged.cost[pixels[i]] = std::max(rays, 1.0f);
        before = record;
    }
}

RefinedFrame MeasureStage::refine(const MeasureView& view, const JudgedView& judged) {
    RefinedFrame frame;
    if (refined_ == nullptr)
        return frame;
    const bool times_truth = truth_->graph().findParam("batch") != nullptr;
    if (times_truth)
        truth_->setParameter("batch", "0");
    const Camera camera = makeCamera(view.camera);
    // Tracers, maps of lights and probes are made once for all views: not in the first one's time.
    if (!is_warm_) {
        Camera beside = camera;
        beside.position += 1e-4f * camera.right;
        for (Executor* executor : {refined_.get(), truth_.get()}) {
            executor->setCamera(beside);
            run(*executor);
        }
        is_warm_ = true;
    }

    frame.points.push_back({0, 0, meanOf(judged.error.square)});
    refined_->setCamera(camera);
    RunOptions one_batch;
    one_batch.max_iterations = 1;
    const Curve& curve = *refined_->output("curve").curve;
    double ms = 0;
    std::size_t batches = 0;
    for (bool goes_on = true; goes_on;) {
        ms += elapsedMs([&] { run(*refined_, one_batch); });
        if (frame.points.size() == 1)
            frame.estimate_ms = ms - msInLoops(*refined_);
        const std::uint64_t rays = curve.records.empty() ? 0 : curve.records.back().rays;
        frame.points.push_back(
            {ms, rays, meanOf(realError(imageOf(*refined_, "color"), judged.truth).square)});
        goes_on = curve.stop == "iterations" && curve.records.size() != batches;
        batches = curve.records.size();
    }

    truth_->setCamera(camera);
    if (times_truth)
        frame.prt_ms = elapsedMs([&] { run(*truth_); });
    return frame;
}

} // namespace hone::cli

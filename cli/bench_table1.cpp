// SPDX-License-Identifier: Apache-2.0
//
// hone bench table1: the paper's Table 1. Four views of a scene, of which about 40, 20, 5 and 1 %
// are error pixels, each refined where it is wrong (SIR) and ray-traced whole (PRT), side by side
// in one run.
//
// Twice: as the paper did it, with lights that are points and one sample a pixel, and with the
// scene's own lights and lens at 16 samples. PRT is the fastest that there is here: all pixels at
// once, in tile order, coherent packets for primary and shadow rays. Every run sees a camera a
// little beside the last one, so that everything that depends on the view is done again; what
// depends on the scene alone (shadow maps, probes) is not.
#include "hone/cli/bench_clock.h"
#include "hone/cli/bench_graph.h"
#include "hone/cli/commands.h"
#include "hone/cli/json.h"
#include "hone/cli/session.h"
#include "hone/cli/table1.h"
#include "hone/cli/view_choice.h"

#include "hone/core/error.h"
#include "hone/core/graph/executor.h"

#include <algorithm>
#include <array>
#include <map>
#include <ostream>

namespace hone::cli {
namespace {

constexpr std::array kShares{0.40, 0.20, 0.05, 0.01};

class Table1Bench {
public:
    Table1Bench(const BenchTable1Arguments& arguments, const Console& console)
        : arguments_(arguments), console_(console), session_(arguments.plugins),
          devices_(session_.openDevices("", false)) {}

    Table1 run() {
        for (const uint samples : arguments_.samples) {
            Scene scene = loadScene(arguments_.scene);
            CameraDesc like = viewLike(scene);
            if (samples == 1) {
                makeLightsPoints(scene);
                like.aperture = 0;
            }
            const std::string graph = findGraph(arguments_.graph);
            console_.err << "choosing views of " << scene.name << "\n";
            const std::vector<ChosenView> views =
                chooseViewsByShare(graph, session_, devices_, scene, like, kShares);
            Overrides flagged_at_once{
                {"batch", "0"}, {"scope", "flagged"}, {"samples", std::to_string(samples)}};
            if (arguments_.visibility == "rays")
                flagged_at_once.emplace_back("visibility", "rays");
            Executor refined(loadGraph(graph, session_.catalog(), flagged_at_once),
                             session_.catalog(), devices_);
            Executor traced(loadGraph(findGraph("prt"), session_.catalog(),
                                      {{"samples", std::to_string(samples)}}),
                            session_.catalog(), devices_);
            for (Executor* executor : {&refined, &traced})
                executor->setScene(scene);
            for (const uvec2 size : arguments_.sizes)
                for (const ChosenView& view : views)
                    table_.rows.push_back(measure(refined, traced, size, samples, view));
        }
        return std::move(table_);
    }

private:
    /// The camera that was asked for; else the first with a lens, or without if there is none.
    [[nodiscard]] const CameraDesc& viewLike(const Scene& scene) const {
        if (arguments_.camera.empty())
            for (const CameraDesc& camera : scene.cameras)
                if (camera.aperture > 0)
                    return camera;
        return scene.camera(arguments_.camera);
    }

    /// Runs with a camera a little beside the last one.
    void runMoved(Executor& executor, Camera camera) {
        // Contenders take turns, so two places would give each of them always the same.
        camera.position += 1e-4f * static_cast<float>(++moves_ % 3) * camera.right;
        executor.setCamera(camera);
        executor.run();
    }

    /// Of the refinement: those of a raster image by rays are raster's.
    static std::uint64_t raysOf(const Executor& executor) {
        std::uint64_t rays = 0;
        for (const Counter& counter : executor.counters().all())
            if (counter.name.starts_with("rays.") && counter.name != "rays.visibility")
                rays += counter.value;
        return rays;
    }

    Table1Row measure(Executor& refined, Executor& traced, uvec2 size, uint samples,
                      const ChosenView& view) {
        console_.err << "measuring " << size.x << "x" << size.y << ", " << samples << " samples, "
                     << view.camera.name << "\n";
        const Camera camera = makeCamera(view.camera);
        Table1Row row{.size = size, .samples = samples, .view = view};
        std::map<Table1Share, std::vector<double>> stage_ms;
        std::map<std::string, std::vector<double>> pass_ms;
        for (Executor* executor : {&refined, &traced})
            executor->setExtent(size);
        const auto refine = [&] {
            runMoved(refined, camera);
            std::map<Table1Share, double> now;
            for (const NodeReport& node : refined.nodes()) {
                now[shareOf(node.type)] += node.ms;
                pass_ms[node.name].push_back(node.ms);
            }
            for (const auto& [share, share_ms] : now)
                stage_ms[share].push_back(share_ms);
        };
        const std::function<void()> contenders[] = {refine, [&] { runMoved(traced, camera); }};
        const std::vector<std::vector<double>> ms = interleave(arguments_.repeats, contenders);

        row.error_share = static_cast<double>(refined.counters().get("error_pixels")) /
                          (static_cast<double>(size.x) * size.y);
        row.f_c = static_cast<double>(raysOf(refined)) / static_cast<double>(raysOf(traced));
        row.sir_ms = median(ms[0]);
        row.prt_ms = median(ms[1]);
        row.ratio = medianRatio(ms[0], ms[1]);
        const auto part = [&](Table1Share share) { return median(stage_ms[share]) / row.prt_ms; };
        row.raster_share = part(Table1Share::kRaster);
        row.metric_share = part(Table1Share::kMetric);
        row.sort_share = part(Table1Share::kSort);
        for (const NodeReport& node : refined.nodes())
            row.passes.emplace_back(node.name, median(pass_ms[node.name]));
        return row;
    }

    const BenchTable1Arguments& arguments_;
    const Console& console_;
    Session session_; // owns the devices: before executors, which must go first
    Devices devices_;
    unsigned moves_ = 0;
    Table1 table_;
};

} // namespace

int benchTable1(const BenchTable1Arguments& arguments, const Console& console) {
    BenchTable1Arguments chosen = arguments;
    if (chosen.scene.empty())
        chosen.scene = defaultBenchScene();
    const Table1 table = Table1Bench(chosen, console).run();
    if (chosen.json)
        print(console.out, table.json());
    else
        table.print(console.out);
    return table.allMet() ? kOk : kTargetNotMet;
}

} // namespace hone::cli

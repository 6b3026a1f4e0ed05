// SPDX-License-Identifier: Apache-2.0
//
// hone bench parts: each part of a refinement beside its bare counterpart, in one run.
//
// All parts run inside their graphs, timed by the executor: sir.json with a few passes more (a
// second sort, a tone mapping, the bare draw), prt.json, and sir.json in batches. Between frames
// the counterparts run over the same rays, errors and bytes. A frame and its counterparts make a
// round; ratios are medians over rounds, because the speed of a machine drifts.
#include "hone/backends/embree/bare_embree.h"
#include "hone/backends/embree/embree_backend.h"
#include "hone/cli/allocation_count.h"
#include "hone/cli/bench_baselines.h"
#include "hone/cli/bench_clock.h"
#include "hone/cli/bench_graph.h"
#include "hone/cli/bench_passes.h"
#include "hone/cli/bench_table.h"
#include "hone/cli/bench_tracer.h"
#include "hone/cli/commands.h"
#include "hone/cli/json.h"
#include "hone/cli/session.h"

#include "hone/core/error.h"
#include "hone/core/graph/executor.h"
#include "hone/passes/passes.h"

#include <algorithm>
#include <map>
#include <ostream>

namespace hone::cli {
namespace {

constexpr double kTraceTarget = 0.8;
constexpr double kVisibilityTarget = 1.5;
constexpr double kStreamingTarget = 2.0;
constexpr double kBatchTarget = 1.5;
constexpr double kPrtTarget = 2.0;
constexpr double kSortingTarget = 1.3; ///< of the bare loops' share

class PartsBench {
public:
    PartsBench(const BenchPartsArguments& arguments, const Console& console)
        : arguments_(arguments), console_(console), scene_(loadScene(arguments.scene)),
          camera_(makeCamera(scene_.camera(arguments.camera))), bare_(scene_) {
        registerPasses(passes_);
        passes_.add(benchVisibilityPass());
        passes_.add(benchDepthOnlyPass());
        passes_.add(benchNoisePass());
        tracers_.add("embree", "Embree on all cores", [this](const Devices&) {
            return makeRecordingTracer(makeEmbreeBackend(), rays_);
        });
        const Devices devices = session_.openDevices("", false);
        const Catalog catalog{&passes_, &tracers_};
        frame_ = std::make_unique<Executor>(makeBenchGraph(catalog), catalog, devices);
        frame_->setParameter("batch", "0");
        batches_ = std::make_unique<Executor>(
            loadGraph(findGraph("sir"), catalog, {{"batch", std::to_string(kBenchBatch)}}), catalog,
            devices);
        traced_ = std::make_unique<Executor>(
            loadGraph(findGraph("prt"), catalog, {{"refine.trace.max_depth", "0"}}), catalog,
            devices);
        for (Executor* executor : {frame_.get(), batches_.get(), traced_.get()})
            executor->setScene(scene_);
    }

    BenchTable run() {
        for (const uvec2 size : arguments_.sizes) {
            size_ = size;
            for (Executor* executor : {frame_.get(), batches_.get(), traced_.get()})
                executor->setExtent(size);
            console_.err << "measuring " << scene_.name << " at " << size.x << " x " << size.y
                         << "\n";
            benchFrame();
            benchRays();
            benchTracedFrame();
            benchBatches();
            benchAllocations();
        }
        return std::move(table_);
    }

private:
    /// Runs with a camera a little beside the last one, so that everything that depends on it runs
    /// again.
    double runMoved(Executor& executor) {
        Camera camera = camera_;
        camera.position += 1e-4f * static_cast<float>(++moves_ % 2) * camera.right;
        rays_.eye = camera.position;
        executor.setCamera(camera);
        return elapsedMs([&] { executor.run(); });
    }

    static double msOf(const Executor& executor, std::string_view node) {
        for (const NodeReport& report : executor.nodes())
            if (report.name == node)
                return report.ms;
        throw std::logic_error("the bench graph has no node " + std::string(node));
    }

    BenchPart& add(std::string name, std::span<const double> ms, double work, std::string unit) {
        const double middle = median({ms.begin(), ms.end()});
        table_.parts.push_back(
            {std::move(name), size_, middle, middle > 0 ? work / middle : 0, std::move(unit), {}});
        return table_.parts.back();
    }

    [[nodiscard]] double pixels() const { return static_cast<double>(size_.x) * size_.y; }

    /// Raster, sorting and streaming passes: whole frames, each followed by the bare loops.
    void benchFrame() {
        static constexpr const char* kStreaming[] = {
            "combine",           "shadow",        "reflection", "tonemap", "refine.blend",
            "refine.accumulate", "refine.request"};
        runMoved(*frame_);
        std::vector<StreamLoop> loops;
        for (const char* node : kStreaming)
            loops.emplace_back(trafficOf(frame_->graph(), node, std::size_t{size_.x} * size_.y));
        StandardSort standard_sort;

        std::map<std::string, std::vector<double>> ms;
        for (int round = -1; round < arguments_.repeats; ++round) {
            runMoved(*frame_);
            std::map<std::string, double> now;
            for (const NodeReport& node : frame_->nodes())
                now[node.name] = node.ms;
            for (std::size_t k = 0; k < loops.size(); ++k)
                now[std::string("bare ") + kStreaming[k]] = elapsedMs([&] { loops[k].run(); });

            standard_sort.setErrors(frame_->output("noise").as<vec2>());
            now["std::sort"] = elapsedMs([&] { standard_sort.run(); });
            if (round >= 0)
                for (const auto& [name, value] : now)
                    ms[name].push_back(value);
        }

        const double triangles = static_cast<double>(scene_.instancedTriangles()) / 1e3;
        add("raster", ms["raster"], pixels() / 1e3, "Mpixel/s");
        add("visibility", ms["visibility"], triangles, "Mtri/s").ratio = {
            "visibility_vs_depth_only", medianRatio(ms["visibility"], ms["depth_only"]),
            kVisibilityTarget};
        add("bare depth only", ms["depth_only"], triangles, "Mtri/s");
        const SortingShares shares = bareSortingShares(size_);
        add("select", ms["select"], pixels() / 1e3, "Mpixel/s").ratio = {
            "select_vs_std_sort", medianRatio(ms["select"], ms["std::sort"]),
            kSortingTarget * shares.select};
        add("radix", ms["radix"], pixels() / 1e3, "Mpixel/s").ratio = {
            "radix_vs_std_sort", medianRatio(ms["radix"], ms["std::sort"]),
            kSortingTarget * shares.radix};
        add("bare std::sort", ms["std::sort"], pixels() / 1e3, "Mpixel/s");
        for (std::size_t k = 0; k < loops.size(); ++k) {
            const std::string name = kStreaming[k];
            const std::string bare = "bare " + name;
            add(name, ms[name], loops[k].bytes() / 1e6, "GB/s").ratio = {
                "streaming/" + name.substr(name.find('.') + 1), medianRatio(ms[name], ms[bare]),
                kStreamingTarget};
            add(bare, ms[bare], loops[k].bytes() / 1e6, "GB/s");
        }
    }

    /// The frame's rays of each kind: the backend against packets without anything around them.
    void benchRays() {
        rays_.clear();
        rays_.keeps_rays = true;
        runMoved(*frame_);
        rays_.keeps_rays = false;
        const TraceBackend& backend = frame_->tracers().get("auto", *frame_->find("$scene"));
        for (const RayList* list : rays_.lists()) {
            if (list->rays.empty())
                continue;
            std::vector<Hit> hits(list->is_occlusion ? 0 : list->rays.size());
            std::vector<uint> occluded(list->is_occlusion ? list->rays.size() : 0);
            const auto bare = [&](Coherence coherence) {
                return [&, coherence] {
                    if (list->is_occlusion)
                        bare_.occluded(list->rays, occluded, coherence);
                    else
                        bare_.closest(list->rays, hits, coherence);
                };
            };
            const std::function<void()> contenders[] = {
                [&] {
                    if (list->is_occlusion)
                        backend.occluded(list->rays, occluded, list->coherence, {});
                    else
                        backend.closest(list->rays, hits, list->coherence, {});
                },
                bare(Coherence::kCoherent), bare(Coherence::kIncoherent)};
            const std::vector<std::vector<double>> ms = interleave(arguments_.repeats, contenders);
            // The faster flag is the one to beat.
            const std::vector<double>& best = median(ms[1]) <= median(ms[2]) ? ms[1] : ms[2];
            const double mrays = static_cast<double>(list->rays.size()) / 1e3;
            const std::string kind = list->kind;
            add("trace " + kind, ms[0], mrays, "Mray/s").ratio = {
                "trace_vs_embree/" + kind, medianRatio(best, ms[0]), kTraceTarget, true};
            add("bare " + kind + ", coherent", ms[1], mrays, "Mray/s");
            add("bare " + kind + ", incoherent", ms[2], mrays, "Mray/s");
        }
    }

    /// prt.json without mirrors against its primary and shadow rays alone.
    void benchTracedFrame() {
        rays_.clear();
        rays_.keeps_rays = true;
        runMoved(*traced_);
        rays_.keeps_rays = false;
        std::vector<Hit> hits(rays_.primary.rays.size());
        std::vector<uint> occluded(rays_.shadow.rays.size());
        const std::function<void()> contenders[] = {
            [&] { runMoved(*traced_); },
            [&] {
                bare_.closest(rays_.primary.rays, hits, Coherence::kCoherent);
                bare_.occluded(rays_.shadow.rays, occluded, Coherence::kCoherent);
            }};
        const std::vector<std::vector<double>> ms = interleave(arguments_.repeats, contenders);
        add("prt, primary and shadow", ms[0], pixels() / 1e3, "Mpixel/s").ratio = {
            "prt_vs_rays", medianRatio(ms[0], ms[1]), kPrtTarget};
        add("bare rays of prt", ms[1], static_cast<double>(hits.size() + occluded.size()) / 1e3,
            "Mray/s");
    }

    /// sir.json in batches: an iteration against the time that its trace pass spends on rays and
    /// shading.
    void benchBatches() {
        std::vector<double> batch_ms, trace_ms, rays_ms;
        for (int round = -1; round < arguments_.repeats; ++round) {
            rays_.clear();
            runMoved(*batches_);
            const std::vector<LoopRecord>& records = batches_->output("curve").curve->records;
            if (round < 0 || records.empty())
                continue;
            const double count = static_cast<double>(records.size());
            batch_ms.push_back(records.back().ms / count);
            trace_ms.push_back(msOf(*batches_, "refine.trace") / count);
            rays_ms.push_back(rays_.ms / count);
        }
        const double batch_pixels = std::min<double>(kBenchBatch, pixels());
        add("batch of 8192", batch_ms, batch_pixels / 1e3, "Mpixel/s").ratio = {
            "batch_vs_rays", medianRatio(batch_ms, trace_ms), kBatchTarget};
        add("rays and shading of batch", trace_ms, batch_pixels / 1e3, "Mpixel/s");
        add("rays of batch", rays_ms, batch_pixels / 1e3, "Mpixel/s");
    }

    /// What runs allocate once nothing grows any more.
    void benchAllocations() {
        std::uint64_t most = 0;
        std::vector<double> ms;
        for (Executor* executor : {batches_.get(), traced_.get()})
            for (int round = 0; round < 4; ++round) {
                const std::uint64_t before = allocationCount();
                const double passed = runMoved(*executor);
                if (round >= 2)
                    most = std::max(most, allocationCount() - before);
                ms.push_back(passed);
            }
        add("steady run", ms, static_cast<double>(most), "").ratio = {"steady_allocations",
                                                                      static_cast<double>(most), 0};
        table_.parts.back().rate = 0;
    }

    const BenchPartsArguments& arguments_;
    const Console& console_;
    PassRegistry passes_;
    TraceBackendRegistry tracers_;
    RayRecord rays_;
    Session session_{arguments_.plugins}; // owns the devices: before executors, which must go first
    Scene scene_;
    Camera camera_;
    BareEmbree bare_;
    std::unique_ptr<Executor> frame_;   ///< sir.json and more, all pixels in one batch
    std::unique_ptr<Executor> batches_; ///< sir.json in batches
    std::unique_ptr<Executor> traced_;  ///< prt.json, no mirrors
    uvec2 size_{0, 0};
    unsigned moves_ = 0;
    BenchTable table_;
};

} // namespace

int benchParts(const BenchPartsArguments& arguments, const Console& console) {
    BenchPartsArguments chosen = arguments;
    if (chosen.scene.empty())
        chosen.scene = defaultBenchScene();
    PartsBench bench(chosen, console);
    const BenchTable table = bench.run();
    if (chosen.json)
        print(console.out, table.json());
    else
        table.print(console.out);
    return table.allMet() ? kOk : kTargetNotMet;
}

} // namespace hone::cli

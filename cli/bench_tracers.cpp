// SPDX-License-Identifier: Apache-2.0
//
// hone bench tracers: every trace backend on the same rays, by kind, in one run.
//
// The rays are those of one frame of prt.json. A backend that is too slow for all of them gets a
// sample of whole blocks spread evenly over each list; a frame's time is then extrapolated. Lists
// lie in the device's memory, as in a graph. Rounds go through all backends in turn, because the
// speed of a machine drifts.
#include "hone/cli/bench_clock.h"
#include "hone/cli/bench_graph.h"
#include "hone/cli/bench_tracer.h"
#include "hone/cli/commands.h"
#include "hone/cli/json.h"
#include "hone/cli/session.h"

#include "hone/core/error.h"
#include "hone/core/graph/executor.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ostream>

namespace hone::cli {
namespace {

using Json = nlohmann::ordered_json;

/// Rays that stay together in a sample: whole tiles of whole packets.
constexpr std::size_t kBlock = 1024;
constexpr double kMsPerKind = 1500; ///< a backend's sample takes about so long at most

/// Blocks of `list`, spread evenly, about `count` rays in all.
std::vector<Ray> sampleOf(const std::vector<Ray>& list, std::size_t count) {
    const std::size_t blocks = (list.size() + kBlock - 1) / kBlock;
    const std::size_t taken = std::clamp<std::size_t>(count / kBlock, 1, blocks);
    std::vector<Ray> sample;
    for (std::size_t k = 0; k < taken; ++k) {
        const std::size_t begin = (k * blocks / taken) * kBlock;
        const std::size_t end = std::min(begin + kBlock, list.size());
        sample.insert(sample.end(), list.begin() + static_cast<std::ptrdiff_t>(begin),
                      list.begin() + static_cast<std::ptrdiff_t>(end));
    }
    return sample;
}

/// Rays of a kind in a device's memory, and answers.
class DeviceList {
public:
    DeviceList(Device& device, const RayList& kind, std::vector<Ray> rays)
        : kind_(&kind), rays_(device.createBuffer(rays.size() * sizeof(Ray), kind.kind)),
          answers_(device.createBuffer(rays.size() * sizeof(Hit), kind.kind)), count_(rays.size()) {
        std::memcpy(rays_.view().data, rays.data(), rays.size() * sizeof(Ray));
    }

    void ask(const TraceBackend& backend) const {
        const std::span<const Ray> rays = rays_.as<Ray>().first(count_);
        if (kind_->is_occlusion)
            backend.occluded(rays, answers_.as<uint>().first(count_), kind_->coherence, {});
        else
            backend.closest(rays, answers_.as<Hit>().first(count_), kind_->coherence, {});
    }
    [[nodiscard]] std::size_t count() const { return count_; }
    /// How many of the last answers are not those that `other` gave.
    [[nodiscard]] std::size_t differing(const TraceBackend& other) const {
        const std::size_t stride = kind_->is_occlusion ? sizeof(uint) : sizeof(Hit);
        const std::vector<std::byte> mine(answers_.view().data,
                                          answers_.view().data + count_ * stride);
        ask(other);
        std::size_t differing = 0;
        for (std::size_t i = 0; i < count_; ++i)
            differing += std::memcmp(mine.data() + i * stride, answers_.view().data + i * stride,
                                     stride) != 0;
        return differing;
    }

private:
    const RayList* kind_;
    Buffer rays_, answers_;
    std::size_t count_;
};

/// What one backend did with one kind of rays.
struct KindResult {
    const RayList* kind = nullptr;
    std::unique_ptr<DeviceList> sample;
    std::vector<double> ms;
    std::size_t differing = 0; ///< from the first backend's answers

    [[nodiscard]] double mraysPerSecond() const {
        return static_cast<double>(sample->count()) / median(ms) / 1e3;
    }
    [[nodiscard]] double frameMs() const {
        return static_cast<double>(kind->rays.size()) / mraysPerSecond() / 1e3;
    }
};

struct Contender {
    std::string name;
    std::unique_ptr<TraceBackend> backend;
    BuildStats stats;
    std::vector<KindResult> kinds;

    [[nodiscard]] double tracingMs() const {
        double sum = 0;
        for (const KindResult& result : kinds)
            sum += result.frameMs();
        return sum;
    }
};

class TracersBench {
public:
    TracersBench(const BenchTracersArguments& arguments, const Console& console)
        : arguments_(arguments), console_(console), session_(arguments.plugins),
          scene_(loadScene(arguments.scene.empty() ? defaultBenchScene() : arguments.scene)),
          devices_(session_.openDevices("", false)) {}

    Json run() {
        recordFrame();
        openContenders();
        for (Contender& contender : contenders_)
            chooseSamples(contender);
        for (int round = 0; round < arguments_.repeats; ++round)
            for (Contender& contender : contenders_)
                for (KindResult& result : contender.kinds)
                    result.ms.push_back(elapsedMs([&] { result.sample->ask(*contender.backend); }));
        for (Contender& contender : contenders_)
            for (KindResult& result : contender.kinds) {
                result.sample->ask(*contender.backend);
                result.differing = result.sample->differing(*contenders_.front().backend);
            }
        return report();
    }

private:
    /// One frame of prt.json by the first backend that there is: its rays, and what it costs
    /// besides them.
    void recordFrame() {
        TraceBackendRegistry recording;
        const std::string first = arguments_.backends.empty() ? session_.traceBackends().preferred()
                                                              : arguments_.backends.front();
        requireKnown(first);
        recording.add(first, "", [&](const Devices& devices) {
            return makeRecordingTracer(session_.traceBackends().create(first, devices), rays_);
        });
        const Catalog catalog{&session_.passes(), &recording};
        Executor executor(loadGraph(findGraph("prt"), catalog, {}), catalog, devices_);
        Camera camera = makeCamera(scene_.camera(arguments_.camera));
        executor.setScene(scene_);
        executor.setExtent(arguments_.size);
        std::vector<double> other_ms;
        for (int round = -1; round <= arguments_.repeats; ++round) {
            rays_.clear();
            rays_.eye = camera.position;
            rays_.keeps_rays = round == arguments_.repeats;
            executor.setCamera(camera);
            const double frame_ms = elapsedMs([&] { executor.run(); });
            // Keeping the rays takes time of its own.
            if (round >= 0 && !rays_.keeps_rays)
                other_ms.push_back(frame_ms - rays_.ms);
            camera.position += 1e-4f * camera.right;
        }
        other_ms_ = median(other_ms);
    }

    void requireKnown(const std::string& name) const {
        if (!session_.traceBackends().contains(name))
            throw InputError("no trace backend is called " + name + "; hone doctor lists them");
    }

    void openContenders() {
        std::vector<std::string> names = arguments_.backends;
        const bool is_choice = !names.empty();
        if (!is_choice)
            names = session_.traceBackends().names();
        for (const std::string& name : names) {
            requireKnown(name);
            Contender contender;
            contender.name = name;
            try {
                contender.backend = session_.traceBackends().create(name, devices_);
                const TraceCaps caps = contender.backend->caps();
                // A name that stands for another one's tracer would be measured twice.
                if (!is_choice && (caps.is_reference || caps.name != name))
                    continue;
                console_.err << "building " << name << "\n";
                contender.stats = contender.backend->build(scene_);
            } catch (const DeviceError& problem) {
                if (is_choice)
                    throw;
                console_.err << name << " is left out: " << problem.what() << "\n";
                continue;
            }
            contenders_.push_back(std::move(contender));
        }
    }

    /// As many rays as a backend answers in the time that it gets; found by a small sample first,
    /// which warms it up, too.
    void chooseSamples(Contender& contender) {
        console_.err << "warming up " << contender.name << "\n";
        for (const RayList* kind : rays_.lists()) {
            if (kind->rays.empty())
                continue;
            DeviceList probe(devices_.memory(), *kind, sampleOf(kind->rays, 4 * kBlock));
            probe.ask(*contender.backend);
            const double ms = elapsedMs([&] { probe.ask(*contender.backend); });
            const double affordable = static_cast<double>(probe.count()) * kMsPerKind / ms;
            const std::size_t count =
                std::min(static_cast<std::size_t>(affordable), kind->rays.size());
            KindResult& result = contender.kinds.emplace_back();
            result.kind = kind;
            result.sample =
                std::make_unique<DeviceList>(devices_.memory(), *kind, sampleOf(kind->rays, count));
        }
    }

    [[nodiscard]] Json report() const {
        Json rows = Json::array();
        for (const Contender& contender : contenders_) {
            const TraceCaps caps = contender.backend->caps();
            const double frame_ms = contender.tracingMs() + other_ms_;
            Json kinds = Json::array();
            for (std::size_t k = 0; k < contender.kinds.size(); ++k) {
                const KindResult& result = contender.kinds[k];
                const KindResult& first = contenders_.front().kinds[k];
                kinds.push_back({{"kind", result.kind->kind},
                                 {"rays", result.kind->rays.size()},
                                 {"sampled", result.sample->count()},
                                 {"mrays_per_s", result.mraysPerSecond()},
                                 {"relative", result.mraysPerSecond() / first.mraysPerSecond()},
                                 {"frame_ms", result.frameMs()},
                                 {"frame_share", result.frameMs() / frame_ms},
                                 {"differing", result.differing}});
            }
            rows.push_back({{"backend", contender.name},
                            {"version", caps.version},
                            {"runs_on", caps.runs_on},
                            {"build_ms", contender.stats.ms},
                            {"bytes", contender.stats.bytes},
                            {"frame_ms", frame_ms},
                            {"kinds", kinds}});
        }
        return {{"scene", scene_.name},
                {"size", {arguments_.size.x, arguments_.size.y}},
                {"rest_ms", other_ms_},
                {"backends", rows}};
    }

    const BenchTracersArguments& arguments_;
    const Console& console_;
    Session session_; // owns the devices: before what lives on them
    Scene scene_;
    Devices devices_;
    RayRecord rays_;
    double other_ms_ = 0; ///< of a frame, besides its rays
    std::vector<Contender> contenders_;
};

void printTable(const Json& report, std::ostream& out) {
    const auto line = [&out](const char* pattern, auto... values) {
        char buffer[256];
        std::snprintf(buffer, sizeof buffer, pattern, values...);
        out << buffer;
    };
    line("%-20s %-14s %9s %9s %9s %9s %9s %7s %10s\n", "backend", "rays", "in frame", "sampled",
         "Mray/s", "relative", "frame ms", "share", "differing");
    for (const Json& row : report["backends"]) {
        std::string name = row["backend"];
        for (const Json& kind : row["kinds"]) {
            line("%-20s %-14s %9zu %9zu %9.3f %9.4f %9.1f %6.1f%% %10zu\n", name.c_str(),
                 kind["kind"].get<std::string>().c_str(), kind["rays"].get<std::size_t>(),
                 kind["sampled"].get<std::size_t>(), kind["mrays_per_s"].get<double>(),
                 kind["relative"].get<double>(), kind["frame_ms"].get<double>(),
                 100 * kind["frame_share"].get<double>(), kind["differing"].get<std::size_t>());
            name.clear();
        }
        line("%-20s %-14s %49.1f %6.1f%%   built in %.0f ms, %.1f MB\n", "", "(the rest)",
             report["rest_ms"].get<double>(),
             100 * report["rest_ms"].get<double>() / row["frame_ms"].get<double>(),
             row["build_ms"].get<double>(), row["bytes"].get<double>() / 1e6);
    }
}

} // namespace

int benchTracers(const BenchTracersArguments& arguments, const Console& console) {
    const Json report = TracersBench(arguments, console).run();
    if (arguments.json)
        print(console.out, report);
    else
        printTable(report, console.out);
    return kOk;
}

} // namespace hone::cli

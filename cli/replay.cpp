// SPDX-License-Identifier: Apache-2.0
//
// hone replay: asks trace backends again what a run asked (hone render --record), and holds their
// answers against the recorded ones.
#include "hone/cli/bench_clock.h"
#include "hone/cli/check_report.h"
#include "hone/cli/commands.h"
#include "hone/cli/json.h"
#include "hone/cli/session.h"

#include "hone/core/error.h"
#include "hone/core/printable.h"
#include "hone/core/trace/check/query_kind.h"
#include "hone/core/trace/record/trace_recording.h"

#include <algorithm>
#include <iomanip>
#include <map>
#include <ostream>
#include <set>

namespace hone::cli {
namespace {

using Json = nlohmann::ordered_json;

/// Linear backends take hours beyond this many triangles times rays.
constexpr double kReferenceWork = 1e10;

/// What one backend did with the queries of one kind.
struct KindResult : DifferenceCounts {
    std::uint64_t rays = 0;
    double ms = 0;
    [[nodiscard]] double mraysPerSecond() const {
        return ms > 0 ? static_cast<double>(rays) / ms / 1000 : 0;
    }
};

struct BackendResult {
    std::string name;
    std::string problem; ///< why it did not run; "" if it did
    TraceCaps caps;
    double build_ms = 0;
    KindResult closest, occluded;
    std::string first_unexplained;
};

/// The queries of a recording that this scene can answer: those of tracers that were built for it.
struct Work {
    std::string scene_name;
    std::vector<const RecordedJob*> jobs;
    std::uint64_t rays = 0;
    std::size_t left_out = 0; ///< queries on other scenes
    std::string recorded_by;  ///< the first backend's name
};

/// The scene that most rays were about: passes may ask about scenes of their own, too.
std::string mainScene(const TraceRecording& recording) {
    std::map<uint, std::string> scene_of; // tracer
    std::map<std::string, std::uint64_t> rays;
    for (const RecordedJob& job : recording.jobs) {
        if (job.kind == JobKind::kBuild)
            scene_of[job.tracer] = job.scene;
        rays[scene_of[job.tracer]] += job.rays.size();
    }
    const auto most =
        std::ranges::max_element(rays, {}, [](const auto& entry) { return entry.second; });
    return most == rays.end() ? "" : most->first;
}

Work selectWork(const TraceRecording& recording, const Scene& scene) {
    Work work;
    const std::uint64_t hash = traceHash(scene);
    std::set<uint> tracers; // built for this scene when they were last built
    for (const RecordedJob& job : recording.jobs) {
        if (job.kind == JobKind::kBuild) {
            tracers.erase(job.tracer);
            if (job.scene_hash != hash)
                continue;
            tracers.insert(job.tracer);
            if (work.recorded_by.empty())
                work.recorded_by = job.backend;
        }
        if (!tracers.contains(job.tracer)) {
            ++work.left_out;
            continue;
        }
        work.rays += job.rays.size();
        work.jobs.push_back(&job);
    }
    return work;
}

/// Asks one backend everything, in lists that lie where it reads them without copies.
class Replay {
public:
    Replay(Scene scene, Device& memory, BackendResult& result)
        : scene_(std::move(scene)), home_(scene_.instances.begin(), scene_.instances.end()),
          explainer_(scene_), memory_(memory), result_(result) {}

    void run(TraceBackend& backend, const Work& work) {
        for (const RecordedJob* job : work.jobs)
            switch (job->kind) {
            case JobKind::kBuild:
                bringHome();
                result_.build_ms += backend.build(scene_).ms;
                break;
            case JobKind::kUpdate:
                move(backend, *job);
                break;
            case JobKind::kClosest:
                ask<ClosestKind>(backend, *job, job->hits, result_.closest);
                break;
            case JobKind::kOccluded:
                ask<OccludedKind>(backend, *job, job->occluded, result_.occluded);
                break;
            case JobKind::kEnd:
                break;
            }
    }

private:
    /// Instances where the scene's file has them.
    void bringHome() {
        for (uint i = 0; i < home_.size(); ++i)
            if (scene_.instances[i].to_world != home_[i].to_world)
                moveInstance(scene_, i, home_[i].to_world);
    }

    void move(TraceBackend& backend, const RecordedJob& job) {
        std::vector<uint> moved;
        for (const MovedInstance& place : job.moved) {
            if (place.instance >= scene_.instances.size())
                throw InputError("the recording moves instance " + std::to_string(place.instance) +
                                 ", which the scene does not have");
            moveInstance(scene_, place.instance, place.to_world);
            moved.push_back(place.instance);
        }
        result_.build_ms += backend.update(moved).ms;
    }

    template <class T> std::span<T> room(Buffer& buffer, std::size_t count, const char* name) {
        if (buffer.bytes() < count * sizeof(T))
            buffer = memory_.createBuffer(count * sizeof(T), name);
        return buffer.as<T>().first(count);
    }

    template <class Kind>
    void ask(const TraceBackend& backend, const RecordedJob& job,
             std::span<const typename Kind::Answer> recorded, KindResult& result) {
        const std::span<Ray> rays = room<Ray>(rays_, job.rays.size(), "replayed rays");
        const auto answers =
            room<typename Kind::Answer>(answers_, job.rays.size(), "replayed answers");
        std::ranges::copy(job.rays, rays.begin());
        std::ranges::fill(answers, Kind::kUnwritten);
        result.rays += rays.size();
        result.ms +=
            elapsedMs([&] { Kind::ask(backend, rays, answers, job.coherence, job.options); });
        const auto wrong = compareAnswers<Kind>(explainer_, rays, recorded, answers, result);
        if (wrong && result_.first_unexplained.empty())
            result_.first_unexplained =
                std::string(Kind::kName) + " " + std::to_string(wrong->ray) + " of " +
                std::to_string(rays.size()) + ":\n" +
                describeDifference<Kind>(scene_, rays[wrong->ray], wrong->difference, "recorded",
                                         recorded[wrong->ray], result_.name, answers[wrong->ray]);
    }

    Scene scene_;
    std::vector<Instance> home_;
    DifferenceExplainer explainer_;
    Device& memory_;
    Buffer rays_, answers_;
    BackendResult& result_;
};

BackendResult replayOn(const std::string& name, const Session& session, const Devices& devices,
                       const Scene& scene, const Work& work, bool is_one_of_all) {
    BackendResult result;
    result.name = name;
    try {
        const std::unique_ptr<TraceBackend> backend = session.traceBackends().create(name, devices);
        result.caps = backend->caps();
        const double effort =
            static_cast<double>(scene.instancedTriangles()) * static_cast<double>(work.rays);
        if (is_one_of_all && result.caps.is_reference && effort > kReferenceWork)
            result.problem =
                "a reference, for tiny scenes: --backend " + name + " asks it all the same";
        else
            Replay(scene, devices.memory(), result).run(*backend, work);
    } catch (const DeviceError& problem) {
        result.problem = problem.what();
    }
    return result;
}

Json toJson(const KindResult& result) {
    Json json{{"rays", result.rays}, {"ms", result.ms}, {"mrays_per_s", result.mraysPerSecond()}};
    json.update(cli::toJson(static_cast<const DifferenceCounts&>(result)));
    return json;
}

Json toJson(const BackendResult& result) {
    return {{"name", result.name},
            {"version", result.caps.version},
            {"runs_on", result.caps.runs_on},
            {"problem", result.problem},
            {"build_ms", result.build_ms},
            {"closest", toJson(result.closest)},
            {"occluded", toJson(result.occluded)},
            {"first_unexplained", result.first_unexplained}};
}

void printTable(std::ostream& out, const std::vector<BackendResult>& results) {
    out << std::left << std::setw(24) << "backend" << std::setw(10) << "queries" << std::right
        << std::setw(10) << "rays" << std::setw(10) << "Mray/s" << std::setw(11) << "differing"
        << std::setw(7) << "ties" << std::setw(13) << "silhouettes" << std::setw(13)
        << "unexplained"
        << "\n";
    for (const BackendResult& result : results) {
        if (!result.problem.empty()) {
            out << std::left << std::setw(24) << result.name << result.problem << "\n";
            continue;
        }
        const auto row = [&](const char* kind, const KindResult& counts) {
            if (counts.rays > 0)
                out << std::left << std::setw(24) << result.name << std::setw(10) << kind
                    << std::right << std::setw(10) << counts.rays << std::setw(10) << std::fixed
                    << std::setprecision(2) << counts.mraysPerSecond() << std::defaultfloat
                    << std::setw(11) << counts.differing << std::setw(7) << counts.ties
                    << std::setw(13) << counts.silhouettes << std::setw(13) << counts.unexplained
                    << "\n";
        };
        row("closest", result.closest);
        row("occluded", result.occluded);
    }
}

} // namespace

int replay(const ReplayArguments& arguments, const Console& console) {
    const TraceRecording recording = readTraceRecording(arguments.file);
    const std::string scene_name = arguments.scene.empty() ? mainScene(recording) : arguments.scene;
    if (scene_name.empty())
        throw InputError(printable(arguments.file) + ": nothing was traced in the recorded run");
    const Scene scene = loadScene(scene_name);
    const Work work = selectWork(recording, scene);
    if (work.jobs.empty())
        throw InputError(printable(arguments.file) + ": was recorded with another scene than \"" +
                         printable(scene_name) +
                         "\" is now; name the right one with --scene, or record again");
    if (recording.is_cut)
        console.err << "the recording ends early, at its size limit\n";
    if (work.left_out > 0)
        console.err << work.left_out << " jobs on other scenes than \"" << printable(scene_name)
                    << "\" are left out\n";

    Session session(arguments.plugins);
    std::vector<std::string> names{arguments.backend.empty() ? work.recorded_by
                                                             : arguments.backend};
    if (arguments.backend == "all") {
        names = session.traceBackends().names();
        std::erase(names, "null"); // answers nothing, so there is nothing to compare
    } else if (names.front() == "auto") {
        names = {session.traceBackends().preferred()};
    }
    for (const std::string& name : names)
        if (!session.traceBackends().contains(name))
            throw InputError("this program has no trace backend \"" + printable(name) +
                             "\"; choose one with --backend (hone doctor lists them)");
    const Devices devices = session.openDevices(arguments.device, false);

    std::vector<BackendResult> results;
    for (const std::string& name : names)
        results.push_back(
            replayOn(name, session, devices, scene, work, arguments.backend == "all"));

    Json backends = Json::array();
    for (const BackendResult& result : results) {
        backends.push_back(toJson(result));
        if (!result.first_unexplained.empty())
            console.err << result.first_unexplained << "\n";
    }
    if (arguments.json)
        print(console.out, {{"file", arguments.file},
                            {"scene", scene_name},
                            {"recorded_by", work.recorded_by},
                            {"is_cut", recording.is_cut},
                            {"left_out", work.left_out},
                            {"backends", backends}});
    else
        printTable(console.out, results);
    const bool ran = std::ranges::any_of(
        results, [](const BackendResult& result) { return result.problem.empty(); });
    const bool differs = std::ranges::any_of(
        results, [](const BackendResult& result) { return !result.first_unexplained.empty(); });
    return differs ? kTargetNotMet : ran ? kOk : kNoDevice;
}

} // namespace hone::cli

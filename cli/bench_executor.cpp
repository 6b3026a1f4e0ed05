// SPDX-License-Identifier: Apache-2.0
//
// hone bench executor: what a graph costs besides its passes.
#include "hone/cli/allocation_count.h"
#include "hone/cli/bench_clock.h"
#include "hone/cli/commands.h"
#include "hone/cli/json.h"
#include "hone/cli/session.h"

#include <algorithm>
#include <chrono>
#include <iomanip>
#include <ostream>

namespace hone::cli {
namespace {

using Clock = std::chrono::steady_clock;

double msSince(Clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

/// A pass that adds the time it is given to a sum.
class TimedPass final : public RenderPass {
public:
    TimedPass(std::unique_ptr<RenderPass> pass, double& sum_ms)
        : pass_(std::move(pass)), sum_ms_(&sum_ms) {}
    void execute(PassContext& context) override {
        const Clock::time_point begin = Clock::now();
        pass_->execute(context);
        *sum_ms_ += msSince(begin);
    }

private:
    std::unique_ptr<RenderPass> pass_;
    double* sum_ms_;
};

/// The plane that the chain begins with, made anew for each camera.
class BenchSource final : public RenderPass {
public:
    void execute(PassContext& context) override {
        std::ranges::fill(context.out("error").as<vec2>(), vec2(context.camera().position.x));
    }
};

PassType timed(PassType type, double& sum_ms) {
    type.create = [create = std::move(type.create), &sum_ms] {
        return std::make_unique<TimedPass>(create(), sum_ms);
    };
    return type;
}

/// source -> combine -> combine -> ...
std::string chainOf(int passes) {
    std::string text =
        R"({ "hone": 2, "inputs": { "camera": "camera", "extent": "extent" }, "passes": {
        "p0": { "type": "bench.source", "in": { "camera": "$camera" } })";
    for (int i = 1; i < passes; ++i)
        text += ",\n\"p" + std::to_string(i) + R"(": { "type": "combine", "in": { "errors": [ "p)" +
                std::to_string(i - 1) + R"(.error", { "from": "p0.error", "weight": 0.5 } ] } })";
    return text + R"( }, "outputs": { "error": "p)" + std::to_string(passes - 1) + ".error\" } }";
}

} // namespace

int benchExecutor(const BenchExecutorArguments& arguments, const Console& console) {
    constexpr double kTarget = 0.01;
    Session session(arguments.plugins);
    const Devices devices = session.openDevices("none", false);
    double passes_ms = 0;
    PassRegistry passes;
    passes.add(timed(*session.passes().find("combine"), passes_ms));
    passes.add(timed(PassType("bench.source", "A plane of one number")
                         .in("camera", types::kCamera, "whose position is the number")
                         .out("error", types::kError, "the number everywhere")
                         .implementedBy<BenchSource>(Domain::kHost),
                     passes_ms));
    const Catalog catalog{.passes = &passes, .trace_backends = &session.traceBackends()};
    std::vector<Diagnostic> diagnostics;
    const GraphDesc desc = parseGraph("chain.json", chainOf(arguments.passes), diagnostics);
    Executor executor(compileOrThrow(desc, catalog, {}, std::move(diagnostics)), catalog, devices);
    executor.setExtent(arguments.size);

    std::vector<double> frames, overheads, shares;
    std::uint64_t most_allocations = 0;
    Camera camera{};
    // The first two frames make memory.
    for (int frame = 0; frame < arguments.repeats + 2; ++frame) {
        camera.position.x = static_cast<float>(frame + 1);
        executor.setCamera(camera);
        passes_ms = 0;
        const std::uint64_t allocations = allocationCount();
        const Clock::time_point begin = Clock::now();
        executor.run();
        const double frame_ms = msSince(begin);
        if (frame < 2)
            continue;
        most_allocations = std::max(most_allocations, allocationCount() - allocations);
        frames.push_back(frame_ms);
        overheads.push_back(frame_ms - passes_ms);
        shares.push_back((frame_ms - passes_ms) / frame_ms);
    }
    const double share = median(shares);
    const double overhead_ms = median(overheads);
    const bool is_met = share < kTarget && most_allocations == 0;
    const nlohmann::ordered_json report{{"size", {arguments.size.x, arguments.size.y}},
                                        {"passes", arguments.passes},
                                        {"frame_ms", median(frames)},
                                        {"overhead_ms", overhead_ms},
                                        {"overhead_share", share},
                                        {"target", kTarget},
                                        {"us_per_pass", 1000 * overhead_ms / arguments.passes},
                                        {"allocations", most_allocations},
                                        {"ok", is_met}};
    if (arguments.json)
        print(console.out, report);
    else
        console.out << std::fixed << std::setprecision(3) << arguments.passes << " passes at "
                    << arguments.size.x << "x" << arguments.size.y << ": frame " << median(frames)
                    << " ms, of which the executor " << overhead_ms << " ms ("
                    << std::setprecision(2) << 100 * share << " %, target below " << 100 * kTarget
                    << " %), " << 1000 * overhead_ms / arguments.passes
                    << " us a pass; heap allocations a frame: " << most_allocations << "\n"
                    << std::defaultfloat;
    return is_met ? kOk : kTargetNotMet;
}

} // namespace hone::cli

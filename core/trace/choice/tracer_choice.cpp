// SPDX-License-Identifier: Apache-2.0
#include "hone/core/trace/choice/tracer_choice.h"

#include "hone/core/error.h"
#include "hone/core/trace/choice/calibration.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <stdexcept>
#include <utility>
#include <vector>

namespace hone {
namespace {

/// Better ones first: the others are for where none of those is left.
enum class Rank : std::uint8_t { kGood, kSoftwareDevice, kReference };

struct Candidate {
    std::string name;
    std::unique_ptr<TraceBackend> backend;
    Rank rank = Rank::kGood;
    bool is_on_host = true;
    double rays_per_second = 0;
};

/// Those that are no use, by reason.
class LeftOut {
public:
    void add(const std::string& name, const std::string& why) {
        const auto found = std::ranges::find(reasons_, why, &Reason::why);
        if (found != reasons_.end())
            found->names += ", " + name;
        else
            reasons_.push_back({why, name});
    }
    /// "brute, null: references, for tiny scenes; vulkan.ray_query: no ray query"; "" if there are
    /// none.
    [[nodiscard]] std::string text() const {
        std::string text;
        for (const Reason& reason : reasons_)
            text += (text.empty() ? "" : "; ") + reason.names + ": " + reason.why;
        return text;
    }

private:
    struct Reason {
        std::string why, names;
    };
    std::vector<Reason> reasons_;
};

Candidate makeCandidate(const std::string& name, std::unique_ptr<TraceBackend> backend,
                        const TraceCaps& caps, const Devices& devices) {
    const bool is_software = devices.raster != nullptr && devices.raster->info().is_software &&
                             caps.runs_on == devices.raster->info().name;
    return {.name = name,
            .backend = std::move(backend),
            .rank = caps.is_reference ? Rank::kReference
                    : is_software     ? Rank::kSoftwareDevice
                                      : Rank::kGood,
            .is_on_host = is_software || caps.runs_on == "host"};
}

std::vector<Candidate> findCandidates(const TraceBackendRegistry& registry, const Devices& devices,
                                      bool masked, LeftOut& left_out) {
    std::vector<Candidate> found;
    for (const std::string& name : registry.names()) {
        try {
            std::unique_ptr<TraceBackend> backend = registry.createBare(name, devices);
            const TraceCaps caps = backend->caps();
            const bool is_alias = caps.name != name && registry.contains(caps.name);
            if (is_alias)
                continue;
            if (masked && !caps.masked)
                left_out.add(name, "sees no alpha masks");
            else
                found.push_back(makeCandidate(name, std::move(backend), caps, devices));
        } catch (const std::runtime_error& problem) { // DeviceError, OutOfMemory, PluginError
            left_out.add(name, problem.what());
        }
    }
    return found;
}

/// Keeps those of the best rank, and of several that would share the cores the first.
void keepBest(std::vector<Candidate>& candidates, LeftOut& left_out) {
    if (candidates.empty())
        return;
    const Rank best = std::ranges::min_element(candidates, {}, &Candidate::rank)->rank;
    std::string on_host;
    std::erase_if(candidates, [&](const Candidate& candidate) {
        if (candidate.rank != best) {
            left_out.add(candidate.name, candidate.rank == Rank::kReference
                                             ? "references, for tiny scenes"
                                             : "of a software device, on the same cores");
            return true;
        }
        if (!candidate.is_on_host || on_host.empty()) {
            on_host = candidate.is_on_host ? candidate.name : on_host;
            return false;
        }
        left_out.add(candidate.name, "on the same cores as " + on_host + ", which comes first");
        return true;
    });
}

/// Times them; drops those that fail.
void measure(std::vector<Candidate>& candidates, const Devices& devices, LeftOut& left_out) {
    const Calibration calibration(devices.memory());
    std::erase_if(candidates, [&](Candidate& candidate) {
        try {
            candidate.rays_per_second = calibration.raysPerSecond(*candidate.backend);
            return false;
        } catch (const std::runtime_error& problem) {
            left_out.add(candidate.name, problem.what());
            return true;
        }
    });
}

/// "embree 18.2, vulkan.ray_query 240 Mray/s"
std::string ratesOf(const std::vector<Candidate>& candidates) {
    std::string text;
    for (const Candidate& candidate : candidates) {
        std::array<char, 32> rate{};
        std::snprintf(rate.data(), rate.size(), " %.3g", candidate.rays_per_second * 1e-6);
        text += (text.empty() ? "" : ", ") + candidate.name + rate.data();
    }
    return text + " Mray/s";
}

} // namespace

bool hasMasked(const Scene& scene) {
    return std::ranges::any_of(scene.instances, [&](const Instance& instance) {
        return (scene.materials[scene.meshes[instance.mesh].material].flags & kMaterialMasked) != 0;
    });
}

TracerChoice chooseTracer(const TraceBackendRegistry& registry, const Devices& devices,
                          bool masked) {
    LeftOut left_out;
    std::vector<Candidate> candidates = findCandidates(registry, devices, masked, left_out);
    keepBest(candidates, left_out);
    const bool is_race = candidates.size() > 1;
    if (is_race)
        measure(candidates, devices, left_out);
    if (candidates.empty())
        throw DeviceError(std::string("no trace backend can trace ") +
                          (masked ? "a scene with alpha-masked materials (" : "here (") +
                          (left_out.text().empty() ? "none is registered" : left_out.text()) +
                          "); hone doctor says what to install");
    const std::string reason = candidates.size() > 1 ? "fastest of " + ratesOf(candidates)
                               : left_out.text().empty()
                                   ? "the only one there is"
                                   : "the only one fit (" + left_out.text() + ")";
    Candidate& best = *std::ranges::max_element(candidates, {}, &Candidate::rays_per_second);
    return {std::move(best.name), reason, std::move(best.backend)};
}

} // namespace hone

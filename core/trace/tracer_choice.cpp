// SPDX-License-Identifier: Apache-2.0
#include "hone/core/trace/tracer_choice.h"

#include "hone/core/error.h"
#include "hone/core/trace/calibration.h"

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
    double rays_per_second = 0;
};

Rank rankOf(const TraceCaps& caps, const Devices& devices) {
    if (caps.is_reference)
        return Rank::kReference;
    const bool is_software = devices.raster != nullptr && devices.raster->info().is_software &&
                             caps.runs_on == devices.raster->info().name;
    return is_software ? Rank::kSoftwareDevice : Rank::kGood;
}

/// Those that are no use, and why.
class LeftOut {
public:
    void add(const std::string& name, const std::string& why) {
        text_ += (text_.empty() ? "" : "; ") + name + ": " + why;
    }
    void add(const Candidate& candidate) {
        add(candidate.name, candidate.rank == Rank::kReference
                                ? "a reference, for tiny scenes"
                                : "of a software device, which runs on the same cores");
    }
    [[nodiscard]] const std::string& text() const { return text_; }

private:
    std::string text_;
};

std::vector<Candidate> findCandidates(const TraceBackendRegistry& registry, const Devices& devices,
                                      bool masked, LeftOut& left_out) {
    std::vector<Candidate> found;
    for (const std::string& name : registry.names()) {
        try {
            Candidate candidate{.name = name, .backend = registry.create(name, devices)};
            const TraceCaps caps = candidate.backend->caps();
            candidate.rank = rankOf(caps, devices);
            if (masked && !caps.masked)
                left_out.add(name, "does not honour alpha-masked materials");
            else
                found.push_back(std::move(candidate));
        } catch (const std::runtime_error& problem) { // DeviceError, OutOfMemory, PluginError
            left_out.add(name, problem.what());
        }
    }
    return found;
}

/// Keeps those of the best rank.
void keepBest(std::vector<Candidate>& candidates, LeftOut& left_out) {
    if (candidates.empty())
        return;
    const Rank best = std::ranges::min_element(candidates, {}, &Candidate::rank)->rank;
    std::erase_if(candidates, [&](const Candidate& candidate) {
        if (candidate.rank != best)
            left_out.add(candidate);
        return candidate.rank != best;
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

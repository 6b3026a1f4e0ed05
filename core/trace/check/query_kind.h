// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/trace/check/explain_difference.h"
#include "hone/core/trace/trace_backend.h"

#include <charconv>
#include <cmath>
#include <optional>
#include <span>
#include <string>

namespace hone {

/// The two kinds of queries by one spelling, for what treats both alike: checks, records, replays.
struct ClosestKind {
    using Answer = Hit;
    static constexpr const char* kName = "closest hit";
    /// Put where an answer will be, to see that it is written.
    static constexpr Hit kUnwritten{0xfffffffeu, 0xfffffffeu};

    static void ask(const TraceBackend& backend, std::span<const Ray> rays, std::span<Hit> hits,
                    Coherence coherence, const TraceOptions& options) {
        backend.closest(rays, hits, coherence, options);
    }
    static bool isSame(Hit a, Hit b) {
        return a.instance == b.instance && a.primitive == b.primitive;
    }
    /// Whether the scene has what the answer names.
    static bool isPossible(const Scene& scene, Hit hit) {
        if (isSame(hit, {kNone, kNone}))
            return true;
        return hit.instance < scene.instances.size() &&
               hit.primitive < scene.meshes[scene.instances[hit.instance].mesh].triangle_count;
    }
    static Difference explain(const DifferenceExplainer& explainer, const Ray& ray, Hit a, Hit b) {
        return explainer.explainClosest(ray, a, b);
    }
    static std::string text(const Scene& scene, Hit hit, double t = HUGE_VAL) {
        if (!std::isfinite(t))
            return nameOf(scene, hit);
        char number[32];
        return nameOf(scene, hit) + " at t = " +
               std::string(number, std::to_chars(number, number + sizeof number, t).ptr);
    }
};

struct OccludedKind {
    using Answer = uint;
    static constexpr const char* kName = "occlusion";
    static constexpr uint kUnwritten = 0xfffffffeu;

    static void ask(const TraceBackend& backend, std::span<const Ray> rays,
                    std::span<uint> occluded, Coherence coherence, const TraceOptions& options) {
        backend.occluded(rays, occluded, coherence, options);
    }
    static bool isSame(uint a, uint b) { return a == b; }
    static bool isPossible(const Scene&, uint answer) { return answer <= 1; }
    static Difference explain(const DifferenceExplainer& explainer, const Ray& ray, uint a,
                              uint b) {
        return explainer.explainOccluded(ray, a, b);
    }
    static std::string text(const Scene&, uint answer, double = HUGE_VAL) {
        return answer == 0 ? "free" : answer == 1 ? "occluded" : std::to_string(answer);
    }
};

/// How often two tracers answered otherwise.
struct DifferenceCounts {
    std::uint64_t differing = 0; ///< the next three add up to it
    std::uint64_t ties = 0;
    std::uint64_t silhouettes = 0;
    std::uint64_t unexplained = 0;
};

/// A difference that is an error, and which ray of a list it is about.
struct UnexplainedDifference {
    std::size_t ray = 0;
    Difference difference;
};

/// Holds two lists of answers to `rays` against each other, adds to `counts`, and gives the first
/// difference that rounding does not explain.
template <class Kind>
std::optional<UnexplainedDifference>
compareAnswers(const DifferenceExplainer& explainer, std::span<const Ray> rays,
               std::span<const typename Kind::Answer> a, std::span<const typename Kind::Answer> b,
               DifferenceCounts& counts) {
    std::optional<UnexplainedDifference> first;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (Kind::isSame(a[i], b[i]))
            continue;
        ++counts.differing;
        const Difference found = Kind::explain(explainer, rays[i], a[i], b[i]);
        counts.ties += found.kind == DifferenceKind::kTie ? 1 : 0;
        counts.silhouettes += found.kind == DifferenceKind::kSilhouette ? 1 : 0;
        if (found.kind != DifferenceKind::kUnexplained)
            continue;
        ++counts.unexplained;
        if (!first)
            first = {i, found};
    }
    return first;
}

/// What the ray surely meets, for a person who has to find out why an answer is wrong.
[[nodiscard]] std::string witnessText(const Scene& scene, const Difference& difference);

/// Both answers, which of them is wrong, and why: lines that are indented by two spaces.
template <class Kind>
std::string describeDifference(const Scene& scene, const Ray& ray, const Difference& difference,
                               const std::string& name_a, typename Kind::Answer a,
                               const std::string& name_b, typename Kind::Answer b) {
    return "  " + name_a + ": " + Kind::text(scene, a, difference.t_a) +
           (difference.is_a_right ? "" : "  <- wrong") + "\n  " + name_b + ": " +
           Kind::text(scene, b, difference.t_b) + (difference.is_b_right ? "" : "  <- wrong") +
           "\n  " + witnessText(scene, difference) + "\n  ray: " + toText(ray);
}

} // namespace hone

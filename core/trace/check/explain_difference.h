// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/trace/check/crossing.h"

#include <cstdint>
#include <string>

namespace hone {

/// Why two tracers answer a ray differently.
enum class DifferenceKind : std::uint8_t {
    kNone,        ///< they do not, and the answer is right
    kTie,         ///< two triangles at the same t within rounding: either is right
    kSilhouette,  ///< rounding decides whether a triangle is met (Difference::border): either is
                  ///< right
    kUnexplained, ///< one of the answers, or both, is wrong
};

/// The answers a and b to one ray, judged by geometry.
struct Difference {
    DifferenceKind kind = DifferenceKind::kNone;
    Border border = Border::kNone; ///< of a silhouette: what is within rounding
    bool is_a_right = true;        ///< or may be, within rounding
    bool is_b_right = true;
    /// Of closest hits, where the ray meets the answer's triangle; infinity for a miss, NaN where
    /// it does not meet it.
    double t_a = 0, t_b = 0;
    /// Of a wrong answer: the nearest triangle that is surely met; kNone if there is none.
    Hit witness{kNone, kNone};
    double witness_t = 0;
};

/// Tells differences between tracers that rounding explains from errors.
///
/// Each answer is held against every triangle that the ray meets (findCrossings), so it also tells
/// which of two answers is wrong, and whether one that both give is. Borrows `scene`, whose
/// instances may move meanwhile but whose arrays must stay. One ray takes microseconds in a small
/// scene, a millisecond in a large one: for rays that differ, not for all.
class DifferenceExplainer {
public:
    explicit DifferenceExplainer(const Scene& scene) : scene_(&scene), surface_(scene) {}

    [[nodiscard]] Difference explainClosest(const Ray& ray, Hit a, Hit b) const;
    /// `a` and `b`: 1 occluded, 0 not; anything else is wrong.
    [[nodiscard]] Difference explainOccluded(const Ray& ray, uint a, uint b) const;

private:
    const Scene* scene_;
    HostSurface surface_;
};

/// "instance 3 "pillar", primitive 7", or "nothing"; safe for a terminal.
[[nodiscard]] std::string nameOf(const Scene& scene, Hit hit);
/// All numbers of the ray, so that reading them gives the same bits.
[[nodiscard]] std::string toText(const Ray& ray);
[[nodiscard]] const char* name(DifferenceKind kind);
[[nodiscard]] const char* name(Border border);

} // namespace hone

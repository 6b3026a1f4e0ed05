// SPDX-License-Identifier: Apache-2.0
#include "hone/core/trace/check/explain_difference.h"

#include "hone/core/printable.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <span>

namespace hone {
namespace {

bool isSame(Hit a, Hit b) {
    return a.instance == b.instance && a.primitive == b.primitive;
}

const Crossing* find(std::span<const Crossing> crossings, Hit hit) {
    const auto found = std::ranges::find_if(
        crossings, [&](const Crossing& crossing) { return isSame(crossing.hit, hit); });
    return found == crossings.end() ? nullptr : &*found;
}

/// The latest t at which a tracer may place what it meets.
double latest(const Crossing& crossing) {
    return crossing.t + crossing.t_error;
}

/// What is surely met, and before all others; null if there is nothing.
const Crossing* nearestSure(std::span<const Crossing> crossings) {
    const Crossing* nearest = nullptr;
    for (const Crossing& crossing : crossings)
        if (crossing.border == Border::kNone &&
            (nearest == nullptr || latest(crossing) < latest(*nearest)))
            nearest = &crossing;
    return nearest;
}

/// One answer to a closest-hit ray: of no crossing it is a miss, or names what is not met.
struct Answer {
    bool is_miss = false;
    const Crossing* crossing = nullptr;

    [[nodiscard]] bool isRight(const Crossing* sure) const {
        if (is_miss)
            return sure == nullptr;
        return crossing != nullptr &&
               (sure == nullptr || crossing->t - crossing->t_error <= latest(*sure));
    }
    [[nodiscard]] double t() const {
        if (is_miss)
            return std::numeric_limits<double>::infinity();
        return crossing != nullptr ? crossing->t : std::numeric_limits<double>::quiet_NaN();
    }
};

bool areTied(const Answer& a, const Answer& b) {
    return a.crossing != nullptr && b.crossing != nullptr &&
           std::abs(a.crossing->t - b.crossing->t) <= a.crossing->t_error + b.crossing->t_error;
}

void setWitness(Difference& difference, const Crossing* sure) {
    if (sure == nullptr)
        return;
    difference.witness = sure->hit;
    difference.witness_t = sure->t;
}

} // namespace

Difference DifferenceExplainer::explainClosest(const Ray& ray, Hit a, Hit b) const {
    std::vector<Crossing> crossings = findCrossings(*scene_, surface_, ray);
    std::erase_if(crossings, [](const Crossing& crossing) { return !crossing.is_seen; });
    const Crossing* sure = nearestSure(crossings);
    const auto answer = [&](Hit hit) {
        return Answer{isSame(hit, {kNone, kNone}), find(crossings, hit)};
    };
    const Answer answer_a = answer(a), answer_b = answer(b);
    Difference difference{.is_a_right = answer_a.isRight(sure),
                          .is_b_right = answer_b.isRight(sure),
                          .t_a = answer_a.t(),
                          .t_b = answer_b.t()};
    if (!difference.is_a_right || !difference.is_b_right) {
        difference.kind = DifferenceKind::kUnexplained;
        setWitness(difference, sure);
    } else if (isSame(a, b)) {
        difference.kind = DifferenceKind::kNone;
    } else if (areTied(answer_a, answer_b)) {
        difference.kind = DifferenceKind::kTie;
    } else {
        // Both are right, so whoever did not see the nearer one had rounding's leave.
        difference.kind = DifferenceKind::kSilhouette;
        const Answer& nearer =
            answer_b.is_miss || answer_a.t() < answer_b.t() ? answer_a : answer_b;
        difference.border = nearer.crossing->border;
    }
    return difference;
}

Difference DifferenceExplainer::explainOccluded(const Ray& ray, uint a, uint b) const {
    const std::vector<Crossing> crossings = findCrossings(*scene_, surface_, ray);
    const Crossing* sure = nearestSure(crossings);
    const auto is_right = [&](uint answer) {
        return (answer == 1 && !crossings.empty()) || (answer == 0 && sure == nullptr);
    };
    Difference difference{.is_a_right = is_right(a), .is_b_right = is_right(b)};
    if (!difference.is_a_right || !difference.is_b_right) {
        difference.kind = DifferenceKind::kUnexplained;
        setWitness(difference, sure);
    } else if (a != b) {
        difference.kind = DifferenceKind::kSilhouette;
        difference.border = crossings.front().border;
    }
    return difference;
}

std::string nameOf(const Scene& scene, Hit hit) {
    if (isSame(hit, {kNone, kNone}))
        return "nothing";
    std::string text = "instance " + std::to_string(hit.instance);
    if (hit.instance < scene.instance_names.size())
        text += " \"" + printable(scene.instance_names[hit.instance]) + "\"";
    return text + ", primitive " + std::to_string(hit.primitive);
}

std::string toText(const Ray& ray) {
    const auto number = [](float value) {
        char buffer[32];
        return std::string(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
    };
    const auto vector = [&](vec3 v) {
        return "(" + number(v.x) + ", " + number(v.y) + ", " + number(v.z) + ")";
    };
    return "origin " + vector(ray.origin) + ", direction " + vector(ray.direction) + ", tmin " +
           number(ray.tmin) + ", tmax " + number(ray.tmax);
}

const char* name(DifferenceKind kind) {
    switch (kind) {
    case DifferenceKind::kNone:
        return "none";
    case DifferenceKind::kTie:
        return "tie";
    case DifferenceKind::kSilhouette:
        return "silhouette";
    case DifferenceKind::kUnexplained:
        return "unexplained";
    }
    return "?";
}

const char* name(Border border) {
    switch (border) {
    case Border::kNone:
        return "none";
    case Border::kEdge:
        return "edge";
    case Border::kGrazing:
        return "grazing";
    case Border::kRange:
        return "range";
    case Border::kMask:
        return "mask";
    }
    return "?";
}

} // namespace hone

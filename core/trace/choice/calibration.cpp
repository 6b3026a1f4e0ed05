// SPDX-License-Identifier: Apache-2.0
#include "hone/core/trace/choice/calibration.h"

#include "hone/core/scene/builtin_shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hone {
namespace {

constexpr uint kSide = 128; ///< rays of a kind are kSide * kSide
constexpr uint kRays = kSide * kSide;
constexpr uint kCells = 96;
constexpr float kWidth = 10.0f; ///< of the hills, along x and z from 0
constexpr int kRounds = 3;
constexpr double kMaxMs = 100;

vec3 onHills(float u, float v) {
    const float x = kWidth * u, z = kWidth * v;
    return {x, 0.5f * std::sin(1.7f * x) * std::cos(2.3f * z) + 0.1f * std::sin(7.0f * (x + z)), z};
}

Scene hills() {
    Scene scene;
    Shape shape;
    shape.addSheet({kCells, kCells}, vec2(1), [](float u, float v) { return onHills(v, u); });
    const uint material = addMaterial(scene, "hill", diffuse(vec3(0.5f)));
    addInstance(scene, "hills", addMesh(scene, shape, material));
    scene.name = "calibration";
    finishScene(scene);
    return scene;
}

/// A ray for each point of a grid over [0,1] x [0,1], row by row.
template <class MakeRay> Buffer makeRays(Device& memory, const MakeRay& make_ray) {
    Buffer buffer = memory.createBuffer(kRays * sizeof(Ray), "calibration");
    const std::span<Ray> rays = buffer.as<Ray>();
    for (uint i = 0; i < kRays; ++i)
        rays[i] = make_ray(i, (static_cast<float>(i % kSide) + 0.5f) / kSide,
                           (static_cast<float>(i / kSide) + 0.5f) / kSide);
    return buffer;
}

constexpr vec3 kAbove{0, 0.01f, 0}; ///< off the surface

Ray primaryRay(uint, float u, float v) {
    return {vec3(5, 3, -3), 0, vec3(1.2f * (u - 0.5f), -0.2f - 0.8f * v, 1), 1e30f};
}

Ray shadowRay(uint, float u, float v) {
    const vec3 origin = onHills(u, v) + kAbove;
    return {origin, 0, vec3(2, 4, 7) - origin, 1};
}

/// To a point of the unit sphere (Archimedes: height and longitude are uniform), upwards.
Ray scatteredRay(uint index, float, float) {
    const float height = chance(4 * index);
    const float longitude = 2 * std::numbers::pi_v<float> * chance(4 * index + 1);
    const float radius = std::sqrt(1 - height * height);
    return {onHills(chance(4 * index + 2), chance(4 * index + 3)) + kAbove, 0,
            vec3(radius * std::cos(longitude), height, radius * std::sin(longitude)), 1e30f};
}

} // namespace

Calibration::Calibration(Device& memory)
    : scene_(hills()), primary_(makeRays(memory, primaryRay)), shadow_(makeRays(memory, shadowRay)),
      scattered_(makeRays(memory, scatteredRay)),
      hits_(memory.createBuffer(kRays * sizeof(Hit), "calibration")),
      occluded_(memory.createBuffer(kRays * sizeof(uint), "calibration")) {}

/// Returns how many rays were answered.
std::size_t Calibration::traceAll(const TraceBackend& backend, TraceSlices& slices,
                                  const Interrupt& limit) const {
    ClosestQuery primary{primary_.as<Ray>(), hits_.as<Hit>(), Coherence::kCoherent};
    OccludedQuery shadow{shadow_.as<Ray>(), occluded_.as<uint>(), Coherence::kCoherent};
    ClosestQuery scattered{scattered_.as<Ray>(), hits_.as<Hit>(), Coherence::kIncoherent};
    slices.answer(backend, primary, limit);
    slices.answer(backend, shadow, limit);
    slices.answer(backend, scattered, limit);
    return primary.answered + shadow.answered + scattered.answered;
}

double Calibration::raysPerSecond(TraceBackend& backend) const {
    backend.build(scene_);
    using Clock = Interrupt::Clock;
    TraceSlices slices;
    const Interrupt limit{.deadline = deadlineAfter(Clock::now(), kMaxMs)};
    double best = 0;
    // The first round warms up, and counts where there is no time for another.
    for (int round = 0; round < kRounds && (round == 0 || !limit.isDue()); ++round) {
        const Clock::time_point begin = Clock::now();
        const auto rays = static_cast<double>(traceAll(backend, slices, limit));
        const std::chrono::duration<double> passed = Clock::now() - begin;
        best = std::max(best, rays / std::max(passed.count(), 1e-9));
    }
    return best;
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/measure_views.h"

#include "hone/core/trace/check/crossing.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hone::cli {
namespace {

/// What a coarse look through a camera finds.
struct Sight {
    std::size_t hits = 0;
    double median = 0;  ///< view depth in metres
    double nearest = 0; ///< a tenth of the hits is nearer
};

Sight look(const Scene& scene, const HostSurface& surface, const Camera& camera) {
    constexpr uvec2 kGrid{8, 6};
    constexpr double kNothing = 1e30;
    std::vector<double> depths(std::size_t{kGrid.x} * kGrid.y);
    tbb::parallel_for(0u, kGrid.x * kGrid.y, [&](uint index) {
        // From -1 to 1 across the image's height; a length of 1 along the axis, so t is depth.
        const vec2 cell(index % kGrid.x, index / kGrid.x);
        const vec2 place = (2.0f * cell + 1.0f - vec2(kGrid)) / static_cast<float>(kGrid.y);
        const Ray ray{camera.position, camera.near,
                      camera.forward +
                          camera.tan_half_fov_y * (place.x * camera.right - place.y * camera.up),
                      1e30f};
        depths[index] = kNothing;
        for (const Crossing& crossing : findCrossings(scene, surface, ray))
            if (crossing.is_seen)
                depths[index] = std::min(depths[index], crossing.t);
    });
    std::erase(depths, kNothing);
    std::ranges::sort(depths);
    if (depths.empty())
        return {};
    return {depths.size(), depths[depths.size() / 2], depths[depths.size() / 10]};
}

/// `v` turned about the unit `axis`.
vec3 turned(vec3 v, vec3 axis, double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    const auto c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
    return v * c + cross(axis, v) * s + axis * (dot(axis, v) * (1 - c));
}

MeasureView moved(const CameraDesc& camera, std::size_t step) {
    const double degrees = std::fmod(137.50776405003785 * static_cast<double>(step), 360.0);
    const bool turns = step % 2 == 1;
    MeasureView view{camera.name + (turns ? " turned " : " orbited ") +
                         std::to_string(std::lround(degrees)),
                     camera};
    const vec3 up = normalize(camera.up);
    const vec3 there = turned(camera.target - camera.position, up, degrees);
    if (turns)
        view.camera.target = camera.position + there;
    else
        view.camera.position = camera.target - there;
    view.camera.name = view.name;
    return view;
}

} // namespace

std::vector<MeasureView> chooseViews(const Scene& scene, std::size_t count) {
    std::vector<MeasureView> views;
    for (const CameraDesc& camera : scene.cameras)
        views.push_back({camera.name.empty() ? "camera" : camera.name, camera});
    const std::vector<MeasureView> own = views;
    views.resize(std::clamp<std::size_t>(count, 1, own.size()));

    const HostSurface surface(scene);
    std::vector<Sight> sights;
    for (const MeasureView& view : own)
        sights.push_back(look(scene, surface, makeCamera(view.camera)));
    // Past so many there is no view to be found.
    const std::size_t last_step = 16 * count;
    for (std::size_t step = 1; step <= last_step && views.size() < count; ++step)
        for (std::size_t k = 0; k < own.size() && views.size() < count; ++k) {
            MeasureView view = moved(own[k].camera, step);
            const Sight sight = look(scene, surface, makeCamera(view.camera));
            if (2 * sight.hits >= std::max<std::size_t>(sights[k].hits, 1) &&
                4 * sight.median >= sights[k].median && 10 * sight.nearest >= sights[k].median)
                views.push_back(std::move(view));
        }
    return views;
}

} // namespace hone::cli

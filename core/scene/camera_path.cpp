// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/camera_path.h"

#include "hone/core/error.h"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace hone {
namespace {

/// The speed of a value at a key: Catmull and Rom, A Class of Local Interpolating Splines, 1974,
/// for keys at any times; at the ends the mean speed to the only neighbour.
vec3 speedAt(const CameraPath& path, std::size_t key, vec3 CameraDesc::*value) {
    const CameraKey& before = path.keys[key == 0 ? 0 : key - 1];
    const CameraKey& after = path.keys[std::min(key + 1, path.keys.size() - 1)];
    return (after.camera.*value - before.camera.*value) / (after.time - before.time);
}

/// The cubic with the keys' values and speeds (Hermite), `share` of the way from `key` to the next.
vec3 onCurve(const CameraPath& path, std::size_t key, float share, vec3 CameraDesc::*value) {
    const CameraKey& from = path.keys[key];
    const CameraKey& to = path.keys[key + 1];
    const float seconds = to.time - from.time;
    const float s = share, s2 = s * s, s3 = s2 * s;
    return (2 * s3 - 3 * s2 + 1) * from.camera.*value +
           (s3 - 2 * s2 + s) * seconds * speedAt(path, key, value) +
           (3 * s2 - 2 * s3) * to.camera.*value +
           (s3 - s2) * seconds * speedAt(path, key + 1, value);
}

CameraPath orbit(const CameraDesc& camera) {
    constexpr int kKeys = 16;
    constexpr float kSeconds = 8;
    const vec3 axis = glm::normalize(camera.up);
    const vec3 arm = camera.position - camera.target;
    const vec3 along = glm::dot(arm, axis) * axis;
    const vec3 across = arm - along;
    CameraPath path{.name = "orbit", .keys = {}};
    for (int key = 0; key <= kKeys; ++key) {
        const float share = static_cast<float>(key) / kKeys;
        const float angle = 2 * glm::pi<float>() * share;
        CameraDesc turned = camera;
        if (key % kKeys != 0)
            turned.position = camera.target + along + std::cos(angle) * across +
                              std::sin(angle) * glm::cross(axis, across);
        path.keys.push_back({kSeconds * share, turned});
    }
    return path;
}

} // namespace

CameraDesc cameraAt(const CameraPath& path, float time) {
    HONE_ASSERT(!path.keys.empty(), "a path has at least one key");
    const auto after = std::ranges::upper_bound(path.keys, time, {}, &CameraKey::time);
    if (after == path.keys.begin())
        return path.keys.front().camera;
    const CameraKey& from = *(after - 1);
    if (after == path.keys.end() || time == from.time)
        return from.camera;
    const auto key = static_cast<std::size_t>(after - path.keys.begin()) - 1;
    const float share = (time - from.time) / (after->time - from.time);
    const auto linear = [&](float CameraDesc::*value) {
        return (1 - share) * from.camera.*value + share * after->camera.*value;
    };
    CameraDesc camera = from.camera;
    camera.position = onCurve(path, key, share, &CameraDesc::position);
    camera.target = onCurve(path, key, share, &CameraDesc::target);
    camera.up = (1 - share) * from.camera.up + share * after->camera.up;
    camera.fov_y_degrees = linear(&CameraDesc::fov_y_degrees);
    camera.near = linear(&CameraDesc::near);
    camera.aperture = linear(&CameraDesc::aperture);
    camera.focus = linear(&CameraDesc::focus);
    return camera;
}

float frameTime(const CameraPath& path, uint frame, uint frames) {
    const double first = path.keys.front().time, last = path.keys.back().time;
    if (frames < 2)
        return path.keys.front().time;
    return static_cast<float>(first + (last - first) * frame / (frames - 1));
}

CameraPath cameraPath(const Scene& scene, std::string_view name) {
    if (scene.paths.empty() && (name.empty() || name == "orbit"))
        return orbit(scene.camera(""));
    std::string names;
    for (const CameraPath& path : scene.paths) {
        if (name.empty() || path.name == name)
            return path;
        names += (names.empty() ? "" : ", ") + path.name;
    }
    throw SceneError(scene.name + " has no camera path \"" + std::string(name) + "\"; it has " +
                     (names.empty() ? "orbit" : names));
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/scene/scene.h"

#include <string_view>

namespace hone {

/// The path's camera at a time, held at the first and last key outside theirs. Exactly a key's
/// camera at its time; between keys position and target follow a cubic curve through all keys
/// (cameras pass them with the mean speed of both neighbours), the other numbers change linearly.
/// `path` has at least one key, times ascending.
[[nodiscard]] CameraDesc cameraAt(const CameraPath& path, float time);

/// When frame `frame` of `frames` is: evenly from the first key to the last, both included.
[[nodiscard]] float frameTime(const CameraPath& path, uint frame, uint frames);

/// The scene's path of that name; its first for "". A scene without any has "orbit": once around
/// the first camera's target in 8 seconds, as seen from that camera. Throws SceneError that lists
/// the names.
[[nodiscard]] CameraPath cameraPath(const Scene& scene, std::string_view name);

} // namespace hone

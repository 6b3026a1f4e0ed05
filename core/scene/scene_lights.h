// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/scene/scene.glsl.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace hone {

/// A light of a scene file, as scene_file.h describes them; `pointer` is its place. Throws
/// SceneError.
[[nodiscard]] Light readSceneLight(const std::string& file, const nlohmann::json& json,
                                   const std::string& pointer);

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/scene/scene.h"

namespace hone {

/// A scene that needs no file, finished. The same name gives the same scene, bit for bit. Throws
/// SceneError that lists the names (builtinScenes) for an unknown one.
[[nodiscard]] Scene makeBuiltinScene(std::string_view name);

// Each builds one scene; makeBuiltinScene finishes it. What is in it stands above its definition.

[[nodiscard]] Scene atriumScene();
[[nodiscard]] Scene cornellScene();

[[nodiscard]] Scene mirrorSphereScene();
[[nodiscard]] Scene planarMirrorScene();
[[nodiscard]] Scene straightEdgeScene();
[[nodiscard]] Scene litFloorScene();
[[nodiscard]] Scene emptyScene();
[[nodiscard]] Scene oneTriangleScene();
[[nodiscard]] Scene alphaQuadScene();
[[nodiscard]] Scene twoSidedScene();

} // namespace hone

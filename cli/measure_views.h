// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/scene/scene.h"

#include <string>
#include <vector>

namespace hone::cli {

/// A place to judge from.
struct MeasureView {
    std::string name; ///< "gallery", "gallery turned 138", "gallery orbited 275"
    CameraDesc camera;
};

/// The scene's cameras, then the same ones moved, until there are `count`: each in its turn, turned
/// about its own vertical or carried around its target by multiples of the golden angle (137.5
/// degrees), which never come twice to the same place. Always the same views for the same scene.
///
/// A view that looks into a wall, or past the scene, tells nothing and is passed over: of rays on a
/// grid of 8 x 6 at least half as many must meet something as in the camera's own view, at a
/// median depth of at least a quarter of the one there, and at most a tenth of them nearer than a
/// tenth of it. May find fewer than `count`, never none.
[[nodiscard]] std::vector<MeasureView> chooseViews(const Scene& scene, std::size_t count);

} // namespace hone::cli

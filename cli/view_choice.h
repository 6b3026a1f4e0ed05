// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/cli/session.h"

#include <span>
#include <string>
#include <vector>

namespace hone::cli {

/// A view of a scene and how much of it a graph takes for wrong.
struct ChosenView {
    CameraDesc camera;
    double wanted_share = 0; ///< of error pixels, as sort counts them
    double share = 0;        ///< as measured at a small size
};

/// Places from which a person could look into the scene: half of them around the mirrors, near and
/// far, half anywhere inside the scene's bounds and roughly level. The same places for the same
/// scene. Not all of them see much: chooseViewsByShare() sorts those out.
[[nodiscard]] std::vector<CameraDesc> candidateViews(const Scene& scene, const CameraDesc& like,
                                                     std::size_t count);

/// For each share the candidate whose share of error pixels is nearest to it, no candidate twice.
/// The output "error" of the graph at `graph_path` says what is wrong, raster.json what is seen;
/// both run at a small size. `like` gives the field of view and the lens. Throws GraphError if the
/// graph has no such output of type Error, SceneError if no candidate sees anything.
[[nodiscard]] std::vector<ChosenView>
chooseViewsByShare(const std::string& graph_path, const Session& session, const Devices& devices,
                   const Scene& scene, const CameraDesc& like, std::span<const double> shares);

} // namespace hone::cli

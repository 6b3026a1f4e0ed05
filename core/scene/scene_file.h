// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/scene/scene.h"

#include <string>

namespace hone {

/// Reads a *.scene.json into `scene`, which is empty and has its name: a model and what it lacks.
/// JSON with // comments. World in metres, y up; colours linear, one number for grey or [r, g, b].
///
/// - "model": a .gltf or .glb, relative to the scene file, or "builtin:NAME". May be absent.
/// - "cameras": [{"name", "position", "target", "up"?: [0,1,0], "fov_y"?: 60 degrees, "near"?:
/// 0.01, "lens"?: {"aperture": diameter in metres, "focus": view depth in metres} or
/// {"focal_length", "f_number", "focus"}}];
///   they come before the model's own, so the first is the default.
/// - "paths": [{"name", "keys": [{"time": seconds, ascending, and what a camera has but "name"}]}],
///   camera paths, which come before the model's own; the first is the default.
/// - "lights", added to the model's:
///   {"type": "point", "position", "intensity": W/sr, "range"?: metres, 0 = endless};
///   {"type": "spot", "position", "direction", "intensity", "inner"?: 0, "outer"?: 45 degrees, half
///   angles of the cone, "range"?};
///   {"type": "directional", "direction": the way the light travels, "irradiance": W/m^2, "angle"?:
///   degrees that it fills in the sky};
///   {"type": "rectangle", "center", "edge_u", "edge_v": whole edges, "radiance": W/(sr m^2)},
///   which emits to the side that cross(edge_u, edge_v) points to;
///   {"type": "disc", "center", "direction": the side that it emits to, "radius", "radiance"};
///   {"type": "sphere", "center", "radius", "radiance"}; any of them "casts_shadow"?: true.
/// - "environment": {"zenith", "horizon", "ground", "ambient"}, radiance, each 0 if absent.
/// - "probes": [{"position", "object"?: the instance that uses it and is left out of it}].
/// - "task_objects": ["NAME"], the instances that someone who looks at the picture looks for;
///   a node of several primitives is the instances NAME/0, NAME/1, ..., which NAME names together.
/// - "materials": {"NAME": {"mirror"?: reflectance at normal incidence, 0 = none, "base_color"?,
///   "emission"?: radiance, "two_sided"?}}, changes to the model's.
///
/// Returns whether the file says anything about light ("lights" or "environment"). Throws
/// SceneError: file:line:column for bad JSON, else the JSON pointer and what was expected there.
bool readSceneFile(const std::string& name, Scene& scene);

} // namespace hone

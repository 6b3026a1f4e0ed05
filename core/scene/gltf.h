// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/scene/scene.h"

#include <string>

namespace hone {

/// Appends the default scene of a .gltf or .glb to `scene`, which is not finished yet: a Mesh for
/// each triangle primitive, an Instance for each node and primitive, materials, textures,
/// perspective cameras and punctual lights (candela and lux are taken for W/sr and W/m^2).
///
/// Static geometry only; what is left out is named in scene.warnings. An instance is called like
/// its node; those of a mesh with several primitives get "/0", "/1", ... added. The file is
/// untrusted: it reads nothing outside its own folder, and every index and length in it is checked.
/// Throws SceneError with the file's name and the JSON pointer of what is wrong.
void readGltf(const std::string& name, Scene& scene);

} // namespace hone

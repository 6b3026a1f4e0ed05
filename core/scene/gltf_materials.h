// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/scene/gltf_file.h"
#include "hone/core/scene/gltf_warnings.h"
#include "hone/core/scene/scene.h"

namespace hone {

/// Appends the file's materials to scene.materials, in order, and one for primitives without a
/// material; and the base colour textures that they use. An image that is missing or broken is a
/// warning, and its materials keep their factors.
///
/// hone shades what is diffuse and what is a smooth mirror; the metallic-roughness model is mapped
/// to that:
/// - roughness <= 0.1 without a texture for it is a mirror, f0 = mix(((ior - 1) / (ior + 1))^2,
/// base
///   colour, metallic); what the metal takes is not diffuse.
/// - Anything rougher keeps its base colour as diffuse albedo. For rough metals that is an
///   approximation: their broad, coloured highlight becomes diffuse.
/// - MASK holes below alphaCutoff. BLEND is drawn as MASK with a cutoff of 0.5, and said so.
/// - Emission: emissiveFactor times KHR_materials_emissive_strength, as radiance. One with an
/// emissive
///   texture does not emit, and that is said.
void appendGltfMaterials(const GltfFile& file, Scene& scene, GltfWarnings& warnings);

} // namespace hone

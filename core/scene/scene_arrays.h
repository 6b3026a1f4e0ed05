// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/scene/scene.h"

#include <span>
#include <string_view>

namespace hone {

/// IEC 61966-2-1: the linear value in [0,1] of each 8-bit sRGB code, 256 of them.
[[nodiscard]] const PagedVector<float>& srgbTable();

/// Calls visit(name, span) for every array that kernels see of a scene, by the name under which
/// they read it (surface.glsl.h, texture.glsl.h, shading.glsl.h). The one list of them.
template <class Visit> void forEachSceneArray(const Scene& scene, const Visit& visit) {
    const auto array = [&visit]<class T>(std::string_view name, const PagedVector<T>& elements) {
        visit(name, std::span<const T>(elements));
    };
    array("scene_positions", scene.positions);
    array("scene_normals", scene.normals);
    array("scene_uvs", scene.uvs);
    array("scene_triangles", scene.triangles);
    array("scene_meshes", scene.meshes);
    array("scene_instances", scene.instances);
    array("scene_materials", scene.materials);
    array("scene_textures", scene.textures);
    array("scene_texels", scene.texels);
    array("scene_srgb", srgbTable());
    array("scene_lights", scene.lights);
    array("scene_probes", scene.probes);
    visit(std::string_view("scene_environment"),
          std::span<const Environment>(&scene.environment, 1));
}

} // namespace hone

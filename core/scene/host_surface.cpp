// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/host_surface.h"

#include "hone/core/scene/scene_buffers.h"

namespace hone {

Arguments HostSurface::bind(const Scene& scene) {
    Arguments arguments;
    auto add = [&]<class T>(std::string_view name, std::span<const T> elements) {
        // Arguments are made for kernels that write too; this one only reads.
        auto* data = reinterpret_cast<std::byte*>(const_cast<T*>(elements.data()));
        arguments.bind(name, {.bytes = elements.size_bytes(), .data = data});
    };
    add("scene_positions", std::span<const vec3>(scene.positions));
    add("scene_normals", std::span<const vec3>(scene.normals));
    add("scene_uvs", std::span<const vec2>(scene.uvs));
    add("scene_triangles", std::span<const uvec3>(scene.triangles));
    add("scene_meshes", std::span<const Mesh>(scene.meshes));
    add("scene_instances", std::span<const Instance>(scene.instances));
    add("scene_materials", std::span<const Material>(scene.materials));
    add("scene_textures", std::span<const Texture>(scene.textures));
    add("scene_texels", std::span<const uint>(scene.texels));
    add("scene_srgb", std::span<const float>(srgbTable()));
    return arguments;
}

} // namespace hone

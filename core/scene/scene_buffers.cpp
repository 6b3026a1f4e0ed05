// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/scene_buffers.h"

#include "hone/core/error.h"

#include <cmath>
#include <cstring>

namespace hone {
const std::array<float, 256>& srgbTable() {
    static const std::array<float, 256> decoded = [] {
        std::array<float, 256> table{};
        for (int i = 0; i < 256; ++i) {
            const double encoded = i / 255.0;
            table[static_cast<std::size_t>(i)] = static_cast<float>(
                encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4));
        }
        return table;
    }();
    return decoded;
}

SceneBuffers::SceneBuffers(Device& device, const Scene& scene) {
    auto add = [&]<class T>(std::string_view name, std::span<const T> elements) {
        Buffer& buffer = buffers_.emplace_back(
            device.createBuffer(std::max<std::size_t>(elements.size_bytes(), sizeof(T)), name));
        if (!elements.empty())
            std::memcpy(buffer.view().data, elements.data(), elements.size_bytes());
        arguments_.push_back({name, buffer.view()});
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
    add("scene_lights", std::span<const Light>(scene.lights));
    add("scene_probes", std::span<const Probe>(scene.probes));
    add("scene_environment", std::span<const Environment>(&scene.environment, 1));
}

void SceneBuffers::update(const Scene& scene) {
    const std::span<const Instance> instances(scene.instances);
    if (!instances.empty())
        std::memcpy(find("scene_instances").data, instances.data(), instances.size_bytes());
}

BufferView SceneBuffers::find(std::string_view name) const {
    for (const Argument& argument : arguments_)
        if (argument.name == name)
            return argument.buffer;
    HONE_ASSERT(false, "a scene has no buffer " + std::string(name));
}

std::size_t SceneBuffers::bytes() const {
    std::size_t total = 0;
    for (const Buffer& buffer : buffers_)
        total += buffer.bytes();
    return total;
}

} // namespace hone

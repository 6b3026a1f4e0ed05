// SPDX-License-Identifier: Apache-2.0
#include "hone/core/plugin/plugin_host.h"

#include "hone/core/log.h"
#include "hone/core/plugin/same_records.h"

namespace hone {
namespace {

const SceneAccess& accessOf(const hone_scene* scene) {
    return *static_cast<const SceneAccess*>(scene->hone);
}

// ---- hone_host's functions. Plug-ins are C: nothing may leave these but by return. ----

void hostLog(const hone_host*, std::int32_t level, const char* text) noexcept {
    const std::string shown = printable(text != nullptr ? text : "");
    if (level >= HONE_LOG_WARN)
        logger().warn("{}", shown);
    else if (level == HONE_LOG_INFO)
        logger().info("{}", shown);
    else
        logger().debug("{}", shown);
}

std::int32_t hostIsSolid(const hone_scene* scene, const hone_ray* ray, hone_hit hit) noexcept {
    return accessOf(scene).surface.isSolid(reinterpret_cast<const Ray&>(*ray),
                                           {hit.instance, hit.primitive})
               ? 1
               : 0;
}

void hostWorldPosition(const hone_scene* scene, std::uint32_t instance, std::uint32_t vertex,
                       float position[3]) noexcept {
    const SceneAccess& access = accessOf(scene);
    const vec3 placed = access.surface.worldPosition(access.scene->instances[instance], vertex);
    for (int axis = 0; axis < 3; ++axis)
        position[axis] = placed[axis];
}

void hostParallelFor(const hone_host* host, std::size_t count, std::size_t grain,
                     void (*body)(void*, std::size_t, std::size_t), void* context) noexcept {
    static_cast<const PluginLibrary*>(host->hone)->parallel_for(count, grain, body, context);
}

} // namespace

hone_host makeHost(const PluginLibrary& library) {
    return {.struct_size = sizeof(hone_host),
            .abi_major = HONE_PLUGIN_ABI_MAJOR,
            .abi_minor = HONE_PLUGIN_ABI_MINOR,
            .reserved = 0,
            .hone = const_cast<PluginLibrary*>(&library), // only read, by hostParallelFor
            .log = hostLog,
            .is_solid = hostIsSolid,
            .world_position = hostWorldPosition,
            .parallel_for = hostParallelFor};
}

hone_scene makeScene(const Scene& scene, const SceneAccess& access) {
    return {.struct_size = sizeof(hone_scene),
            .reserved = 0,
            .hone = &access,
            .positions = reinterpret_cast<const float(*)[3]>(scene.positions.data()),
            .normals = reinterpret_cast<const float(*)[3]>(scene.normals.data()),
            .uvs = reinterpret_cast<const float(*)[2]>(scene.uvs.data()),
            .position_count = scene.positions.size(),
            .triangles = reinterpret_cast<const std::uint32_t(*)[3]>(scene.triangles.data()),
            .triangle_count = scene.triangles.size(),
            .meshes = reinterpret_cast<const hone_mesh*>(scene.meshes.data()),
            .mesh_count = scene.meshes.size(),
            .instances = reinterpret_cast<const hone_instance*>(scene.instances.data()),
            .instance_count = scene.instances.size(),
            .materials = reinterpret_cast<const hone_material*>(scene.materials.data()),
            .material_count = scene.materials.size(),
            .textures = reinterpret_cast<const hone_texture*>(scene.textures.data()),
            .texture_count = scene.textures.size(),
            .texels = scene.texels.data(),
            .texel_count = scene.texels.size()};
}

bool isInScene(const Scene& scene, Hit hit) {
    if (hit.instance == kNone)
        return hit.primitive == kNone;
    return hit.instance < scene.instances.size() &&
           hit.primitive < scene.meshes[scene.instances[hit.instance].mesh].triangle_count;
}

void throwStatus(const std::string& who, const char* name, hone_status status, hone_error& error) {
    error.text[sizeof error.text - 1] = '\0';
    const std::string reason = error.text[0] != '\0' ? printable(error.text) : "it gave no reason";
    const std::string text = who + ": " + name + " failed: " + reason;
    if (status == HONE_NO_DEVICE)
        throw DeviceError(text);
    if (status == HONE_OUT_OF_MEMORY)
        throw OutOfMemory(text);
    throw PluginError(text);
}

} // namespace hone

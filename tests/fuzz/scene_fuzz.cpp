// SPDX-License-Identifier: Apache-2.0
//
// Hostile scenes: glTF (text and binary) and scene files. Whatever the bytes are, loading ends with
// a scene whose every index and number can be trusted, or with an error that names the file. Run
// with libFuzzer (tests/fuzz/CMakeLists.txt).
#include "hone/core/error.h"
#include "hone/core/scene/scene.h"
#include "hone/tests/fuzz/require.h"
#include "hone/tests/support/temporary_folder.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

namespace hone {
namespace {

/// What scene files may name as their model: a triangle.
constexpr std::string_view kModel = R"({
    "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "name": "square"}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]
})";

bool isFinite(vec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// What kernels and tracers rely on without asking.
void checkScene(const Scene& scene) {
    require(scene.version != 0 && !scene.cameras.empty(), "the scene is finished");
    require(scene.normals.size() == scene.positions.size() &&
                scene.uvs.size() == scene.positions.size(),
            "a normal and a uv for each position");
    for (std::size_t i = 0; i < scene.positions.size(); ++i)
        require(isFinite(scene.positions[i]) && isFinite(scene.normals[i]), "vertices are finite");
    for (const uvec3& triangle : scene.triangles)
        require(glm::all(glm::lessThan(triangle, uvec3(static_cast<uint>(scene.positions.size())))),
                "triangles have vertices");
    for (const Mesh& mesh : scene.meshes) {
        require(std::size_t{mesh.first_triangle} + mesh.triangle_count <= scene.triangles.size(),
                "meshes have triangles");
        require(mesh.material < scene.materials.size(), "meshes have a material");
        require(std::size_t{mesh.first_cluster} + mesh.cluster_count <= scene.clusters.size(),
                "meshes have clusters");
    }
    for (const Instance& instance : scene.instances) {
        require(instance.mesh < scene.meshes.size(), "instances have a mesh");
        for (int column = 0; column < 4; ++column)
            require(isFinite(instance.to_world[column]), "instances stand somewhere");
    }
    for (const Material& material : scene.materials)
        require(material.base_color_texture == kNone ||
                    material.base_color_texture < scene.textures.size(),
                "materials have textures");
    for (const Texture& texture : scene.textures)
        require(texture.width > 0 && texture.height > 0 && texture.levels > 0 &&
                    std::size_t{texture.first_texel} +
                            std::size_t{texture.width} * texture.height <=
                        scene.texels.size(),
                "textures have texels");
    for (const Light& light : scene.lights)
        require(isFinite(light.position) && isFinite(light.direction) && isFinite(light.intensity),
                "lights are finite");
    for (const CameraDesc& camera : scene.cameras)
        require(isFinite(camera.position) && isFinite(camera.target), "cameras stand somewhere");
}

void loadBytes(std::string_view bytes) {
    static const test::TemporaryFolder folder;
    static const std::string model = folder.write("square.gltf", std::string(kModel));
    const bool is_text = bytes.find("\"asset\"") != std::string_view::npos;
    const char* name = bytes.starts_with("glTF") ? "model.glb"
                       : is_text                 ? "model.gltf"
                                                 : "lamp.scene.json";
    const std::string path = folder.write(name, std::string(bytes));
    try {
        checkScene(loadScene(path));
    } catch (const SceneError& error) {
        require(std::string_view(error.what()).find(folder.path()) != std::string_view::npos,
                "the message names the file, or one that it names");
    }
}

} // namespace
} // namespace hone

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    hone::loadBytes({reinterpret_cast<const char*>(data), size});
    return 0;
}

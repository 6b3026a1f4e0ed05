// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/scene/gltf_file.h"
#include "hone/core/scene/gltf_warnings.h"
#include "hone/core/scene/scene.h"

#include <array>
#include <map>
#include <vector>

namespace hone {

/// Turns the primitives of glTF meshes into Meshes of a scene, each mesh once however many nodes
/// place it.
///
/// Strips and fans become triangles; points and lines are left out with a warning. Normals are made
/// unit length; a primitive without normals is shaded flat, and single normals that are zero or not
/// finite are replaced by the mean of the faces around. Missing texture coordinates are 0.
class GltfGeometry {
public:
    /// `first_material`: index in the scene of the file's material 0.
    GltfGeometry(const GltfFile& file, uint first_material, Scene& scene, GltfWarnings& warnings);

    /// The scene's meshes for a glTF mesh; the number of its primitive comes first. `user`: JSON
    /// pointer of who asks. Throws SceneError.
    const std::vector<std::pair<std::size_t, uint>>& meshes(int gltf_mesh, const std::string& user);

private:
    bool append(const tinygltf::Primitive& primitive, const std::string& pointer,
                const std::string& mesh_name);
    uint appendVertices(const tinygltf::Primitive& primitive, int uv_accessor,
                        const std::string& pointer);
    void appendFlat(const tinygltf::Primitive& primitive, int uv_accessor,
                    const std::string& pointer);
    std::vector<uvec3> readTriangles(const tinygltf::Primitive& primitive, std::size_t vertex_count,
                                     const std::string& pointer);

    const GltfFile& file_;
    uint first_material_;
    Scene& scene_;
    GltfWarnings& warnings_;
    std::map<int, std::vector<std::pair<std::size_t, uint>>> meshes_;
    std::map<std::array<int, 3>, uint>
        shared_; ///< first vertex of (position, normal, uv) accessors
};

} // namespace hone

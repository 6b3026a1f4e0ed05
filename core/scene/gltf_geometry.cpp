// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/gltf_geometry.h"

#include "hone/core/error.h"
#include "hone/core/printable.h"
#include "hone/core/scene/gltf_accessor.h"

#include <cmath>
#include <limits>

namespace hone {
namespace {

int attribute(const tinygltf::Primitive& primitive, const std::string& name) {
    const auto found = primitive.attributes.find(name);
    return found == primitive.attributes.end() ? -1 : found->second;
}

bool isFinite(vec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

std::vector<vec3> readPositions(const GltfFile& file, int accessor, const std::string& pointer) {
    const std::vector<float> floats =
        readFloats(file, accessor, 3, pointer + "/attributes/POSITION");
    std::vector<vec3> positions(floats.size() / 3);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        positions[i] = vec3(floats[3 * i], floats[3 * i + 1], floats[3 * i + 2]);
        if (!isFinite(positions[i]))
            file.fail("/accessors/" + std::to_string(accessor),
                      "position " + std::to_string(i) + " is not finite");
    }
    return positions;
}

std::vector<vec3> readNormals(const GltfFile& file, int accessor, std::size_t count,
                              const std::string& pointer) {
    const std::vector<float> floats = readFloats(file, accessor, 3, pointer + "/attributes/NORMAL");
    if (floats.size() != 3 * count)
        file.fail(pointer + "/attributes/NORMAL", std::to_string(floats.size() / 3) +
                                                      " normals for " + std::to_string(count) +
                                                      " positions");
    std::vector<vec3> normals(count);
    for (std::size_t i = 0; i < count; ++i)
        normals[i] = vec3(floats[3 * i], floats[3 * i + 1], floats[3 * i + 2]);
    return normals;
}

/// Zeros for accessor -1; what is not finite becomes 0 as well, for lookups turn it into an
/// integer.
std::vector<vec2> readUvs(const GltfFile& file, int accessor, std::size_t count,
                          const std::string& pointer) {
    std::vector<vec2> uvs(count, vec2(0.0f));
    if (accessor < 0)
        return uvs;
    const std::vector<float> floats =
        readFloats(file, accessor, 2, pointer + "/attributes/TEXCOORD");
    if (floats.size() != 2 * count)
        file.fail(pointer + "/attributes/TEXCOORD", std::to_string(floats.size() / 2) +
                                                        " coordinates for " +
                                                        std::to_string(count) + " positions");
    for (std::size_t i = 0; i < count; ++i) {
        uvs[i] = vec2(floats[2 * i], floats[2 * i + 1]);
        if (!std::isfinite(uvs[i].x) || !std::isfinite(uvs[i].y))
            uvs[i] = vec2(0.0f);
    }
    return uvs;
}

/// The unit normal of a face in double precision, so that small faces have one; up if it has no
/// area.
vec3 faceNormal(vec3 a, vec3 b, vec3 c) {
    const glm::dvec3 normal =
        glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
    const double length = glm::length(normal);
    return length > 0.0 ? vec3(normal / length) : vec3(0, 1, 0);
}

/// Makes normals unit length. Those that have no direction get the mean of the faces around them.
void normalise(std::span<vec3> normals, std::span<const vec3> positions,
               std::span<const uvec3> triangles) {
    std::vector<uint> broken;
    for (std::size_t i = 0; i < normals.size(); ++i) {
        const glm::dvec3 normal(normals[i]);
        const double length = glm::length(normal);
        if (std::isfinite(length) && length > 0.0)
            normals[i] = vec3(normal / length);
        else
            broken.push_back(static_cast<uint>(i));
    }
    if (broken.empty())
        return;
    std::vector<glm::dvec3> sums(normals.size(), glm::dvec3(0.0));
    for (const uvec3& t : triangles)
        for (int corner = 0; corner < 3; ++corner)
            sums[t[corner]] += glm::cross(glm::dvec3(positions[t.y]) - glm::dvec3(positions[t.x]),
                                          glm::dvec3(positions[t.z]) - glm::dvec3(positions[t.x]));
    for (const uint i : broken) {
        const double length = glm::length(sums[i]);
        normals[i] = length > 0.0 ? vec3(sums[i] / length) : vec3(0, 1, 0);
    }
}

/// glTF 2.0 specification, section 3.7.2.1: corners of the triangles of strips and fans.
std::vector<uvec3> assemble(const std::vector<uint>& indices, int mode) {
    std::vector<uvec3> triangles;
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
            triangles.emplace_back(indices[i], indices[i + 1], indices[i + 2]);
        return triangles;
    }
    for (std::size_t i = 0; i + 2 < indices.size(); ++i)
        if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
            triangles.emplace_back(indices[i + 1], indices[i + 2], indices[0]);
        else
            triangles.emplace_back(indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]);
    return triangles;
}

} // namespace

GltfGeometry::GltfGeometry(const GltfFile& file, uint first_material, Scene& scene,
                           GltfWarnings& warnings)
    : file_(file), first_material_(first_material), scene_(scene), warnings_(warnings) {}

const std::vector<std::pair<std::size_t, uint>>& GltfGeometry::meshes(int gltf_mesh,
                                                                      const std::string& user) {
    if (static_cast<std::size_t>(gltf_mesh) >= file_.model.meshes.size())
        file_.fail(user, "names mesh " + std::to_string(gltf_mesh) + ", but there are " +
                             std::to_string(file_.model.meshes.size()));
    const auto [found, is_new] = meshes_.try_emplace(gltf_mesh);
    if (!is_new)
        return found->second;
    const tinygltf::Mesh& mesh = file_.model.meshes[static_cast<std::size_t>(gltf_mesh)];
    const std::string pointer = "/meshes/" + std::to_string(gltf_mesh);
    const std::string mesh_name =
        mesh.name.empty() ? "mesh " + std::to_string(gltf_mesh) : printable(mesh.name);
    for (std::size_t p = 0; p < mesh.primitives.size(); ++p)
        if (append(mesh.primitives[p], pointer + "/primitives/" + std::to_string(p), mesh_name))
            found->second.emplace_back(p, static_cast<uint>(scene_.meshes.size() - 1));
    return found->second;
}

/// Appends one Mesh; false if the primitive has no triangles to draw.
bool GltfGeometry::append(const tinygltf::Primitive& primitive, const std::string& pointer,
                          const std::string& mesh_name) {
    if (primitive.mode < TINYGLTF_MODE_TRIANGLES && primitive.mode >= TINYGLTF_MODE_POINTS) {
        warnings_.add("points and lines are not drawn", mesh_name);
        return false;
    }
    if (primitive.mode < 0 || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
        file_.fail(pointer + "/mode", std::to_string(primitive.mode) + "; expected 0 to 6");
    if (attribute(primitive, "POSITION") < 0)
        file_.fail(pointer + "/attributes", "has no POSITION");
    if (attribute(primitive, "COLOR_0") >= 0)
        warnings_.add("vertex colours (COLOR_0) are ignored", mesh_name);
    if (!primitive.targets.empty())
        warnings_.add("morph targets are ignored", mesh_name);
    if (primitive.material >= 0 &&
        static_cast<std::size_t>(primitive.material) >= file_.model.materials.size())
        file_.fail(pointer + "/material", std::to_string(primitive.material) + ", but there are " +
                                              std::to_string(file_.model.materials.size()));

    // The one texture of a material decides which coordinates its primitive needs.
    const std::size_t material = primitive.material < 0
                                     ? file_.model.materials.size()
                                     : static_cast<std::size_t>(primitive.material);
    int uv_accessor = -1;
    if (primitive.material >= 0) {
        const auto& texture = file_.model.materials[material].pbrMetallicRoughness.baseColorTexture;
        uv_accessor = attribute(primitive, "TEXCOORD_" + std::to_string(texture.texCoord));
        if (uv_accessor < 0 && texture.index >= 0)
            warnings_.add("a textured primitive has no texture coordinates", mesh_name);
    }
    const auto first_triangle = static_cast<uint>(scene_.triangles.size());
    if (attribute(primitive, "NORMAL") < 0) {
        appendFlat(primitive, uv_accessor, pointer);
    } else {
        const uint first_vertex = appendVertices(primitive, uv_accessor, pointer);
        for (uint i = first_triangle; i < scene_.triangles.size(); ++i)
            scene_.triangles[i] += first_vertex;
    }
    const auto count = static_cast<uint>(scene_.triangles.size()) - first_triangle;
    if (count == 0) {
        warnings_.add("a primitive has no triangles", mesh_name);
        return false;
    }
    scene_.meshes.push_back(
        {first_triangle, count, first_material_ + static_cast<uint>(material), 0, 0});
    return true;
}

/// Appends the triangles, counted from the primitive's own first vertex, and its vertices unless
/// another primitive has brought the same. Returns the first vertex.
uint GltfGeometry::appendVertices(const tinygltf::Primitive& primitive, int uv_accessor,
                                  const std::string& pointer) {
    const int position_accessor = attribute(primitive, "POSITION");
    const int normal_accessor = attribute(primitive, "NORMAL");
    const auto [shared, is_new] =
        shared_.try_emplace({position_accessor, normal_accessor, uv_accessor},
                            static_cast<uint>(scene_.positions.size()));
    if (!is_new) {
        const std::size_t count =
            file_.model.accessors[static_cast<std::size_t>(position_accessor)].count;
        const std::vector<uvec3> triangles = readTriangles(primitive, count, pointer);
        scene_.triangles.insert(scene_.triangles.end(), triangles.begin(), triangles.end());
        return shared->second;
    }
    const std::vector<vec3> positions = readPositions(file_, position_accessor, pointer);
    std::vector<vec3> normals = readNormals(file_, normal_accessor, positions.size(), pointer);
    const std::vector<vec2> uvs = readUvs(file_, uv_accessor, positions.size(), pointer);
    const std::vector<uvec3> triangles = readTriangles(primitive, positions.size(), pointer);
    normalise(normals, positions, triangles);
    if (positions.size() > std::numeric_limits<uint>::max() - scene_.positions.size())
        file_.fail(pointer, "the model has more than 2^32 vertices");
    scene_.positions.insert(scene_.positions.end(), positions.begin(), positions.end());
    scene_.normals.insert(scene_.normals.end(), normals.begin(), normals.end());
    scene_.uvs.insert(scene_.uvs.end(), uvs.begin(), uvs.end());
    scene_.triangles.insert(scene_.triangles.end(), triangles.begin(), triangles.end());
    return shared->second;
}

/// Appends triangles with corners of their own and the normal of their face.
void GltfGeometry::appendFlat(const tinygltf::Primitive& primitive, int uv_accessor,
                              const std::string& pointer) {
    const std::vector<vec3> positions =
        readPositions(file_, attribute(primitive, "POSITION"), pointer);
    const std::vector<vec2> uvs = readUvs(file_, uv_accessor, positions.size(), pointer);
    const std::vector<uvec3> triangles = readTriangles(primitive, positions.size(), pointer);
    if (3 * triangles.size() > std::numeric_limits<uint>::max() - scene_.positions.size())
        file_.fail(pointer, "the model has more than 2^32 vertices");
    for (const uvec3& t : triangles) {
        const auto first = static_cast<uint>(scene_.positions.size());
        const vec3 normal = faceNormal(positions[t.x], positions[t.y], positions[t.z]);
        for (int corner = 0; corner < 3; ++corner) {
            scene_.positions.push_back(positions[t[corner]]);
            scene_.normals.push_back(normal);
            scene_.uvs.push_back(uvs[t[corner]]);
        }
        scene_.triangles.emplace_back(first, first + 1, first + 2);
    }
}

std::vector<uvec3> GltfGeometry::readTriangles(const tinygltf::Primitive& primitive,
                                               std::size_t vertex_count,
                                               const std::string& pointer) {
    std::vector<uint> indices;
    if (primitive.indices >= 0) {
        indices = readIndices(file_, primitive.indices, vertex_count, pointer + "/indices");
    } else {
        indices.resize(vertex_count);
        for (std::size_t i = 0; i < vertex_count; ++i)
            indices[i] = static_cast<uint>(i);
    }
    if (primitive.mode == TINYGLTF_MODE_TRIANGLES && indices.size() % 3 != 0)
        file_.fail(pointer + (primitive.indices >= 0 ? "/indices" : "/attributes/POSITION"),
                   std::to_string(indices.size()) + " corners are no whole number of triangles");
    return assemble(indices, primitive.mode);
}

} // namespace hone

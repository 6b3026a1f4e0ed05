// SPDX-License-Identifier: Apache-2.0
#include "hone/core/error.h"
#include "hone/core/scene/clusters.h"
#include "hone/core/scene/scene.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace hone {
namespace {

constexpr std::size_t kMaxTriangles = std::size_t{1} << 31;
constexpr std::size_t kMaxDefaultProbes = 4;

bool isFinite(vec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

[[noreturn]] void fail(const Scene& scene, const std::string& what) {
    throw SceneError((scene.name.empty() ? "scene" : scene.name) + ": " + what);
}

void checkIndex(const Scene& scene, const std::string& owner, const char* what, std::size_t index,
                std::size_t count) {
    if (index >= count)
        fail(scene, owner + " names " + what + " " + std::to_string(index) + ", but there are " +
                        std::to_string(count));
}

void checkMaterials(const Scene& scene) {
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        if (scene.materials[i].base_color_texture != kNone)
            checkIndex(scene, "material " + std::to_string(i), "texture",
                       scene.materials[i].base_color_texture, scene.textures.size());
    for (std::size_t i = 0; i < scene.textures.size(); ++i) {
        const Texture& texture = scene.textures[i];
        std::uint64_t end = texture.first_texel;
        uint width = texture.width;
        uint height = texture.height;
        for (uint level = 0; level < texture.levels; ++level) {
            end += std::uint64_t{width} * height;
            width = std::max(1u, width / 2);
            height = std::max(1u, height / 2);
        }
        if (texture.width == 0 || texture.height == 0 || texture.levels == 0 ||
            end > scene.texels.size())
            fail(scene, "texture " + std::to_string(i) + " has no texels or reaches past the " +
                            std::to_string(scene.texels.size()) + " that there are");
    }
}

/// Two meshes in one range would each put its triangles in an order of its own.
void checkOverlap(const Scene& scene) {
    std::vector<std::pair<uint, std::size_t>> ranges;
    for (std::size_t i = 0; i < scene.meshes.size(); ++i)
        if (scene.meshes[i].triangle_count > 0)
            ranges.emplace_back(scene.meshes[i].first_triangle, i);
    std::ranges::sort(ranges);
    for (std::size_t i = 1; i < ranges.size(); ++i) {
        const Mesh& before = scene.meshes[ranges[i - 1].second];
        if (ranges[i].first - before.first_triangle < before.triangle_count)
            fail(scene, "mesh " + std::to_string(ranges[i].second) + " shares triangle " +
                            std::to_string(ranges[i].first) + " with another mesh");
    }
}

void checkMeshes(const Scene& scene) {
    if (scene.normals.size() != scene.positions.size() ||
        scene.uvs.size() != scene.positions.size())
        fail(scene, std::to_string(scene.positions.size()) + " positions, " +
                        std::to_string(scene.normals.size()) + " normals and " +
                        std::to_string(scene.uvs.size()) + " uvs; expected as many of each");
    if (scene.triangles.size() > kMaxTriangles)
        fail(scene,
             std::to_string(scene.triangles.size()) + " triangles; at most 2^31 are possible");
    for (std::size_t i = 0; i < scene.positions.size(); ++i)
        if (!isFinite(scene.positions[i]))
            fail(scene, "position " + std::to_string(i) + " is not finite");
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        const uvec3 corners = scene.triangles[i];
        const uint largest = std::max({corners.x, corners.y, corners.z});
        if (largest >= scene.positions.size())
            checkIndex(scene, "triangle " + std::to_string(i), "position", largest,
                       scene.positions.size());
    }
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        const Mesh& mesh = scene.meshes[i];
        const std::string owner = "mesh " + std::to_string(i);
        checkIndex(scene, owner, "material", mesh.material, scene.materials.size());
        if (mesh.first_triangle > scene.triangles.size() ||
            mesh.triangle_count > scene.triangles.size() - mesh.first_triangle)
            fail(scene, owner + " reaches past the " + std::to_string(scene.triangles.size()) +
                            " triangles that there are");
    }
    checkOverlap(scene);
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const std::string owner = "instance " + std::to_string(i);
        checkIndex(scene, owner, "mesh", scene.instances[i].mesh, scene.meshes.size());
        for (int column = 0; column < 4; ++column)
            if (!isFinite(scene.instances[i].to_world[column]))
                fail(scene, owner + ": its transform is not finite");
    }
    for (std::size_t i = 0; i < scene.probes.size(); ++i)
        if (scene.probes[i].object != kNone)
            checkIndex(scene, "probe " + std::to_string(i), "object", scene.probes[i].object,
                       scene.instances.size());
}

/// The inverse transpose in double precision. A flattening matrix has none: its cofactors still
/// turn normals the right way, and length does not matter.
void orient(Instance& instance) {
    const glm::dmat3 linear(instance.to_world[0], instance.to_world[1], instance.to_world[2]);
    const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                               glm::cross(linear[0], linear[1]));
    const double determinant = glm::dot(linear[0], cofactors[0]);
    instance.flipped = determinant < 0.0 ? 1 : 0;
    const glm::dmat3 inverse_transpose = determinant != 0.0 ? cofactors / determinant : cofactors;
    instance.normal_matrix = mat3(inverse_transpose);
}

Bounds meshBounds(const Scene& scene, const Mesh& mesh) {
    Bounds bounds;
    for (uint i = 0; i < mesh.triangle_count; ++i)
        for (int corner = 0; corner < 3; ++corner)
            bounds.add(scene.positions[scene.triangles[mesh.first_triangle + i][corner]]);
    return bounds;
}

/// The box around the eight transformed corners of the mesh's box: not always the smallest one.
Bounds instanceBounds(const Instance& instance, const Bounds& mesh) {
    Bounds bounds;
    if (mesh.empty())
        return bounds;
    for (int corner = 0; corner < 8; ++corner)
        bounds.add(instance.to_world * vec4((corner & 1) != 0 ? mesh.high.x : mesh.low.x,
                                            (corner & 2) != 0 ? mesh.high.y : mesh.low.y,
                                            (corner & 4) != 0 ? mesh.high.z : mesh.low.z, 1.0f));
    return bounds;
}

bool isMirror(const Scene& scene, const Instance& instance) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    return mesh.triangle_count > 0 &&
           (scene.materials[mesh.material].flags & kMaterialMirror) != 0u;
}

void addDefaultProbes(Scene& scene, const std::vector<Bounds>& boxes) {
    std::vector<uint> mirrors;
    for (uint i = 0; i < scene.instances.size(); ++i)
        if (isMirror(scene, scene.instances[i]))
            mirrors.push_back(i);
    std::ranges::stable_sort(mirrors, std::ranges::greater{},
                             [&](uint i) { return glm::distance(boxes[i].low, boxes[i].high); });
    mirrors.resize(std::min(mirrors.size(), kMaxDefaultProbes));
    for (const uint i : mirrors)
        scene.probes.push_back({boxes[i].center(), i});
}

/// The probe that stands for an instance in the scene's own words (Probe::object), or the nearest.
uint findProbe(const Scene& scene, uint instance, vec3 center) {
    uint best = kNone;
    float best_distance = 0.0f;
    for (uint i = 0; i < scene.probes.size(); ++i) {
        if (scene.probes[i].object == instance)
            return i;
        const float distance = glm::distance(scene.probes[i].position, center);
        if (best == kNone || distance < best_distance) {
            best = i;
            best_distance = distance;
        }
    }
    return best;
}

/// Looks along -z and down a little, from where the sphere around the whole scene fits the view.
CameraDesc defaultCamera(const Bounds& bounds) {
    CameraDesc camera;
    camera.name = "default";
    if (bounds.empty()) {
        camera.position = vec3(0, 0, 1);
        camera.target = vec3(0);
        return camera;
    }
    const float radius = std::max(0.5f * glm::distance(bounds.low, bounds.high), 1e-3f);
    const float distance = radius / std::sin(glm::radians(0.5f * camera.fov_y_degrees));
    camera.target = bounds.center();
    camera.position = camera.target + distance * glm::normalize(vec3(0.0f, 0.25f, 1.0f));
    camera.near = 1e-3f * radius;
    return camera;
}

std::uint64_t nextVersion() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}

} // namespace

void finishScene(Scene& scene) {
    checkMaterials(scene);
    checkMeshes(scene);
    buildClusters(scene);

    // Place the instances: orientation and the boxes that probes and camera go by.
    std::vector<Bounds> mesh_boxes;
    for (const Mesh& mesh : scene.meshes)
        mesh_boxes.push_back(meshBounds(scene, mesh));
    scene.bounds = Bounds{};
    std::vector<Bounds> boxes;
    for (Instance& instance : scene.instances) {
        orient(instance);
        const Bounds& box = boxes.emplace_back(instanceBounds(instance, mesh_boxes[instance.mesh]));
        if (!box.empty()) {
            scene.bounds.add(box.low);
            scene.bounds.add(box.high);
        }
    }

    // Give each mirror its probe, and the scene a camera and names.
    if (scene.probes.empty())
        addDefaultProbes(scene, boxes);
    for (uint i = 0; i < scene.instances.size(); ++i)
        scene.instances[i].probe =
            isMirror(scene, scene.instances[i]) ? findProbe(scene, i, boxes[i].center()) : kNone;
    if (scene.cameras.empty())
        scene.cameras.push_back(defaultCamera(scene.bounds));
    scene.instance_names.resize(scene.instances.size());
    scene.material_names.resize(scene.materials.size());
    touch(scene);
}

void touch(Scene& scene) {
    scene.version = nextVersion();
    scene.shape_version = scene.version;
}

void moveInstance(Scene& scene, uint index, const mat4x3& to_world) {
    checkIndex(scene, "moveInstance", "instance", index, scene.instances.size());
    for (int column = 0; column < 4; ++column)
        if (!isFinite(to_world[column]))
            fail(scene, "instance " + std::to_string(index) + ": its transform is not finite");
    Instance& instance = scene.instances[index];
    instance.to_world = to_world;
    orient(instance);
    const Bounds box = instanceBounds(instance, meshBounds(scene, scene.meshes[instance.mesh]));
    if (!box.empty()) {
        scene.bounds.add(box.low);
        scene.bounds.add(box.high);
    }
    scene.version = nextVersion();
}

} // namespace hone

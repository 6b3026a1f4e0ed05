// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/gltf.h"

#include "hone/core/error.h"
#include "hone/core/printable.h"
#include "hone/core/scene/gltf_geometry.h"
#include "hone/core/scene/gltf_materials.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

namespace hone {
namespace {

constexpr std::size_t kMaxNodeDepth = 256;

/// Walks the node hierarchy and puts into the scene what hangs on it.
class NodeWalk {
public:
    NodeWalk(const GltfFile& file, Scene& scene, GltfGeometry& geometry, GltfWarnings& warnings)
        : file_(file), scene_(scene), geometry_(geometry), warnings_(warnings),
          states_(file.model.nodes.size(), State::kNew) {}

    void run() {
        const auto& scenes = file_.model.scenes;
        if (scenes.empty()) {
            for (const int root : rootsWithoutScene())
                visit(root, glm::dmat4(1.0), 1, "/nodes");
            return;
        }
        const int chosen = std::max(file_.model.defaultScene, 0);
        if (static_cast<std::size_t>(chosen) >= scenes.size())
            file_.fail("/scene", std::to_string(chosen) + ", but there are " +
                                     std::to_string(scenes.size()) + " scenes");
        const std::string pointer = "/scenes/" + std::to_string(chosen) + "/nodes";
        for (const int root : scenes[static_cast<std::size_t>(chosen)].nodes)
            visit(root, glm::dmat4(1.0), 1, pointer);
    }

private:
    enum class State : std::uint8_t { kNew, kOpen, kDone };

    /// Every node that is nobody's child.
    std::vector<int> rootsWithoutScene() const {
        std::vector<bool> is_child(file_.model.nodes.size());
        for (const tinygltf::Node& node : file_.model.nodes)
            for (const int child : node.children)
                if (static_cast<std::size_t>(child) < is_child.size())
                    is_child[static_cast<std::size_t>(child)] = true;
        std::vector<int> roots;
        for (std::size_t i = 0; i < is_child.size(); ++i)
            if (!is_child[i])
                roots.push_back(static_cast<int>(i));
        return roots;
    }

    void visit(int index, const glm::dmat4& parent, std::size_t depth, const std::string& user) {
        const auto i = static_cast<std::size_t>(index);
        if (i >= states_.size())
            file_.fail(user, "names node " + std::to_string(index) + ", but there are " +
                                 std::to_string(states_.size()));
        const std::string pointer = "/nodes/" + std::to_string(index);
        if (states_[i] == State::kOpen)
            file_.fail(pointer, "is its own ancestor");
        if (states_[i] == State::kDone)
            file_.fail(pointer, "has two parents; glTF nodes form trees");
        if (depth > kMaxNodeDepth)
            file_.fail(pointer, "lies deeper than " + std::to_string(kMaxNodeDepth) + " levels");
        states_[i] = State::kOpen;
        const tinygltf::Node& node = file_.model.nodes[i];
        const glm::dmat4 to_world = parent * localTransform(node, pointer);
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 3; ++row)
                if (!std::isfinite(static_cast<float>(to_world[column][row])))
                    file_.fail(pointer, "its transform is not finite");
        place(node, to_world, index);
        for (const int child : node.children)
            visit(child, to_world, depth + 1, pointer + "/children");
        states_[i] = State::kDone;
    }

    glm::dmat4 localTransform(const tinygltf::Node& node, const std::string& pointer) const {
        auto check = [&](const std::vector<double>& numbers, std::size_t size, const char* key) {
            if (!numbers.empty() && numbers.size() != size)
                file_.fail(pointer + "/" + key, std::to_string(numbers.size()) +
                                                    " numbers; expected " + std::to_string(size));
            return !numbers.empty();
        };
        if (check(node.matrix, 16, "matrix")) {
            glm::dmat4 matrix = glm::make_mat4(node.matrix.data());
            for (int column = 0; column < 4; ++column)
                matrix[column][3] = column == 3 ? 1.0 : 0.0;
            return matrix;
        }
        glm::dmat4 matrix(1.0);
        if (check(node.rotation, 4, "rotation")) {
            const glm::dquat rotation(node.rotation[3], node.rotation[0], node.rotation[1],
                                      node.rotation[2]);
            if (!(glm::length(rotation) > 0.0))
                file_.fail(pointer + "/rotation", "a quaternion of length 0");
            matrix = glm::mat4_cast(glm::normalize(rotation));
        }
        if (check(node.scale, 3, "scale"))
            for (int column = 0; column < 3; ++column)
                matrix[column] *= node.scale[static_cast<std::size_t>(column)];
        if (check(node.translation, 3, "translation"))
            matrix[3] = glm::dvec4(glm::make_vec3(node.translation.data()), 1.0);
        return matrix;
    }

    void place(const tinygltf::Node& node, const glm::dmat4& to_world, int index) {
        const std::string name =
            node.name.empty() ? "node " + std::to_string(index) : printable(node.name);
        const std::string pointer = "/nodes/" + std::to_string(index);
        if (node.mesh >= 0) {
            const auto& meshes = geometry_.meshes(node.mesh, pointer + "/mesh");
            const bool is_split =
                file_.model.meshes[static_cast<std::size_t>(node.mesh)].primitives.size() > 1;
            for (const auto& [primitive, mesh] : meshes) {
                Instance instance{};
                instance.to_world = mat4x3(to_world);
                instance.mesh = mesh;
                instance.probe = kNone;
                scene_.instances.push_back(instance);
                scene_.instance_names.push_back(name +
                                                (is_split ? "/" + std::to_string(primitive) : ""));
            }
        }
        if (node.camera >= 0)
            placeCamera(node.camera, to_world, name, pointer);
        const auto light = node.extensions.find("KHR_lights_punctual");
        if (light != node.extensions.end() && light->second.Has("light") &&
            light->second.Get("light").IsInt())
            placeLight(light->second.Get("light").GetNumberAsInt(), to_world, pointer);
    }

    /// Direction of the node's -z axis in the world.
    vec3 forward(const glm::dmat4& to_world, const std::string& pointer) const {
        const glm::dvec3 axis = -glm::dvec3(to_world[2]);
        if (!(glm::length(axis) > 0.0))
            file_.fail(pointer, "its transform leaves no direction to look or shine to");
        return vec3(glm::normalize(axis));
    }

    void placeCamera(int index, const glm::dmat4& to_world, const std::string& node_name,
                     const std::string& pointer) {
        if (static_cast<std::size_t>(index) >= file_.model.cameras.size())
            file_.fail(pointer + "/camera", std::to_string(index) + ", but there are " +
                                                std::to_string(file_.model.cameras.size()));
        const tinygltf::Camera& camera = file_.model.cameras[static_cast<std::size_t>(index)];
        if (camera.type != "perspective") {
            warnings_.add("only perspective cameras are read", node_name);
            return;
        }
        CameraDesc desc;
        desc.name = camera.name.empty() ? node_name : printable(camera.name);
        desc.position = vec3(to_world[3]);
        desc.target = desc.position + forward(to_world, pointer);
        desc.up = vec3(to_world[1]);
        desc.fov_y_degrees = static_cast<float>(glm::degrees(camera.perspective.yfov));
        desc.near = static_cast<float>(camera.perspective.znear);
        try {
            (void)makeCamera(desc);
        } catch (const SceneError& error) {
            file_.fail("/cameras/" + std::to_string(index), error.what());
        }
        scene_.cameras.push_back(desc);
    }

    void placeLight(int index, const glm::dmat4& to_world, const std::string& pointer) {
        if (index < 0 || static_cast<std::size_t>(index) >= file_.model.lights.size())
            file_.fail(pointer + "/extensions/KHR_lights_punctual/light",
                       std::to_string(index) + ", but there are " +
                           std::to_string(file_.model.lights.size()) + " lights");
        const tinygltf::Light& source = file_.model.lights[static_cast<std::size_t>(index)];
        Light light{};
        if (source.type == "point")
            light.kind = kLightPoint;
        else if (source.type == "directional")
            light.kind = kLightDirectional;
        else if (source.type == "spot")
            light.kind = kLightSpot;
        else
            file_.fail("/extensions/KHR_lights_punctual/lights/" + std::to_string(index) + "/type",
                       "\"" + printable(source.type) + "\"; expected point, spot or directional");
        light.position = vec3(to_world[3]);
        light.direction = light.kind == kLightPoint ? vec3(0, -1, 0) : forward(to_world, pointer);
        for (int c = 0; c < 3; ++c) {
            const double color =
                source.color.size() == 3 ? source.color[static_cast<std::size_t>(c)] : 1.0;
            light.intensity[c] =
                static_cast<float>(std::clamp(color * source.intensity, 0.0, 1e30));
        }
        light.cos_inner = static_cast<float>(std::cos(source.spot.innerConeAngle));
        light.cos_outer = static_cast<float>(std::cos(source.spot.outerConeAngle));
        light.range = static_cast<float>(std::clamp(source.range, 0.0, 1e30));
        scene_.lights.push_back(light);
    }

    const GltfFile& file_;
    Scene& scene_;
    GltfGeometry& geometry_;
    GltfWarnings& warnings_;
    std::vector<State> states_;
};

} // namespace

void readGltf(const std::string& name, Scene& scene) {
    const GltfFile file = openGltf(name);
    GltfWarnings warnings(name);
    for (const std::string& part : file.ignored)
        warnings.add("static geometry only, so these are ignored", part);
    const auto first_material = static_cast<uint>(scene.materials.size());
    appendGltfMaterials(file, scene, warnings);
    GltfGeometry geometry(file, first_material, scene, warnings);
    NodeWalk(file, scene, geometry, warnings).run();
    const auto texts = warnings.texts();
    scene.warnings.insert(scene.warnings.end(), texts.begin(), texts.end());
}

} // namespace hone

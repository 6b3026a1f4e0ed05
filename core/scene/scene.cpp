// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/scene.h"

#include "hone/core/error.h"
#include "hone/core/scene/builtin_scenes.h"
#include "hone/core/scene/gltf.h"
#include "hone/core/scene/scene_file.h"

#include <cmath>

namespace hone {
namespace {

/// A model that brings no light is seen under a high sun and a pale sky, instead of black.
void addDefaultLight(Scene& scene) {
    if (!scene.lights.empty())
        return;
    Light sun{};
    sun.kind = kLightDirectional;
    sun.direction = glm::normalize(vec3(-0.4f, -1.0f, -0.3f));
    sun.intensity = vec3(2.5f);
    scene.lights.push_back(sun);
    scene.environment = {vec3(0.4f, 0.55f, 0.8f), vec3(0.8f), vec3(0.3f), vec3(0.25f)};
    scene.warnings.push_back(
        scene.name + " has no lights: a default sun and sky light it. A *.scene.json that names it "
                     "as its \"model\" can add lights of its own.");
}

bool hasEnding(std::string_view name, std::string_view ending) {
    return name.size() >= ending.size() && name.substr(name.size() - ending.size()) == ending;
}

} // namespace

Camera makeCamera(const CameraDesc& desc) {
    auto fail = [&](const std::string& what) {
        throw SceneError("camera \"" + desc.name + "\": " + what);
    };
    const vec3 view = desc.target - desc.position;
    const float distance = glm::length(view);
    if (!(distance > 0.0f) || !std::isfinite(distance))
        fail("position and target must be two different, finite points");
    if (!(desc.fov_y_degrees > 0.0f && desc.fov_y_degrees < 180.0f))
        fail("fov_y is " + std::to_string(desc.fov_y_degrees) +
             " degrees; expected more than 0 and less than 180");
    if (!(desc.near > 0.0f) || !std::isfinite(desc.near))
        fail("near is " + std::to_string(desc.near) + " m; expected more than 0");
    if (!(desc.aperture >= 0.0f) || !std::isfinite(desc.aperture))
        fail("aperture is " + std::to_string(desc.aperture) + " m; expected 0 or more");
    if (!(desc.focus > 0.0f) || !std::isfinite(desc.focus))
        fail("focus is " + std::to_string(desc.focus) + " m; expected more than 0");

    Camera camera{};
    camera.position = desc.position;
    camera.forward = view / distance;
    // Parallel means: nothing but rounding is left of `up` across the view.
    const vec3 across = glm::cross(camera.forward, desc.up);
    const float length = glm::length(across);
    if (!(length > 1e-6f * glm::length(desc.up)) || !std::isfinite(length))
        fail("up is parallel to the view; give an \"up\" that leans away from it");
    camera.right = across / length;
    camera.up = glm::cross(camera.right, camera.forward);
    camera.tan_half_fov_y =
        static_cast<float>(std::tan(0.5 * glm::radians(double{desc.fov_y_degrees})));
    camera.near = desc.near;
    camera.lens_radius = 0.5f * desc.aperture;
    camera.focus = desc.focus;
    return camera;
}

void Bounds::add(vec3 point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
}

const CameraDesc& Scene::camera(std::string_view camera_name) const {
    if (camera_name.empty() && !cameras.empty())
        return cameras.front();
    std::string names;
    for (const CameraDesc& candidate : cameras) {
        if (candidate.name == camera_name)
            return candidate;
        names += (names.empty() ? "" : ", ") + candidate.name;
    }
    throw SceneError(name + " has no camera \"" + std::string(camera_name) + "\"; it has " +
                     (names.empty() ? "none" : names));
}

std::size_t Scene::instancedTriangles() const {
    std::size_t total = 0;
    for (const Instance& instance : instances)
        total += meshes[instance.mesh].triangle_count;
    return total;
}

Scene loadScene(const std::string& name) {
    constexpr std::string_view kBuiltin = "builtin:";
    Scene scene;
    if (name.starts_with(kBuiltin)) {
        scene = makeBuiltinScene(std::string_view(name).substr(kBuiltin.size()));
        scene.name = name;
    } else if (hasEnding(name, ".scene.json")) {
        scene.name = name;
        if (!readSceneFile(name, scene))
            addDefaultLight(scene);
    } else if (hasEnding(name, ".gltf") || hasEnding(name, ".glb")) {
        scene.name = name;
        readGltf(name, scene);
        addDefaultLight(scene);
    } else {
        throw SceneError(name + ": not the name of a scene; expected builtin:NAME, a .scene.json, "
                                "a .gltf or a .glb");
    }
    if (scene.version == 0)
        finishScene(scene);
    return scene;
}

} // namespace hone

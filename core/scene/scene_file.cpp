// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/scene_file.h"

#include "hone/core/error.h"
#include "hone/core/image/image.h"
#include "hone/core/printable.h"
#include "hone/core/scene/builtin_scenes.h"
#include "hone/core/scene/gltf.h"
#include "hone/core/scene/model_folder.h"
#include "hone/core/scene/scene_json.h"
#include "hone/core/scene/scene_lights.h"

#include <algorithm>

namespace hone {
namespace {

using Json = nlohmann::json;

/// Runs `check`, which throws SceneError, and puts the place before its words.
template <class Check> void checkAt(const SceneObject& object, Check check) {
    try {
        check();
    } catch (const SceneError& error) {
        object.fail("", error.what());
    }
}

/// A thin lens by its diameter, or as photographers say it: focal length and f-number.
void readLens(const SceneObject& object, CameraDesc& camera) {
    camera.focus = object.number("focus", 0.0f, kMostInScene);
    if (object.has("aperture") == object.has("f_number"))
        object.fail("", "expected either \"aperture\", the lens's diameter in metres, or "
                        "\"focal_length\" and \"f_number\"");
    if (object.has("aperture")) {
        if (object.has("focal_length"))
            object.fail("/focal_length", "belongs to \"f_number\"; an aperture in metres says all");
        camera.aperture = object.number("aperture", 0.0f, kMostInScene);
        return;
    }
    const float focal_length = object.number("focal_length", 0.0f, kMostInScene);
    const float f_number = object.number("f_number", 0.0f, kMostInScene);
    if (!(f_number > 0.0f))
        object.fail("/f_number", "0; expected more");
    if (!(focal_length < camera.focus))
        object.fail("/focus", "a lens images nothing sharply that is not farther away than its "
                              "focal length");
    camera.aperture = focal_length / f_number;
}

/// All of a camera but its name.
CameraDesc readView(const SceneObject& object, const std::string& name) {
    CameraDesc camera;
    camera.name = name;
    camera.position = object.vector("position");
    camera.target = object.vector("target");
    if (object.has("up"))
        camera.up = object.vector("up");
    camera.fov_y_degrees = object.number("fov_y", 0.0f, 180.0f, camera.fov_y_degrees);
    camera.near = object.number("near", 0.0f, kMostInScene, camera.near);
    if (object.has("lens"))
        readLens(SceneObject(object.file(), object.pointer() + "/lens", object.require("lens"),
                             {"aperture", "focal_length", "f_number", "focus"}),
                 camera);
    checkAt(object, [&] { (void)makeCamera(camera); });
    return camera;
}

CameraPath readPath(const SceneObject& object) {
    CameraPath path{.name = printable(object.text("name")), .keys = {}};
    object.each("keys", [&](const Json& element, const std::string& pointer) {
        const SceneObject key(object.file(), pointer, element,
                              {"time", "position", "target", "up", "fov_y", "near", "lens"});
        const float time = key.number("time", -kMostInScene, kMostInScene);
        if (!path.keys.empty() && !(time > path.keys.back().time))
            key.fail("/time", "not later than the key before; expected ascending times");
        path.keys.push_back({time, readView(key, path.name)});
    });
    if (path.keys.empty())
        object.fail("", "expected \"keys\", an array of at least one camera with a \"time\"");
    return path;
}

Probe readProbe(const SceneObject& object, const Scene& scene) {
    Probe probe{object.vector("position"), kNone};
    if (object.has("object")) {
        const std::string wanted = object.text("object");
        const auto found = std::ranges::find(scene.instance_names, wanted);
        if (found == scene.instance_names.end())
            object.failName("/object", "no instance is called", wanted, scene.instance_names);
        probe.object = static_cast<uint>(found - scene.instance_names.begin());
    }
    return probe;
}

/// The instances of that name, or of the node of that name.
void readTaskObject(const SceneObject& root, const std::string& name, const std::string& pointer,
                    Scene& scene) {
    const std::size_t before = scene.task_objects.size();
    for (uint i = 0; i < scene.instance_names.size(); ++i)
        if (scene.instance_names[i] == name || scene.instance_names[i].starts_with(name + "/"))
            scene.task_objects.push_back(i);
    if (scene.task_objects.size() == before)
        root.failName(pointer, "no instance is called", name, scene.instance_names);
}

void changeMaterial(const SceneObject& object, Material& material) {
    if (object.has("base_color"))
        material.base_color = object.color("base_color", 1.0f);
    if (object.has("emission"))
        material.emission = object.color("emission", kMostInScene);
    if (object.has("mirror")) {
        material.f0 = object.color("mirror", 1.0f);
        material.flags &= ~kMaterialMirror;
        if (material.f0 != vec3(0.0f))
            material.flags |= kMaterialMirror;
    }
    if (object.has("two_sided")) {
        material.flags &= ~kMaterialTwoSided;
        if (object.boolean("two_sided"))
            material.flags |= kMaterialTwoSided;
    }
}

void changeMaterials(const SceneObject& root, Scene& scene) {
    if (!root.has("materials"))
        return;
    const Json& changes = root.require("materials");
    if (!changes.is_object())
        root.fail("/materials", "expected an object of material names");
    for (const auto& item : changes.items()) {
        const std::string pointer = "/materials/" + printable(item.key());
        const SceneObject object(root.file(), pointer, item.value(),
                                 {"base_color", "emission", "mirror", "two_sided"});
        bool is_found = false;
        for (std::size_t i = 0; i < scene.materials.size(); ++i)
            if (scene.material_names[i] == item.key()) {
                changeMaterial(object, scene.materials[i]);
                is_found = true;
            }
        if (!is_found)
            object.failName("", "no material is called", item.key(), scene.material_names);
    }
}

void readModel(const SceneObject& root, Scene& scene) {
    if (!root.has("model"))
        return;
    constexpr std::string_view kBuiltin = "builtin:";
    const std::string model = root.text("model");
    if (!model.starts_with(kBuiltin)) {
        const std::filesystem::path folder = std::filesystem::path(root.file()).parent_path();
        readGltf((folder / model).lexically_normal().string(), scene);
        return;
    }
    const std::string name = scene.name;
    scene = makeBuiltinScene(std::string_view(model).substr(kBuiltin.size()));
    scene.name = name;
    scene.version = 0; // to be finished again, with what this file adds
    if (root.has("probes"))
        scene.probes.clear();
    if (root.has("task_objects"))
        scene.task_objects.clear();
}

} // namespace

bool readSceneFile(const std::string& name, Scene& scene) {
    std::vector<std::byte> bytes;
    try {
        bytes = readFile(name);
    } catch (const InputError& error) {
        throw SceneError(error.what());
    }
    const Json json =
        parseSceneJson(name, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    const SceneObject root(name, "", json,
                           {"$schema", "doc", "model", "cameras", "paths", "lights", "environment",
                            "probes", "task_objects", "materials"});
    readModel(root, scene);

    std::vector<CameraDesc> cameras;
    root.each("cameras", [&](const Json& element, const std::string& pointer) {
        const SceneObject object(name, pointer, element,
                                 {"name", "position", "target", "up", "fov_y", "near", "lens"});
        cameras.push_back(readView(object, printable(object.text("name"))));
    });
    scene.cameras.insert(scene.cameras.begin(), cameras.begin(), cameras.end());
    std::vector<CameraPath> paths;
    root.each("paths", [&](const Json& element, const std::string& pointer) {
        paths.push_back(readPath(SceneObject(name, pointer, element, {"name", "keys"})));
    });
    scene.paths.insert(scene.paths.begin(), paths.begin(), paths.end());
    root.each("lights", [&](const Json& element, const std::string& pointer) {
        scene.lights.push_back(readSceneLight(name, element, pointer));
    });
    root.each("probes", [&](const Json& element, const std::string& pointer) {
        scene.probes.push_back(
            readProbe(SceneObject(name, pointer, element, {"position", "object"}), scene));
    });
    root.each("task_objects", [&](const Json& element, const std::string& pointer) {
        if (!element.is_string())
            root.fail(pointer, "expected the name of an instance");
        readTaskObject(root, element.get<std::string>(), pointer, scene);
    });
    if (root.has("environment")) {
        const SceneObject object(name, "/environment", root.require("environment"),
                                 {"zenith", "horizon", "ground", "ambient"});
        auto color = [&](const char* key) {
            return object.has(key) ? object.color(key, kMostInScene) : vec3(0.0f);
        };
        scene.environment = {color("zenith"), color("horizon"), color("ground"), color("ambient")};
    }
    changeMaterials(root, scene);
    return root.has("lights") || root.has("environment");
}

} // namespace hone

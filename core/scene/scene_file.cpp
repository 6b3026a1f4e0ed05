// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/scene_file.h"

#include "hone/core/error.h"
#include "hone/core/graph/diagnostics.h"
#include "hone/core/image/image.h"
#include "hone/core/printable.h"
#include "hone/core/scene/builtin_scenes.h"
#include "hone/core/scene/gltf.h"
#include "hone/core/scene/model_folder.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace hone {
namespace {

using Json = nlohmann::json;

constexpr float kMost = 1e30f; ///< of what is unbounded but must stay finite

/// An object of the file. Knows its place for messages, and refuses keys that nobody reads.
class Object {
public:
    Object(const std::string& file, std::string pointer, const Json& json,
           const std::vector<std::string>& keys)
        : file_(file), pointer_(std::move(pointer)), json_(json) {
        if (!json.is_object())
            fail("", "expected an object");
        for (const auto& item : json.items())
            if (std::ranges::find(keys, item.key()) == keys.end())
                failName("/" + printable(item.key()), "unknown key", item.key(), keys);
    }

    [[noreturn]] void fail(const std::string& place, const std::string& what) const {
        const std::string where = pointer_ + place;
        throw SceneError(file_ + (where.empty() ? "" : " " + where) + ": " + what);
    }

    /// Fails for a name that is none of `candidates`, with the one that may be meant, or all.
    [[noreturn]] void failName(const std::string& place, const std::string& what,
                               std::string_view name,
                               const std::vector<std::string>& candidates) const {
        const std::string near = nearest(name, candidates);
        std::string all;
        for (std::size_t i = 0; i < std::min<std::size_t>(candidates.size(), 12); ++i)
            all += (i == 0 ? "" : ", ") + candidates[i];
        fail(place,
             what + " \"" + printable(name) + "\". " +
                 (!near.empty() ? "Did you mean \"" + near + "\"?"
                  : all.empty() ? "There are none."
                                : "There are: " + all + (candidates.size() > 12 ? ", ..." : "")));
    }

    [[nodiscard]] bool has(const char* key) const { return json_.contains(key); }

    [[nodiscard]] std::string text(const char* key) const {
        const Json& value = require(key);
        if (!value.is_string())
            fail(place(key), "expected a string");
        return value.get<std::string>();
    }

    [[nodiscard]] bool boolean(const char* key) const {
        const Json& value = require(key);
        if (!value.is_boolean())
            fail(place(key), "expected true or false");
        return value.get<bool>();
    }

    [[nodiscard]] float number(const char* key, float low, float high) const {
        return toNumber(require(key), place(key), low, high);
    }
    [[nodiscard]] float number(const char* key, float low, float high, float fallback) const {
        return has(key) ? number(key, low, high) : fallback;
    }

    [[nodiscard]] vec3 vector(const char* key) const {
        return toVector(require(key), place(key), -kMost, kMost, "[x, y, z]");
    }

    /// One number for grey, or [r, g, b].
    [[nodiscard]] vec3 color(const char* key, float high) const {
        const Json& value = require(key);
        if (value.is_number())
            return vec3(toNumber(value, place(key), 0.0f, high));
        return toVector(value, place(key), 0.0f, high, "a number or [r, g, b]");
    }

    /// Calls read(element, its pointer) for each element of an array that may be absent.
    template <class Read> void each(const char* key, Read read) const {
        if (!has(key))
            return;
        const Json& array = json_[key];
        if (!array.is_array())
            fail(place(key), "expected an array");
        for (std::size_t i = 0; i < array.size(); ++i)
            read(array[i], pointer_ + place(key) + "/" + std::to_string(i));
    }

    [[nodiscard]] const Json& require(const char* key) const {
        if (!has(key))
            fail("", std::string("has no \"") + key + "\"");
        return json_[key];
    }

    [[nodiscard]] const std::string& pointer() const { return pointer_; }
    [[nodiscard]] const std::string& file() const { return file_; }

private:
    static std::string place(const char* key) { return std::string("/") + key; }

    [[nodiscard]] float toNumber(const Json& value, const std::string& place, float low,
                                 float high) const {
        const double number = value.is_number() ? value.get<double>() : 0.0;
        if (!value.is_number() || !(number >= low && number <= high)) {
            const std::string range =
                high < kMost   ? "a number from " + Json(low).dump() + " to " + Json(high).dump()
                : low > -kMost ? "a number, " + Json(low).dump() + " or more"
                               : "a number";
            fail(place, printable(value.dump()) + "; expected " + range);
        }
        return static_cast<float>(number);
    }

    [[nodiscard]] vec3 toVector(const Json& value, const std::string& place, float low, float high,
                                const char* expected) const {
        if (!value.is_array() || value.size() != 3)
            fail(place, printable(value.dump()) + "; expected " + expected);
        vec3 vector(0.0f);
        for (int i = 0; i < 3; ++i)
            vector[i] = toNumber(value[static_cast<std::size_t>(i)],
                                 place + "/" + std::to_string(i), low, high);
        return vector;
    }

    const std::string& file_;
    std::string pointer_;
    const Json& json_;
};

/// "line:column", both from 1, of a byte counted from 1 as nlohmann does.
std::string lineAndColumn(std::string_view text, std::size_t byte) {
    const std::string_view before = text.substr(0, byte == 0 ? 0 : std::min(byte - 1, text.size()));
    const auto line = 1 + std::ranges::count(before, '\n');
    const std::size_t newline = before.rfind('\n');
    const std::size_t column =
        newline == std::string_view::npos ? before.size() + 1 : before.size() - newline;
    return std::to_string(line) + ":" + std::to_string(column);
}

/// Parses with comments; refuses keys written twice, of which a reader would silently drop one.
Json parse(const std::string& file, std::string_view text) {
    std::vector<std::set<std::string>> open;
    auto watch = [&](int depth, Json::parse_event_t event, Json& parsed) {
        if (depth > 64)
            throw SceneError(file + ": JSON nested deeper than 64 levels");
        if (event == Json::parse_event_t::object_start)
            open.emplace_back();
        else if (event == Json::parse_event_t::object_end)
            open.pop_back();
        else if (event == Json::parse_event_t::key &&
                 !open.back().insert(parsed.get<std::string>()).second)
            throw SceneError(file + ": the key \"" + printable(parsed.get<std::string>()) +
                             "\" appears twice in one object");
        return true;
    };
    try {
        return Json::parse(text, watch, true, true);
    } catch (const Json::parse_error& error) {
        std::string what = error.what();
        // nlohmann's own prefix repeats the place: "[json...] parse error at line 1, column 2: ".
        if (const std::size_t colon = what.find(": "); colon != std::string::npos)
            what.erase(0, colon + 2);
        throw SceneError(file + ":" + lineAndColumn(text, error.byte) + ": " + printable(what));
    } catch (const Json::exception& error) {
        throw SceneError(file + ": " + printable(error.what()));
    }
}

/// Runs `check`, which throws SceneError, and puts the place before its words.
template <class Check> void checkAt(const Object& object, Check check) {
    try {
        check();
    } catch (const SceneError& error) {
        object.fail("", error.what());
    }
}

/// A thin lens by its diameter, or as photographers say it: focal length and f-number.
void readLens(const Object& object, CameraDesc& camera) {
    camera.focus = object.number("focus", 0.0f, kMost);
    if (object.has("aperture") == object.has("f_number"))
        object.fail("", "expected either \"aperture\", the lens's diameter in metres, or "
                        "\"focal_length\" and \"f_number\"");
    if (object.has("aperture")) {
        if (object.has("focal_length"))
            object.fail("/focal_length", "belongs to \"f_number\"; an aperture in metres says all");
        camera.aperture = object.number("aperture", 0.0f, kMost);
        return;
    }
    const float focal_length = object.number("focal_length", 0.0f, kMost);
    const float f_number = object.number("f_number", 0.0f, kMost);
    if (!(f_number > 0.0f))
        object.fail("/f_number", "0; expected more");
    if (!(focal_length < camera.focus))
        object.fail("/focus", "a lens images nothing sharply that is not farther away than its "
                              "focal length");
    camera.aperture = focal_length / f_number;
}

/// All of a camera but its name.
CameraDesc readView(const Object& object, const std::string& name) {
    CameraDesc camera;
    camera.name = name;
    camera.position = object.vector("position");
    camera.target = object.vector("target");
    if (object.has("up"))
        camera.up = object.vector("up");
    camera.fov_y_degrees = object.number("fov_y", 0.0f, 180.0f, camera.fov_y_degrees);
    camera.near = object.number("near", 0.0f, kMost, camera.near);
    if (object.has("lens"))
        readLens(Object(object.file(), object.pointer() + "/lens", object.require("lens"),
                        {"aperture", "focal_length", "f_number", "focus"}),
                 camera);
    checkAt(object, [&] { (void)makeCamera(camera); });
    return camera;
}

CameraPath readPath(const Object& object) {
    CameraPath path{.name = printable(object.text("name")), .keys = {}};
    object.each("keys", [&](const Json& element, const std::string& pointer) {
        const Object key(object.file(), pointer, element,
                         {"time", "position", "target", "up", "fov_y", "near", "lens"});
        const float time = key.number("time", -kMost, kMost);
        if (!path.keys.empty() && !(time > path.keys.back().time))
            key.fail("/time", "not later than the key before; expected ascending times");
        path.keys.push_back({time, readView(key, path.name)});
    });
    if (path.keys.empty())
        object.fail("", "expected \"keys\", an array of at least one camera with a \"time\"");
    return path;
}

vec3 readDirection(const Object& object, const char* key) {
    const vec3 direction = object.vector(key);
    const float length = glm::length(direction);
    if (!(length > 0.0f) || !std::isfinite(length))
        object.fail(std::string("/") + key, "a direction of no length");
    return direction / length;
}

Light readRectangle(const Object& object) {
    Light light{};
    light.kind = kLightRectangle;
    light.position = object.vector("center");
    light.half_u = 0.5f * object.vector("edge_u");
    light.half_v = 0.5f * object.vector("edge_v");
    light.intensity = object.color("radiance", kMost);
    const vec3 normal = glm::cross(light.half_u, light.half_v);
    const float length = glm::length(normal);
    if (!(length > 0.0f) || !std::isfinite(length))
        object.fail("/edge_v", "the edges span no area: edge_u and edge_v must not be parallel");
    light.direction = normal / length;
    return light;
}

float readRadius(const Object& object) {
    const float radius = object.number("radius", 0.0f, kMost);
    if (!(radius > 0.0f))
        object.fail("/radius", "0; expected more. A light without extent is of type \"point\"");
    return radius;
}

Light readDisc(const Object& object) {
    Light light{};
    light.kind = kLightDisc;
    light.position = object.vector("center");
    light.direction = readDirection(object, "direction");
    const float radius = readRadius(object);
    // Any two radii that are perpendicular do: those along the axis that is farthest from the
    // normal.
    const vec3 normal = glm::abs(light.direction);
    const vec3 axis = normal.x <= normal.y && normal.x <= normal.z ? vec3(1, 0, 0)
                      : normal.y <= normal.z                       ? vec3(0, 1, 0)
                                                                   : vec3(0, 0, 1);
    light.half_u = radius * glm::normalize(glm::cross(light.direction, axis));
    light.half_v = glm::cross(light.direction, light.half_u);
    light.intensity = object.color("radiance", kMost);
    return light;
}

Light readSphere(const Object& object) {
    Light light{};
    light.kind = kLightSphere;
    light.position = object.vector("center");
    light.direction = vec3(0, -1, 0);
    light.radius = readRadius(object);
    light.intensity = object.color("radiance", kMost);
    return light;
}

Light readDirectional(const Object& object) {
    Light light{};
    light.kind = kLightDirectional;
    light.direction = readDirection(object, "direction");
    light.intensity = object.color("irradiance", kMost);
    light.radius = std::tan(glm::radians(0.5f * object.number("angle", 0.0f, 90.0f, 0.0f)));
    return light;
}

Light readPoint(const Object& object) {
    Light light{};
    light.kind = kLightPoint;
    light.position = object.vector("position");
    light.direction = vec3(0, -1, 0);
    light.intensity = object.color("intensity", kMost);
    light.range = object.number("range", 0.0f, kMost, 0.0f);
    return light;
}

Light readSpot(const Object& object) {
    Light light{};
    light.kind = kLightSpot;
    light.position = object.vector("position");
    light.direction = readDirection(object, "direction");
    light.intensity = object.color("intensity", kMost);
    const float outer = object.number("outer", 0.0f, 90.0f, 45.0f);
    const float inner = object.number("inner", 0.0f, outer, 0.0f);
    light.cos_outer = std::cos(glm::radians(outer));
    light.cos_inner = std::cos(glm::radians(inner));
    light.range = object.number("range", 0.0f, kMost, 0.0f);
    return light;
}

Light readLight(const std::string& file, const Json& json, const std::string& pointer) {
    // The type decides which keys there may be, so it is read first.
    struct Type {
        const char* name;
        std::vector<std::string> keys;
        Light (*read)(const Object&);
    };
    static const std::vector<Type> kTypes{
        {"point", {"position", "intensity", "range"}, readPoint},
        {"spot", {"position", "direction", "intensity", "inner", "outer", "range"}, readSpot},
        {"directional", {"direction", "irradiance", "angle"}, readDirectional},
        {"rectangle", {"center", "edge_u", "edge_v", "radiance"}, readRectangle},
        {"disc", {"center", "direction", "radius", "radiance"}, readDisc},
        {"sphere", {"center", "radius", "radiance"}, readSphere}};
    if (!json.is_object() || !json.contains("type"))
        throw SceneError(file + " " + pointer + ": expected an object with a \"type\"");
    const Object untyped(file, pointer, Json::object(), {});
    if (!json["type"].is_string())
        untyped.fail("/type", "expected a string");
    const std::string wanted = json["type"].get<std::string>();
    const auto type =
        std::ranges::find_if(kTypes, [&](const Type& each) { return each.name == wanted; });
    if (type == kTypes.end()) {
        std::vector<std::string> names;
        for (const Type& each : kTypes)
            names.emplace_back(each.name);
        untyped.failName("/type", "unknown type of light", wanted, names);
    }
    std::vector<std::string> keys = type->keys;
    keys.insert(keys.end(), {"type", "casts_shadow"});
    const Object object(file, pointer, json, keys);
    Light light = type->read(object);
    light.shadowless = object.has("casts_shadow") && !object.boolean("casts_shadow") ? 1u : 0u;
    return light;
}

Probe readProbe(const Object& object, const Scene& scene) {
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
void readTaskObject(const Object& root, const std::string& name, const std::string& pointer,
                    Scene& scene) {
    const std::size_t before = scene.task_objects.size();
    for (uint i = 0; i < scene.instance_names.size(); ++i)
        if (scene.instance_names[i] == name || scene.instance_names[i].starts_with(name + "/"))
            scene.task_objects.push_back(i);
    if (scene.task_objects.size() == before)
        root.failName(pointer, "no instance is called", name, scene.instance_names);
}

void changeMaterial(const Object& object, Material& material) {
    if (object.has("base_color"))
        material.base_color = object.color("base_color", 1.0f);
    if (object.has("emission"))
        material.emission = object.color("emission", kMost);
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

void changeMaterials(const Object& root, Scene& scene) {
    if (!root.has("materials"))
        return;
    const Json& changes = root.require("materials");
    if (!changes.is_object())
        root.fail("/materials", "expected an object of material names");
    for (const auto& item : changes.items()) {
        const std::string pointer = "/materials/" + printable(item.key());
        const Object object(root.file(), pointer, item.value(),
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

void readModel(const Object& root, Scene& scene) {
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
    const Json json = parse(name, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    const Object root(name, "", json,
                      {"$schema", "doc", "model", "cameras", "paths", "lights", "environment",
                       "probes", "task_objects", "materials"});
    readModel(root, scene);

    std::vector<CameraDesc> cameras;
    root.each("cameras", [&](const Json& element, const std::string& pointer) {
        const Object object(name, pointer, element,
                            {"name", "position", "target", "up", "fov_y", "near", "lens"});
        cameras.push_back(readView(object, printable(object.text("name"))));
    });
    scene.cameras.insert(scene.cameras.begin(), cameras.begin(), cameras.end());
    std::vector<CameraPath> paths;
    root.each("paths", [&](const Json& element, const std::string& pointer) {
        paths.push_back(readPath(Object(name, pointer, element, {"name", "keys"})));
    });
    scene.paths.insert(scene.paths.begin(), paths.begin(), paths.end());
    root.each("lights", [&](const Json& element, const std::string& pointer) {
        scene.lights.push_back(readLight(name, element, pointer));
    });
    root.each("probes", [&](const Json& element, const std::string& pointer) {
        scene.probes.push_back(
            readProbe(Object(name, pointer, element, {"position", "object"}), scene));
    });
    root.each("task_objects", [&](const Json& element, const std::string& pointer) {
        if (!element.is_string())
            root.fail(pointer, "expected the name of an instance");
        readTaskObject(root, element.get<std::string>(), pointer, scene);
    });
    if (root.has("environment")) {
        const Object object(name, "/environment", root.require("environment"),
                            {"zenith", "horizon", "ground", "ambient"});
        auto color = [&](const char* key) {
            return object.has(key) ? object.color(key, kMost) : vec3(0.0f);
        };
        scene.environment = {color("zenith"), color("horizon"), color("ground"), color("ambient")};
    }
    changeMaterials(root, scene);
    return root.has("lights") || root.has("environment");
}

} // namespace hone

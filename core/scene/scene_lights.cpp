// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/scene_lights.h"

#include "hone/core/error.h"
#include "hone/core/scene/scene_json.h"

#include <algorithm>
#include <cmath>

namespace hone {

using Json = nlohmann::json;

namespace {

Light readRectangle(const SceneObject& object) {
    Light light{};
    light.kind = kLightRectangle;
    light.position = object.vector("center");
    light.half_u = 0.5f * object.vector("edge_u");
    light.half_v = 0.5f * object.vector("edge_v");
    light.intensity = object.color("radiance", kMostInScene);
    const vec3 normal = glm::cross(light.half_u, light.half_v);
    const float length = glm::length(normal);
    if (!(length > 0.0f) || !std::isfinite(length))
        object.fail("/edge_v", "the edges span no area: edge_u and edge_v must not be parallel");
    light.direction = normal / length;
    return light;
}

float readRadius(const SceneObject& object) {
    const float radius = object.number("radius", 0.0f, kMostInScene);
    if (!(radius > 0.0f))
        object.fail("/radius", "0; expected more. A light without extent is of type \"point\"");
    return radius;
}

Light readDisc(const SceneObject& object) {
    Light light{};
    light.kind = kLightDisc;
    light.position = object.vector("center");
    light.direction = object.direction("direction");
    const float radius = readRadius(object);
    // Any two radii that are perpendicular do: those along the axis that is farthest from the
    // normal.
    const vec3 normal = glm::abs(light.direction);
    const vec3 axis = normal.x <= normal.y && normal.x <= normal.z ? vec3(1, 0, 0)
                      : normal.y <= normal.z                       ? vec3(0, 1, 0)
                                                                   : vec3(0, 0, 1);
    light.half_u = radius * glm::normalize(glm::cross(light.direction, axis));
    light.half_v = glm::cross(light.direction, light.half_u);
    light.intensity = object.color("radiance", kMostInScene);
    return light;
}

Light readSphere(const SceneObject& object) {
    Light light{};
    light.kind = kLightSphere;
    light.position = object.vector("center");
    light.direction = vec3(0, -1, 0);
    light.radius = readRadius(object);
    light.intensity = object.color("radiance", kMostInScene);
    return light;
}

Light readDirectional(const SceneObject& object) {
    Light light{};
    light.kind = kLightDirectional;
    light.direction = object.direction("direction");
    light.intensity = object.color("irradiance", kMostInScene);
    light.radius = std::tan(glm::radians(0.5f * object.number("angle", 0.0f, 90.0f, 0.0f)));
    return light;
}

Light readPoint(const SceneObject& object) {
    Light light{};
    light.kind = kLightPoint;
    light.position = object.vector("position");
    light.direction = vec3(0, -1, 0);
    light.intensity = object.color("intensity", kMostInScene);
    light.range = object.number("range", 0.0f, kMostInScene, 0.0f);
    return light;
}

Light readSpot(const SceneObject& object) {
    Light light{};
    light.kind = kLightSpot;
    light.position = object.vector("position");
    light.direction = object.direction("direction");
    light.intensity = object.color("intensity", kMostInScene);
    const float outer = object.number("outer", 0.0f, 90.0f, 45.0f);
    const float inner = object.number("inner", 0.0f, outer, 0.0f);
    light.cos_outer = std::cos(glm::radians(outer));
    light.cos_inner = std::cos(glm::radians(inner));
    light.range = object.number("range", 0.0f, kMostInScene, 0.0f);
    return light;
}

} // namespace

Light readSceneLight(const std::string& file, const Json& json, const std::string& pointer) {
    // The type decides which keys there may be, so it is read first.
    struct Type {
        const char* name;
        std::vector<std::string> keys;
        Light (*read)(const SceneObject&);
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
    const SceneObject untyped(file, pointer, Json::object(), {});
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
    const SceneObject object(file, pointer, json, keys);
    Light light = type->read(object);
    light.shadowless = object.has("casts_shadow") && !object.boolean("casts_shadow") ? 1u : 0u;
    return light;
}

} // namespace hone

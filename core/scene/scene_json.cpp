// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/scene_json.h"

#include "hone/core/error.h"
#include "hone/core/graph/diagnostics.h"
#include "hone/core/printable.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace hone {

using Json = nlohmann::json;

namespace {

std::string placeOf(const char* key) {
    return std::string("/") + key;
}

/// "line:column", both from 1, of a byte counted from 1 as nlohmann does.
std::string lineAndColumn(std::string_view text, std::size_t byte) {
    const std::string_view before = text.substr(0, byte == 0 ? 0 : std::min(byte - 1, text.size()));
    const auto line = 1 + std::ranges::count(before, '\n');
    const std::size_t newline = before.rfind('\n');
    const std::size_t column =
        newline == std::string_view::npos ? before.size() + 1 : before.size() - newline;
    return std::to_string(line) + ":" + std::to_string(column);
}

} // namespace

SceneObject::SceneObject(const std::string& file, std::string pointer, const Json& json,
                         const std::vector<std::string>& keys)
    : file_(file), pointer_(std::move(pointer)), json_(json) {
    if (!json.is_object())
        fail("", "expected an object");
    for (const auto& item : json.items())
        if (std::ranges::find(keys, item.key()) == keys.end())
            failName("/" + printable(item.key()), "unknown key", item.key(), keys);
}

void SceneObject::fail(const std::string& place, const std::string& what) const {
    const std::string where = pointer_ + place;
    throw SceneError(file_ + (where.empty() ? "" : " " + where) + ": " + what);
}

void SceneObject::failName(const std::string& place, const std::string& what, std::string_view name,
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

const Json& SceneObject::require(const char* key) const {
    if (!has(key))
        fail("", std::string("has no \"") + key + "\"");
    return json_[key];
}

std::string SceneObject::text(const char* key) const {
    const Json& value = require(key);
    if (!value.is_string())
        fail(placeOf(key), "expected a string");
    return value.get<std::string>();
}

bool SceneObject::boolean(const char* key) const {
    const Json& value = require(key);
    if (!value.is_boolean())
        fail(placeOf(key), "expected true or false");
    return value.get<bool>();
}

float SceneObject::number(const char* key, float low, float high) const {
    return toNumber(require(key), placeOf(key), low, high);
}

vec3 SceneObject::vector(const char* key) const {
    return toVector(require(key), placeOf(key), -kMostInScene, kMostInScene, "[x, y, z]");
}

vec3 SceneObject::direction(const char* key) const {
    const vec3 direction = vector(key);
    const float length = glm::length(direction);
    if (!(length > 0.0f) || !std::isfinite(length))
        fail(placeOf(key), "a direction of no length");
    return direction / length;
}

vec3 SceneObject::color(const char* key, float high) const {
    const Json& value = require(key);
    if (value.is_number())
        return vec3(toNumber(value, placeOf(key), 0.0f, high));
    return toVector(value, placeOf(key), 0.0f, high, "a number or [r, g, b]");
}

float SceneObject::toNumber(const Json& value, const std::string& place, float low,
                            float high) const {
    const double number = value.is_number() ? value.get<double>() : 0.0;
    if (!value.is_number() || !(number >= low && number <= high)) {
        const std::string range =
            high < kMostInScene   ? "a number from " + Json(low).dump() + " to " + Json(high).dump()
            : low > -kMostInScene ? "a number, " + Json(low).dump() + " or more"
                                  : "a number";
        fail(place, printable(value.dump()) + "; expected " + range);
    }
    return static_cast<float>(number);
}

vec3 SceneObject::toVector(const Json& value, const std::string& place, float low, float high,
                           const char* expected) const {
    if (!value.is_array() || value.size() != 3)
        fail(place, printable(value.dump()) + "; expected " + expected);
    vec3 vector(0.0f);
    for (int i = 0; i < 3; ++i)
        vector[i] = toNumber(value[static_cast<std::size_t>(i)], place + "/" + std::to_string(i),
                             low, high);
    return vector;
}

Json parseSceneJson(const std::string& file, std::string_view text) {
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

} // namespace hone

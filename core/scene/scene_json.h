// SPDX-License-Identifier: Apache-2.0
//
// Reading the JSON of a scene file: objects that know their place. Of core/scene's own readers.
#pragma once

#include "hone/core/math.h"

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace hone {

/// Of numbers that are unbounded but must stay finite.
inline constexpr float kMostInScene = 1e30f;

/// An object of a scene file. Knows its place for messages, and refuses keys that nobody reads. All
/// of its functions throw SceneError that names the file, the JSON pointer and what was expected.
class SceneObject {
public:
    /// `keys`: all that there may be. The arguments must outlive it.
    SceneObject(const std::string& file, std::string pointer, const nlohmann::json& json,
                const std::vector<std::string>& keys);

    [[noreturn]] void fail(const std::string& place, const std::string& what) const;
    /// Fails for a name that is none of `candidates`, with the one that may be meant, or all.
    [[noreturn]] void failName(const std::string& place, const std::string& what,
                               std::string_view name,
                               const std::vector<std::string>& candidates) const;

    [[nodiscard]] bool has(const char* key) const { return json_.contains(key); }
    [[nodiscard]] const nlohmann::json& require(const char* key) const;
    [[nodiscard]] std::string text(const char* key) const;
    [[nodiscard]] bool boolean(const char* key) const;
    [[nodiscard]] float number(const char* key, float low, float high) const;
    [[nodiscard]] float number(const char* key, float low, float high, float fallback) const {
        return has(key) ? number(key, low, high) : fallback;
    }
    [[nodiscard]] vec3 vector(const char* key) const;
    /// A vector of length 1 in the direction of the one there.
    [[nodiscard]] vec3 direction(const char* key) const;
    /// One number for grey, or [r, g, b].
    [[nodiscard]] vec3 color(const char* key, float high) const;

    /// Calls read(element, its pointer) for each element of an array that may be absent.
    template <class Read> void each(const char* key, Read read) const {
        if (!has(key))
            return;
        const nlohmann::json& array = json_[key];
        if (!array.is_array())
            fail(std::string("/") + key, "expected an array");
        for (std::size_t i = 0; i < array.size(); ++i)
            read(array[i], pointer_ + "/" + key + "/" + std::to_string(i));
    }

    [[nodiscard]] const std::string& pointer() const { return pointer_; }
    [[nodiscard]] const std::string& file() const { return file_; }

private:
    [[nodiscard]] float toNumber(const nlohmann::json& value, const std::string& place, float low,
                                 float high) const;
    [[nodiscard]] vec3 toVector(const nlohmann::json& value, const std::string& place, float low,
                                float high, const char* expected) const;

    const std::string& file_;
    std::string pointer_;
    const nlohmann::json& json_;
};

/// Parses with comments; refuses keys written twice, of which a reader would silently drop one.
/// Throws SceneError: file:line:column.
[[nodiscard]] nlohmann::json parseSceneJson(const std::string& file, std::string_view text);

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/error.h"
#include "hone/core/scene/scene.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace hone {

/// A folder of its own for one test, gone afterwards.
class ScratchFolder {
public:
    ScratchFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "hone-XXXXXX").string();
        path_ = ::mkdtemp(pattern.data());
    }
    ~ScratchFolder() { std::filesystem::remove_all(path_); }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    std::string write(const std::string& name, std::string_view bytes) const {
        std::filesystem::create_directories((path_ / name).parent_path());
        std::ofstream(path_ / name, std::ios::binary) << bytes;
        return (path_ / name).string();
    }
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

/// A valid glTF of one unit square in the xy plane, facing +z: four vertices, two triangles, one
/// node, one material. Tests change `json` and `binary` and write it out.
struct SmallGltf {
    nlohmann::json json;
    std::string binary;

    /// Byte offsets in `binary`: positions, normals, texture coordinates, 16-bit indices.
    static constexpr std::size_t kPositions = 0;
    static constexpr std::size_t kNormals = 48;
    static constexpr std::size_t kUvs = 96;
    static constexpr std::size_t kIndices = 128;
    static constexpr std::size_t kBytes = 140;

    SmallGltf() {
        const float positions[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
        const float normals[] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
        const float uvs[] = {0, 1, 1, 1, 1, 0, 0, 0};
        const std::uint16_t indices[] = {0, 1, 2, 0, 2, 3};
        binary.resize(kBytes);
        put(kPositions, positions);
        put(kNormals, normals);
        put(kUvs, uvs);
        put(kIndices, indices);
        json = nlohmann::json::parse(R"({
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0, "name": "square"}],
            "meshes": [{"primitives": [
                {"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "indices": 3,
                 "material": 0}]}],
            "materials": [{"name": "paint"}],
            "accessors": [
                {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3"},
                {"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC2"},
                {"bufferView": 3, "componentType": 5123, "count": 6, "type": "SCALAR"}],
            "bufferViews": [
                {"buffer": 0, "byteOffset": 0, "byteLength": 48},
                {"buffer": 0, "byteOffset": 48, "byteLength": 48},
                {"buffer": 0, "byteOffset": 96, "byteLength": 32},
                {"buffer": 0, "byteOffset": 128, "byteLength": 12}],
            "buffers": [{"uri": "square.bin", "byteLength": 140}]
        })");
    }

    template <class T, std::size_t n> void put(std::size_t offset, const T (&values)[n]) {
        if (binary.size() < offset + sizeof(values))
            binary.resize(offset + sizeof(values));
        std::memcpy(&binary[offset], values, sizeof(values));
    }

    /// Appends values with a buffer view and an accessor for them; returns the accessor's index.
    template <class T, std::size_t n>
    std::size_t addAccessor(const T (&values)[n], int component_type, const char* type,
                            std::size_t count) {
        binary.resize((binary.size() + 3) / 4 * 4);
        const std::size_t offset = binary.size();
        put(offset, values);
        json["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", sizeof(values)}});
        json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                                     {"componentType", component_type},
                                     {"count", count},
                                     {"type", type}});
        json["buffers"][0]["byteLength"] = binary.size();
        return json["accessors"].size() - 1;
    }

    nlohmann::json& primitive() { return json["meshes"][0]["primitives"][0]; }

    std::string write(const ScratchFolder& folder) const {
        folder.write("square.bin", binary);
        return folder.write("square.gltf", json.dump());
    }

    std::string glb() const {
        nlohmann::json embedded = json;
        embedded["buffers"][0].erase("uri");
        std::string text = embedded.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        std::string padded = binary;
        padded.resize((padded.size() + 3) / 4 * 4);
        const auto size = static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + padded.size());
        return "glTF" + word(2) + word(size) + word(static_cast<std::uint32_t>(text.size())) +
               "JSON" + text + word(static_cast<std::uint32_t>(padded.size())) +
               std::string("BIN\0", 4) + padded;
    }

    static std::string word(std::uint32_t value) {
        std::string bytes(4, '\0');
        std::memcpy(bytes.data(), &value, 4); // little-endian hosts only, as all of hone's are
        return bytes;
    }
};

/// What loading says; "" and a failed test if it says nothing.
inline std::string loadError(const std::string& path) {
    try {
        (void)loadScene(path);
    } catch (const SceneError& error) {
        return error.what();
    }
    ADD_FAILURE() << path << " loads";
    return "";
}

/// Whether one of the warnings has all these words.
inline bool hasWarning(const Scene& scene, std::initializer_list<std::string> words) {
    for (const std::string& warning : scene.warnings) {
        bool has_all = true;
        for (const std::string& word : words)
            has_all = has_all && warning.find(word) != std::string::npos;
        if (has_all)
            return true;
    }
    return false;
}

} // namespace hone

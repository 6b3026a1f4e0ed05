// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/gltf_file.h"

#include "hone/core/error.h"
#include "hone/core/image/image.h"
#include "hone/core/printable.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>

namespace hone {
namespace {

using Json = nlohmann::json;

constexpr int kMaxJsonDepth = 64;
constexpr std::size_t kMaxNodes = 1'000'000;
constexpr std::uint64_t kMaxBufferBytes = 1ull << 31;

/// What hone reads of the ratified extensions; KHR_mesh_quantization only widens component types.
constexpr std::array<std::string_view, 5> kSupportedExtensions{
    "KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_materials_ior",
    "KHR_materials_transmission", "KHR_mesh_quantization"};

[[noreturn]] void failAt(const std::string& name, const std::string& pointer,
                         const std::string& what) {
    throw SceneError(name + (pointer.empty() ? "" : " " + pointer) + ": " + what);
}

std::string_view asText(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::uint32_t word(std::span<const std::byte> bytes, std::size_t offset) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value |= std::to_integer<std::uint32_t>(bytes[offset + i]) << (8 * i);
    return value;
}

struct Container {
    std::string_view json;
    std::optional<std::span<const std::byte>> binary; ///< the BIN chunk of a GLB
};

/// Takes a GLB apart (glTF 2.0 specification, section 4.4). Everything else is text.
Container openContainer(const std::string& name, std::span<const std::byte> file) {
    constexpr std::uint32_t kMagic = 0x46546c67;
    constexpr std::uint32_t kJsonChunk = 0x4e4f534a;
    constexpr std::uint32_t kBinaryChunk = 0x004e4942;
    const bool is_binary = file.size() >= 4 && word(file, 0) == kMagic;
    if (!is_binary) {
        if (name.ends_with(".glb"))
            failAt(name, "byte 0", "not a GLB file: it does not begin with \"glTF\"");
        return {asText(file), std::nullopt};
    }
    if (file.size() < 12)
        failAt(name, "byte 4", "the GLB header is cut off");
    if (word(file, 4) != 2)
        failAt(name, "byte 4",
               "GLB version " + std::to_string(word(file, 4)) + "; only version 2 is read");
    const std::size_t length = word(file, 8);
    if (length > file.size())
        failAt(name, "byte 8",
               "the header promises " + std::to_string(length) + " bytes, but the file has " +
                   std::to_string(file.size()) + "; it is truncated");

    Container container;
    for (std::size_t offset = 12; offset < length;) {
        const std::string place = "byte " + std::to_string(offset);
        if (length - offset < 8)
            failAt(name, place, "a chunk's header is cut off");
        const std::size_t size = word(file, offset);
        const std::uint32_t kind = word(file, offset + 4);
        offset += 8;
        if (size > length - offset)
            failAt(name, place,
                   "a chunk of " + std::to_string(size) + " bytes, but only " +
                       std::to_string(length - offset) + " follow");
        const auto chunk = file.subspan(offset, size);
        if (offset == 20 && kind != kJsonChunk)
            failAt(name, place, "the first chunk is not JSON");
        if (offset == 20)
            container.json = asText(chunk);
        else if (kind == kBinaryChunk && !container.binary)
            container.binary = chunk;
        offset += std::min((size + 3) / 4 * 4, length - offset);
    }
    return container;
}

Json parseJson(const std::string& name, std::string_view text) {
    // tinygltf recurses over extras and extensions: the depth is bounded before it sees them.
    auto limitDepth = [&](int depth, Json::parse_event_t, Json&) {
        if (depth > kMaxJsonDepth)
            failAt(name, "",
                   "JSON nested deeper than " + std::to_string(kMaxJsonDepth) + " levels");
        return true;
    };
    try {
        return Json::parse(text, limitDepth);
    } catch (const Json::exception& error) {
        // Cut nlohmann's own prefix "[json.exception.parse_error.101] ".
        std::string what = error.what();
        what.erase(0, what.find("] ") == std::string::npos ? 0 : what.find("] ") + 2);
        failAt(name, "", printable(what));
    }
}

/// One integer that is checked before the parser sees it, which would take a wrong one for absent.
struct IntegerRule {
    const char* array;
    const char* key;
    bool is_required;
    std::uint64_t max;
};
constexpr std::uint64_t kMaxIndex = 0x7fffffff;
constexpr std::uint64_t kMaxSize = 1ull << 53;
constexpr IntegerRule kIntegerRules[] = {
    {"accessors", "bufferView", false, kMaxIndex}, {"accessors", "byteOffset", false, kMaxSize},
    {"accessors", "componentType", true, 65535},   {"accessors", "count", true, kMaxSize},
    {"bufferViews", "buffer", true, kMaxIndex},    {"bufferViews", "byteOffset", false, kMaxSize},
    {"bufferViews", "byteLength", true, kMaxSize}, {"bufferViews", "byteStride", false, 252},
    {"nodes", "mesh", false, kMaxIndex},           {"nodes", "camera", false, kMaxIndex},
    {"buffers", "byteLength", true, kMaxSize},     {"images", "bufferView", false, kMaxIndex},
    {"textures", "source", false, kMaxIndex},      {"textures", "sampler", false, kMaxIndex},
};

void checkInteger(const std::string& name, const std::string& pointer, const Json& object,
                  const IntegerRule& rule) {
    const auto found = object.find(rule.key);
    if (found == object.end()) {
        if (rule.is_required)
            failAt(name, pointer, std::string("has no \"") + rule.key + "\"");
        return;
    }
    if (!found->is_number_unsigned() || found->get<std::uint64_t>() > rule.max)
        failAt(name, pointer + "/" + rule.key,
               printable(found->dump()) + "; expected an integer from 0 to " +
                   std::to_string(rule.max));
}

/// Whole arrays of objects, with plausible integers: what the parser would pass over in silence.
void checkStructure(const std::string& name, const Json& root) {
    if (!root.is_object())
        failAt(name, "", "not glTF: the JSON is no object");
    const auto asset = root.find("asset");
    if (asset == root.end() || !asset->is_object() || !asset->contains("version") ||
        !(*asset)["version"].is_string())
        failAt(name, "/asset/version", "missing; every glTF file has one");
    if (!(*asset)["version"].get<std::string>().starts_with("2."))
        failAt(name, "/asset/version",
               printable((*asset)["version"].get<std::string>()) + "; only glTF 2 is read");

    for (const char* array : {"accessors", "bufferViews", "buffers", "cameras", "images",
                              "materials", "meshes", "nodes", "scenes", "samplers", "textures"}) {
        const auto found = root.find(array);
        if (found == root.end())
            continue;
        if (!found->is_array())
            failAt(name, std::string("/") + array, "expected an array");
        for (std::size_t i = 0; i < found->size(); ++i) {
            const std::string pointer = std::string("/") + array + "/" + std::to_string(i);
            if (!(*found)[i].is_object())
                failAt(name, pointer, "expected an object");
            for (const IntegerRule& rule : kIntegerRules)
                if (std::string_view(rule.array) == array)
                    checkInteger(name, pointer, (*found)[i], rule);
        }
    }
    if (root.contains("nodes") && root["nodes"].size() > kMaxNodes)
        failAt(name, "/nodes", "more than " + std::to_string(kMaxNodes) + " nodes");
    if (!root.contains("meshes"))
        return;
    for (std::size_t m = 0; m < root["meshes"].size(); ++m) {
        const std::string pointer = "/meshes/" + std::to_string(m) + "/primitives";
        const auto primitives = root["meshes"][m].find("primitives");
        if (primitives == root["meshes"][m].end() || !primitives->is_array())
            failAt(name, pointer, "missing; expected an array");
        for (std::size_t p = 0; p < primitives->size(); ++p)
            if (!(*primitives)[p].is_object() || !(*primitives)[p].contains("attributes") ||
                !(*primitives)[p]["attributes"].is_object())
                failAt(name, pointer + "/" + std::to_string(p), "has no \"attributes\"");
    }
}

void checkExtensions(const std::string& name, const Json& root) {
    if (!root.contains("extensionsRequired") || !root["extensionsRequired"].is_array())
        return;
    std::string unknown;
    for (const Json& extension : root["extensionsRequired"]) {
        const std::string text = extension.is_string() ? extension.get<std::string>() : "?";
        if (std::ranges::find(kSupportedExtensions, text) == kSupportedExtensions.end())
            unknown += (unknown.empty() ? "" : ", ") + printable(text);
    }
    if (!unknown.empty())
        failAt(name, "/extensionsRequired",
               unknown + " not supported; export the model without it");
}

std::vector<std::byte> readBuffer(const GltfFile& file, const Json& buffer,
                                  const std::string& pointer,
                                  std::optional<std::span<const std::byte>> binary) {
    const auto length = buffer["byteLength"].get<std::uint64_t>();
    const auto uri = buffer.find("uri");
    std::vector<std::byte> bytes;
    std::string place = pointer;
    if (uri == buffer.end()) {
        if (!binary)
            file.fail(pointer, "has no \"uri\", and there is no binary chunk that it could mean");
        bytes.assign(binary->begin(), binary->end());
    } else {
        if (!uri->is_string())
            file.fail(pointer + "/uri", "expected a string");
        const std::string text = uri->get<std::string>();
        place += "/uri \"" + printable(text).substr(0, 64) + "\"";
        try {
            bytes = file.folder.read(text);
        } catch (const InputError& error) {
            file.fail(place, error.what());
        }
    }
    if (bytes.size() < length)
        file.fail(place, "byteLength is " + std::to_string(length) + ", but there are only " +
                             std::to_string(bytes.size()) + " bytes");
    bytes.resize(length);
    return bytes;
}

void readBuffers(GltfFile& file, const Json& root,
                 std::optional<std::span<const std::byte>> binary) {
    if (!root.contains("buffers"))
        return;
    std::uint64_t total = 0;
    for (std::size_t i = 0; i < root["buffers"].size(); ++i) {
        const std::string pointer = "/buffers/" + std::to_string(i);
        // Only the first buffer may mean the binary chunk.
        file.buffers.push_back(
            readBuffer(file, root["buffers"][i], pointer, i == 0 ? binary : std::nullopt));
        total += file.buffers.back().size();
        if (total > kMaxBufferBytes)
            file.fail(pointer, "the buffers are larger than 2 GiB together");
    }
}

void listImages(GltfFile& file, const Json& root) {
    if (!root.contains("images"))
        return;
    for (const Json& image : root["images"]) {
        GltfImage& listed = file.images.emplace_back();
        if (image.contains("uri") && image["uri"].is_string())
            listed.uri = image["uri"].get<std::string>();
        else if (image.contains("bufferView"))
            listed.buffer_view = image["bufferView"].get<std::int64_t>();
        listed.name = listed.uri.empty() || listed.uri.starts_with("data:")
                          ? "image " + std::to_string(file.images.size() - 1)
                          : printable(listed.uri);
    }
}

} // namespace

void GltfFile::fail(const std::string& pointer, const std::string& what) const {
    failAt(name, pointer, what);
}

std::span<const std::byte> GltfFile::view(std::int64_t index, const std::string& user) const {
    if (index < 0 || static_cast<std::size_t>(index) >= model.bufferViews.size())
        fail(user, "names buffer view " + std::to_string(index) + ", but there are " +
                       std::to_string(model.bufferViews.size()));
    const std::string pointer = "/bufferViews/" + std::to_string(index);
    const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(index)];
    if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= buffers.size())
        fail(pointer, "names buffer " + std::to_string(view.buffer) + ", but there are " +
                          std::to_string(buffers.size()));
    const std::span<const std::byte> buffer = buffers[static_cast<std::size_t>(view.buffer)];
    // Compared by differences: offset + length may wrap around.
    if (view.byteOffset > buffer.size() || view.byteLength > buffer.size() - view.byteOffset)
        fail(pointer, "byteOffset " + std::to_string(view.byteOffset) + " and byteLength " +
                          std::to_string(view.byteLength) + " reach past the " +
                          std::to_string(buffer.size()) + " bytes of buffer " +
                          std::to_string(view.buffer));
    return buffer.subspan(view.byteOffset, view.byteLength);
}

std::vector<std::byte> GltfFile::readImage(std::size_t index) const {
    const GltfImage& image = images[index];
    if (!image.uri.empty())
        return folder.read(image.uri);
    const auto bytes = view(image.buffer_view, "/images/" + std::to_string(index));
    return {bytes.begin(), bytes.end()};
}

GltfFile openGltf(const std::string& name) {
    std::vector<std::byte> bytes;
    std::optional<ModelFolder> folder;
    try {
        bytes = readFile(name);
        folder.emplace(name);
    } catch (const InputError& error) {
        throw SceneError(error.what());
    }
    const Container container = openContainer(name, bytes);
    Json root = parseJson(name, container.json);
    checkStructure(name, root);
    checkExtensions(name, root);

    GltfFile file{name, *std::move(folder), {}, {}, {}, {}};
    readBuffers(file, root, container.binary);
    listImages(file, root);
    for (const char* key : {"animations", "skins"})
        if (root.contains(key))
            file.ignored.emplace_back(key);
    for (const char* key : {"buffers", "images", "animations", "skins", "extras"})
        root.erase(key);
    try {
        file.model = parseGltfModel(root.dump());
    } catch (const InputError& error) {
        file.fail("", error.what());
    }
    return file;
}

} // namespace hone

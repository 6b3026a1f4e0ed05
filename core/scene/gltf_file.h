// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/scene/gltf_model.h"
#include "hone/core/scene/model_folder.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace hone {

/// Where the encoded bytes of an image are: a URI, or a buffer view if that is empty.
struct GltfImage {
    std::string uri;
    std::int64_t buffer_view = -1;
    std::string name; ///< for messages: the URI, or "image 3"
};

/// A .gltf or .glb with its buffers, read once and kept inside its folder. `model` has neither
/// buffers nor images: the parser never sees their bytes.
struct GltfFile {
    std::string name; ///< as the user wrote it, for messages
    ModelFolder folder;
    GltfModel model;
    std::vector<std::vector<std::byte>> buffers;
    std::vector<GltfImage> images;
    std::vector<std::string> ignored; ///< parts that hone does not read: "animations", "skins"

    /// Throws SceneError "NAME POINTER: WHAT".
    [[noreturn]] void fail(const std::string& pointer, const std::string& what) const;

    /// The bytes of a buffer view, checked against its buffer. `user`: JSON pointer of who asks.
    [[nodiscard]] std::span<const std::byte> view(std::int64_t index,
                                                  const std::string& user) const;

    /// The encoded bytes of an image. Throws InputError, or SceneError for a bad buffer view.
    [[nodiscard]] std::vector<std::byte> readImage(std::size_t index) const;
};

/// Reads the file and the buffers it names. Throws SceneError with the file's name and the place:
/// bad JSON (line and column), a broken GLB container, an extensionsRequired that is not supported,
/// a buffer that is missing, short, or outside the model's folder, a number where none fits.
[[nodiscard]] GltfFile openGltf(const std::string& name);

} // namespace hone

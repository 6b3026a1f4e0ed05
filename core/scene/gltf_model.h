// SPDX-License-Identifier: Apache-2.0
#pragma once

// tinygltf as a parser of text and nothing else: it opens no file, decodes no image and gets JSON
// without buffers and images (gltf_file.h reads those). Its names are kept apart from another
// tinygltf, built otherwise, that an embedding application may link.
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define tinygltf hone_tinygltf
#include <tiny_gltf.h>

namespace hone {

using GltfModel = tinygltf::Model;

/// Parses glTF JSON that has no buffers and no images. Throws InputError with tinygltf's words.
[[nodiscard]] GltfModel parseGltfModel(const std::string& json);

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/gltf_model.h"

#include "hone/core/error.h"

// tinygltf's own code. 2.7 writes files even with TINYGLTF_NO_FS, and does not include what it
// needs for that.
#include <fstream>
#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>

namespace hone {

GltfModel parseGltfModel(const std::string& json) {
    tinygltf::TinyGLTF parser;
    GltfModel model;
    std::string problems;
    std::string warnings;
    bool parsed = false;
    try {
        parsed = parser.LoadASCIIFromString(&model, &problems, &warnings, json.c_str(),
                                            static_cast<unsigned>(json.size()), "",
                                            tinygltf::REQUIRE_VERSION);
    } catch (const std::exception& error) {
        problems += error.what();
    }
    // It drops what it cannot parse and goes on, so its words count more than its answer.
    if (!parsed || !problems.empty()) {
        while (problems.ends_with('\n'))
            problems.pop_back();
        throw InputError(problems.empty() ? "not glTF" : problems);
    }
    return model;
}

} // namespace hone

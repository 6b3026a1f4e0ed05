// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/passes/glsl/shader_header.h"

#include <string>

namespace hone {

// What hone writes around a shader's text. Messages of the compiler name a line as STRING:LINE;
// these are the strings.
constexpr std::size_t kAroundShader = 0; ///< written by hone
constexpr std::size_t kInShader = 1;     ///< the file; declarations count to their annotation
constexpr std::size_t kAfterShader = 2;  ///< written by hone, after the file's end

// Members of the push constants beside parameters, with the encoder's two (kernel.glsl.h) first.
constexpr const char* kExtentMember = "extent";
[[nodiscard]] inline std::string hasMember(const ShaderPort& port) {
    return "has_" + port.name;
}
[[nodiscard]] inline std::string countMember(const ShaderPort& port) {
    return port.name + "_count";
}

/// The whole GLSL of a shader: its ports and parameters, its own text, and a main() that calls the
/// shader's for each pixel and stores its outputs.
[[nodiscard]] std::string wholeSource(const ShaderHeader& header);

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/pass/pass_type.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace hone {

/// One thing that is wrong with a shader file.
struct ShaderProblem {
    std::size_t line = 0;   ///< of the shader file, from 1; 0 = the file as a whole
    std::size_t column = 0; ///< from 1; 0 = not known: the whole line
    std::size_t length = 1; ///< bytes to underline
    std::string message;
    std::string hint; ///< what to do; may be ""
};

/// What a shader file is as a pass; no type where there are problems.
struct ShaderPass {
    std::optional<PassType> type;
    std::vector<ShaderProblem> problems;
};

/// Makes a pass type of a shader's text, which a graph names as { "type": "glsl", "shader": FILE }.
/// Opens no device and reads no file. `file` is the name for messages. Must not throw for any text.
using ShaderCompiler = std::function<ShaderPass(const std::string& file, const std::string& text)>;

} // namespace hone

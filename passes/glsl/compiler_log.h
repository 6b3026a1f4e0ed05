// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/passes/glsl/shader_text.h"

#include <string>
#include <vector>

namespace hone {

/// glslang's errors as problems of the shader file. `lines` are the file's; `names` what its
/// author may have meant by a name that does not exist.
[[nodiscard]] std::vector<ShaderProblem> readCompilerLog(const std::string& log,
                                                         const std::vector<ShaderLine>& lines,
                                                         const std::vector<std::string>& names);

} // namespace hone

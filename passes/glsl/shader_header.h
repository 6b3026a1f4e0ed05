// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/pass/param.h"
#include "hone/core/pass/port_type.h"
#include "hone/passes/glsl/shader_text.h"

#include <span>
#include <string>
#include <vector>

namespace hone {

/// A `#pragma hone in` or `#pragma hone out`.
struct ShaderPort {
    std::string name;
    PortType type;
    std::string doc;
    bool is_output = false;
    bool is_optional = false;
    ShaderPlace place; ///< of the name
};

/// A `#pragma hone param`.
struct ShaderParam {
    ParamDecl decl;
    ShaderPlace place; ///< of the name
};

/// What the lines `#pragma hone ...` of a shader file say; glsl.cpp is their manual.
struct ShaderHeader {
    std::string doc;
    std::vector<ShaderPort> ports; ///< in the order of the file
    std::vector<ShaderParam> params;
    std::string body; ///< the file without those lines, which are left empty
    std::vector<ShaderProblem> problems;
};

/// Most that one shader may declare: what a kernel's arguments and Vulkan's 128 bytes of push
/// constants have room for.
constexpr std::size_t kMaxShaderPorts = 16;
constexpr std::size_t kMaxShaderConstants = 28;

/// Reads the header of a shader. `types` are the port types that it may name. All problems are
/// found in one go; what is declared wrongly is left out.
[[nodiscard]] ShaderHeader parseShaderHeader(const std::string& text,
                                             std::span<const PortType> types);

} // namespace hone

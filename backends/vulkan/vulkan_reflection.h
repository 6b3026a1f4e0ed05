// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/math.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace hone {

/// A storage buffer (or array of them) that a shader reads or writes.
struct ShaderBinding {
    std::string name;             ///< the port: the block's type name less "_buffer"
    std::uint32_t elements = 1;   ///< descriptors: more than 1 for an array of buffers
    bool is_written = true;       ///< not declared `readonly`
    std::size_t binding_word = 0; ///< where the SPIR-V says the binding's number
    std::size_t set_word = 0;     ///< where it says the descriptor set's
};

/// What hone needs to know of one entry point.
struct ShaderReflection {
    std::vector<ShaderBinding> bindings; ///< those that main() can reach
    uvec3 workgroup{1, 1, 1};            ///< of a compute shader
    std::uint32_t push_constant_bytes = 0;
};

/// Reads names and sizes from SPIR-V. Throws DeviceError naming `shader` if it cannot be read or
/// uses a resource other than storage buffers.
[[nodiscard]] ShaderReflection reflectShader(std::span<const std::uint32_t> spirv,
                                             const char* shader);

} // namespace hone

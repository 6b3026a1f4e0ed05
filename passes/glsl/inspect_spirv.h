// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hone {

/// What hone must know of a shader's SPIR-V.
struct ShaderFacts {
    struct Member {
        std::string name;
        std::uint32_t offset = 0; ///< bytes from the push constants' begin
    };
    std::vector<Member> constants; ///< members of the push constant block
    /// Global variables, buffers (their block's name) and push constants that the shader's own
    /// functions name: all but the entry point, which hone writes.
    std::vector<std::string> used;
    std::vector<std::string> buffers; ///< blocks of all storage buffers
    /// What no shader of hone may have.
    struct Refused {
        std::string what; ///< "a barrier"
        std::string word; ///< of GLSL's, that brings it; "" = none
        std::string hint;
    };
    std::vector<Refused> refused;

    [[nodiscard]] bool uses(std::string_view name) const;
    /// Throws std::logic_error if there is no such push constant.
    [[nodiscard]] std::uint32_t offsetOf(std::string_view constant) const;
};

/// Reads SPIR-V that glslang wrote. Throws std::logic_error if it is none.
[[nodiscard]] ShaderFacts inspectSpirv(std::span<const std::uint32_t> spirv);

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hone {

/// What glslang made of a text.
struct CompiledGlsl {
    std::vector<std::uint32_t> spirv; ///< empty where something is wrong
    std::string log;                  ///< glslang's messages, one a line; "" = none
    std::string failure;              ///< why glslang came to no end: "it took more than 5 s"
};

/// Compiles a compute shader for Vulkan 1.3, with every index clamped to its array, so that a wrong
/// one does no harm on any device.
///
/// The text may be hostile: it is compiled in a process of its own, with limits of time and memory,
/// and what kills that process is a failure. Throws OutOfMemory if there can be no process. Safe to
/// call from many threads.
[[nodiscard]] CompiledGlsl compileGlsl(const std::string& source);

} // namespace hone

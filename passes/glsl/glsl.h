// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/pass/shader_pass.h"

namespace hone {

/// The compiler of passes of type "glsl" (glsl.cpp has their manual). `registry` knows the port
/// types that shaders may name; it must outlive the compiler and the pass types that it makes.
/// Safe to call from many threads.
[[nodiscard]] ShaderCompiler glslCompiler(const PassRegistry& registry);

} // namespace hone

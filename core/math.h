// SPDX-License-Identifier: Apache-2.0
#pragma once

// The one place where GLM is configured and brought into hone. Kernels are written in the common
// subset of GLSL and GLM, so the names below are the ones that GLSL has.
#ifndef GLM_FORCE_DEPTH_ZERO_TO_ONE
#define GLM_FORCE_DEPTH_ZERO_TO_ONE
#endif
#include <glm/glm.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <cstdint>

namespace hone {

using uint = std::uint32_t;
using glm::ivec2, glm::ivec3, glm::ivec4;
using glm::mat3, glm::mat4, glm::mat4x3;
using glm::uvec2, glm::uvec3, glm::uvec4;
using glm::vec2, glm::vec3, glm::vec4;

} // namespace hone

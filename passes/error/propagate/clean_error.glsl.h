// SPDX-License-Identifier: Apache-2.0
//
// Kernel source: included flat, once, inside a kernel, after sanitised.glsl.h.

HONE_CONST float kLargest = 1e30f;

/// What is huge is cut, so that sums stay finite.
vec2 cleanError(vec2 error) {
    return min(vec2(sanitised(error.x), sanitised(error.y)), vec2(kLargest));
}

// SPDX-License-Identifier: Apache-2.0
//
// What tracing yields: radiance samples and their running sums. Scalar layout, the same bytes in
// C++ and GLSL.
#ifndef HONE_SAMPLE_GLSL_H
#define HONE_SAMPLE_GLSL_H

#ifdef __cplusplus
#include "hone/core/math.h"
namespace hone {
#endif

/// An element of a Samples list.
struct Sample {
    vec3 radiance;
    uint pixel; ///< y * width + x
};

/// A pixel of an Accumulation plane.
struct Accumulated {
    vec3 sum;   ///< of radiance, added in the order of sample numbers
    uint count; ///< of samples
};

#ifdef __cplusplus
static_assert(sizeof(Sample) == 16 && sizeof(Accumulated) == 16);
} // namespace hone
#endif
#endif

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/math.h"

#include <cstdint>
#include <cstring>

namespace hone {

/// Floats that one instruction computes with: as many as the widest registers of the machine that
/// is compiled for hold. Lane by lane the bits are those of float. Arithmetic, comparison and ?:
/// are the compiler's; a scalar counts as all lanes. Compares give masks.
#if defined(__AVX512F__)
inline constexpr uint kLanes = 16;
#elif defined(__AVX__)
inline constexpr uint kLanes = 8;
#else
inline constexpr uint kLanes = 4;
#endif
using Lanes [[gnu::vector_size(kLanes * sizeof(float))]] = float;
using LaneMask [[gnu::vector_size(kLanes * sizeof(float))]] = std::int32_t; ///< 0 or -1

inline Lanes loadLanes(const float* values) {
    Lanes result;
    std::memcpy(&result, values, sizeof result);
    return result;
}

} // namespace hone

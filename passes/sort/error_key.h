// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/math.h"

#include <bit>

namespace hone {

/// Bits of an expected error that grow with it: floats >= 0 have the order of their bits. What is
/// not finite counts as 1, what is negative (and -0) as 0. Below 0x7f800000.
inline uint errorBits(float expect) {
    const uint bits = std::bit_cast<uint>(expect);
    if ((bits & 0x7f800000u) == 0x7f800000u)
        return std::bit_cast<uint>(1.0f);
    return (bits >> 31) != 0 ? 0 : bits;
}

/// Greatest error first when sorted ascending.
constexpr uint kErrorKeyBits = 31;
inline uint descendingErrorKey(float expect) {
    return 0x7fffffffu ^ errorBits(expect);
}

/// May this pixel be wrong? A bound that is NaN says yes.
inline bool isErrorPixel(vec2 error) {
    return !(error.y <= 0.0f);
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <iostream>

namespace hone {

/// Ends the run with what did not hold; libFuzzer then keeps the input.
inline void require(bool holds, const char* what) {
    if (holds)
        return;
    std::cerr << "does not hold: " << what << "\n";
    std::abort();
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/scene_arrays.h"

#include <cmath>

namespace hone {

const PagedVector<float>& srgbTable() {
    static const PagedVector<float> decoded = [] {
        PagedVector<float> table(256);
        for (std::size_t i = 0; i < table.size(); ++i) {
            const double encoded = static_cast<double>(i) / 255.0;
            table[i] = static_cast<float>(
                encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4));
        }
        return table;
    }();
    return decoded;
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/scene/gltf_file.h"
#include "hone/core/scene/scene.h"

#include <vector>

namespace hone {

/// An accessor's elements as floats: `components` (1 to 4) per element, integers normalised to
/// [0,1] or [-1,1] if the accessor says so, sparse values put in place. `user`: JSON pointer of who
/// asks.
///
/// Every offset, stride, count and index is checked against the bytes that there are before any is
/// read. Throws SceneError naming the accessor: another number of components, 32-bit integers, an
/// element past its buffer view, a sparse index past the count.
[[nodiscard]] std::vector<float> readFloats(const GltfFile& file, int accessor, uint components,
                                            const std::string& user);

/// Scalar unsigned integers of 8, 16 or 32 bits, each less than `limit`. Throws as readFloats does.
[[nodiscard]] std::vector<uint> readIndices(const GltfFile& file, int accessor, std::size_t limit,
                                            const std::string& user);

} // namespace hone

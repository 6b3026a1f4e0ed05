// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/image/image.h"

#include <nlohmann/json.hpp>

#include <span>
#include <string>

namespace hone::cli {

/// Why two images by `hone render` that differ in nothing but their trace backend are not equal:
/// each differing pixel is traced again by both backends, and the first ray that they answer
/// differently is judged.
///
/// {"ties", "silhouettes", "unexplained": counts, "pixels": [{"x", "y", "why", "ray_kind", "ray",
/// "a", "b", "border"}]}; answers in words. A pixel whose rays are all answered alike is
/// unexplained. Throws InputError if the images do not say how they were made, or were made
/// differently. `plugins`: files that offer backends.
[[nodiscard]] nlohmann::ordered_json explainImages(const std::string& path_a, const RgbImage& a,
                                                   const std::string& path_b, const RgbImage& b,
                                                   std::span<const std::string> plugins);

} // namespace hone::cli

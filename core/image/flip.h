// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/image/image.h"
#include "hone/core/parallel_for.h"

namespace hone {

/// A display 0.7 m wide of 3840 pixels, seen from 0.7 m: 67.02, rounded.
inline constexpr double kPixelsPerDegree = 67;

/// What somebody sees of the difference of two images who flips between them.
struct FlipError {
    double mean = 0;           ///< of `pixels`
    std::vector<float> pixels; ///< one a pixel, rows top down, in [0,1]; 0 where nothing is seen
    uint exposures = 0;        ///< of HDR-FLIP, evenly spaced; 0 = LDR-FLIP
    double first_exposure = 0; ///< in stops: radiance times 2^stops is tone-mapped
    double last_exposure = 0;
};

/// FLIP of two images of equal extent, both display or both linear.
///
/// Display images: LDR-FLIP. Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild,
/// FLIP: A Difference Evaluator for Alternating Images, 2020. Values are cut to [0,1]. Symmetric.
/// Linear images: HDR-FLIP, the largest LDR-FLIP over exposures of tone-mapped radiance. Andersson,
/// Nilsson, Shirley, Akenine-Moller, Visualizing Errors in Rendered High Dynamic Range Images,
/// 2021. The exposures are the reference's, from where its brightest pixel stays below white to
/// where its median does. Deviation: the median is that of pixels brighter than 0, so that a mostly
/// black image has one; a black reference is shown as it is.
///
/// NaN and infinity are seen as 0; a pixel that has one counts as 1 unless both images have the
/// same bits there. The same bits for every number of threads.
/// Preconditions: 1 <= pixels_per_degree <= 1000; at least one pixel.
[[nodiscard]] FlipError flip(const RgbImage& reference, const RgbImage& test,
                             ParallelFor parallel_for, double pixels_per_degree = kPixelsPerDegree);

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/image/image.h"

namespace hone {

/// How far two images are apart. Sums run in pixel order in double, so the numbers are the same on
/// every machine.
struct ImageDifference {
    double mse = 0;  ///< mean of squared differences over all pixels and channels
    double rmse = 0; ///< sqrt(mse)
    double psnr = 0; ///< 10 log10(1 / mse) dB, peak 1; infinity for equal images
    double ssim = 1; ///< mean structural similarity of luminance, at most 1
    double max = 0;  ///< largest absolute difference of a channel
    std::uint64_t differing_pixels = 0; ///< pixels with a differing bit
    std::uint64_t differing_bits = 0;   ///< over all 32-bit words; 0 means bit-identical
    std::uint64_t nonfinite_pixels = 0; ///< pixels with NaN or infinity in either image
};

/// Compares two images of equal extent, as they are: bring linear and display images to one space
/// first (toDisplay).
///
/// NaN and infinity: a channel whose bits are equal differs by 0, one where either is not finite by
/// infinity, so mse, rmse and max are never NaN.
/// SSIM: Wang, Bovik, Sheikh, Simoncelli, Image Quality Assessment: From Error Visibility to
/// Structural Similarity, 2004; Gaussian window 11 x 11, sigma 1.5, K1 = 0.01, K2 = 0.03, dynamic
/// range 1, over luminance (Rec. 709 weights; non-finite counts as 0), mean over the windows that
/// lie inside the image; an image narrower than 11 pixels narrows the window. It is meant for
/// display values.
/// Throws InputError if the extents differ or are zero.
[[nodiscard]] ImageDifference compareImages(const RgbImage& a, const RgbImage& b);

} // namespace hone

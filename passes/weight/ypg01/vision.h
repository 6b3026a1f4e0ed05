// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace hone {

/// What an eye can tell apart: thresholds in cd/m^2, degrees of visual angle and cycles per degree.
namespace vision {

/// How fast the image of a thing moves on the retina (degrees / s) that moves by `velocity` on the
/// display: eyes follow 82 % of it and at most 80, and drift by 0.15 at rest (Daly, Engineering
/// Observations from Spatiovelocity and Spatiotemporal Visual Models, 1998).
inline double retinalVelocity(double velocity) {
    const double followed = std::min(0.82 * velocity + 0.15, 80.0);
    return std::max(std::abs(velocity - followed), 0.15);
}

/// 45.9 / (c2 v + 2) of Daly 1998.
inline double greatestFrequency(double retinal_velocity) {
    return 45.9 / (1.7 * retinal_velocity + 2.0);
}

/// Sensitivity (1 / contrast at threshold) to a grating of that frequency (Kelly, Motion and Vision
/// II, 1979, with the constants of Daly 1998: c0 = 1.14, c1 = 0.67, c2 = 1.7).
inline double sensitivity(double cycles_per_degree, double retinal_velocity) {
    constexpr double kC0 = 1.14, kC1 = 0.67, kC2 = 1.7, kPi = 3.14159265358979;
    const double v = kC2 * retinal_velocity;
    const double k = 6.1 + 7.3 * std::pow(std::abs(std::log10(v / 3.0)), 3);
    const double a = 2 * kPi * cycles_per_degree * kC1;
    return k * kC0 * v * a * a * std::exp(-2 * a / greatestFrequency(retinal_velocity));
}

/// The frequency of the greatest sensitivity: where the derivative of sensitivity() is 0.
inline double peakFrequency(double retinal_velocity) {
    return greatestFrequency(retinal_velocity) / (2 * 3.14159265358979 * 0.67);
}

/// The difference of luminance that is just seen by cones adapted to `luminance`, both cd/m^2
/// (Ferwerda, Pattanaik, Shirley, Greenberg, A Model of Visual Adaptation for Realistic Image
/// Synthesis, 1996, after Ward).
inline double thresholdOf(double luminance) {
    const double log_l = std::log10(std::max(luminance, 1e-6));
    if (log_l <= -2.6)
        return std::pow(10.0, -0.72);
    if (log_l >= 1.9)
        return std::pow(10.0, log_l - 1.255);
    return std::pow(10.0, std::pow(0.249 * log_l + 0.65, 2.7) - 0.72);
}

} // namespace vision
} // namespace hone

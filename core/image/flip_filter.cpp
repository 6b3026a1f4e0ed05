// SPDX-License-Identifier: Apache-2.0
#include "hone/core/image/flip_filter.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <numeric>

namespace hone {
namespace {

using Taps = std::vector<double>;

/// weight(x) at as many pixels as three standard deviations of a Gaussian cover.
template <class Weight> Taps sampled(double deviation_px, const Weight& weight) {
    const double radius = std::ceil(3 * deviation_px);
    Taps taps;
    for (double x = -radius; x <= radius; ++x)
        taps.push_back(weight(x));
    return taps;
}

double sum(const Taps& taps) {
    return std::accumulate(taps.begin(), taps.end(), 0.0);
}

void scale(Taps& taps, double factor) {
    for (double& weight : taps)
        weight *= factor;
}

/// a sqrt(pi / b) exp(-(pi r)^2 / b), r in degrees.
struct Gaussian {
    double a, b;
};

Filter sensitivity(std::initializer_list<Gaussian> gaussians, double pixels_per_degree) {
    constexpr double kPi = std::numbers::pi;
    const double widest = std::sqrt(0.04 / 2) / kPi; // one window for all channels
    Filter filter;
    double total = 0;
    for (const Gaussian gaussian : gaussians) {
        const Taps down = sampled(widest * pixels_per_degree, [&](double x) {
            return std::exp(-std::pow(kPi * x / pixels_per_degree, 2) / gaussian.b);
        });
        Taps across = down;
        scale(across, gaussian.a * std::sqrt(kPi / gaussian.b));
        total += sum(across) * sum(down);
        filter.push_back({std::move(across), down});
    }
    for (SeparableFilter& part : filter)
        scale(part.across, 1 / total);
    return filter;
}

/// Positive weights to a sum of 1, negative ones to -1.
Taps balanced(Taps taps) {
    double positive = 0, negative = 0;
    for (const double weight : taps)
        (weight > 0 ? positive : negative) += std::abs(weight);
    for (double& weight : taps)
        if (weight != 0)
            weight /= weight > 0 ? positive : negative;
    return taps;
}

/// factor(t) exp(-t^2 / 2) along x times the Gaussian along y, and the other way round.
template <class Factor>
std::array<Filter, 2> derivatives(double pixels_per_degree, const Factor& factor) {
    const double deviation = 0.5 * 0.082 * pixels_per_degree; // w = 0.082 degrees
    const auto gaussian = [&](double x) { return std::exp(-0.5 * std::pow(x / deviation, 2)); };
    const Taps smooth = balanced(sampled(deviation, gaussian));
    const Taps steep =
        balanced(sampled(deviation, [&](double x) { return factor(x / deviation) * gaussian(x); }));
    return {Filter{{steep, smooth}}, Filter{{smooth, steep}}};
}

} // namespace

Plane filtered(const Plane& plane, uvec2 extent, const Filter& filter, ParallelFor parallel_for) {
    const std::size_t width = extent.x, height = extent.y;
    Plane rows(plane.size()), result(plane.size());
    for (const SeparableFilter& part : filter) {
        const Taps& across = part.across;
        const Taps& down = part.down;
        const std::size_t left = across.size() / 2, above = down.size() / 2;
        forEachIndex(parallel_for, height, [&](std::size_t y) {
            const double* from = &plane[y * width];
            Plane wide(left, from[0]);
            wide.insert(wide.end(), from, from + width);
            wide.insert(wide.end(), left, from[width - 1]);
            double* to = &rows[y * width];
            std::fill_n(to, width, 0.0);
            for (std::size_t i = 0; i < across.size(); ++i) {
                for (std::size_t x = 0; x < width; ++x)
                    to[x] += across[i] * wide[x + i];
            }
        });
        forEachIndex(parallel_for, height, [&](std::size_t y) {
            double* to = &result[y * width];
            for (std::size_t i = 0; i < down.size(); ++i) {
                const std::size_t row = std::clamp(y + i, above, above + height - 1) - above;
                for (std::size_t x = 0; x < width; ++x)
                    to[x] += down[i] * rows[row * width + x];
            }
        });
    }
    return result;
}

std::array<Filter, 3> sensitivityFilters(double pixels_per_degree) {
    return {sensitivity({{1, 0.0047}}, pixels_per_degree),
            sensitivity({{1, 0.0053}}, pixels_per_degree),
            sensitivity({{34.1, 0.04}, {13.5, 0.025}}, pixels_per_degree)};
}

std::array<Filter, 2> edgeFilters(double pixels_per_degree) {
    return derivatives(pixels_per_degree, [](double t) { return -t; });
}

std::array<Filter, 2> pointFilters(double pixels_per_degree) {
    return derivatives(pixels_per_degree, [](double t) { return t * t - 1; });
}

} // namespace hone

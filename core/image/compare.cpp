// SPDX-License-Identifier: Apache-2.0
#include "hone/core/image/compare.h"

#include "hone/core/error.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>

namespace hone {
namespace {

double luminance(vec3 color) {
    const double y = 0.2126 * double(color.x) + 0.7152 * double(color.y) + 0.0722 * double(color.z);
    return std::isfinite(y) ? y : 0.0;
}

std::vector<double> gaussianWindow(std::size_t side) {
    std::vector<double> weights(side);
    double sum = 0;
    for (std::size_t i = 0; i < side; ++i) {
        const double x = double(i) - 0.5 * double(side - 1);
        sum += weights[i] = std::exp(-x * x / (2 * 1.5 * 1.5));
    }
    for (double& weight : weights)
        weight /= sum;
    return weights;
}

/// Means of a plane under every window that lies inside it: (w - side + 1) x (h - side + 1) values.
class WindowMeans {
public:
    explicit WindowMeans(uvec2 extent)
        : extent_(extent), across_(gaussianWindow(std::min<std::size_t>(11, extent.x))),
          down_(gaussianWindow(std::min<std::size_t>(11, extent.y))) {}

    [[nodiscard]] std::vector<double> of(const std::vector<double>& plane) const {
        const std::size_t width = extent_.x - across_.size() + 1;
        const std::size_t height = extent_.y - down_.size() + 1;
        std::vector<double> rows(width * extent_.y);
        for (std::size_t y = 0; y < extent_.y; ++y)
            for (std::size_t x = 0; x < width; ++x)
                for (std::size_t i = 0; i < across_.size(); ++i)
                    rows[y * width + x] += across_[i] * plane[y * extent_.x + x + i];
        std::vector<double> means(width * height);
        for (std::size_t y = 0; y < height; ++y)
            for (std::size_t i = 0; i < down_.size(); ++i)
                for (std::size_t x = 0; x < width; ++x)
                    means[y * width + x] += down_[i] * rows[(y + i) * width + x];
        return means;
    }

private:
    uvec2 extent_;
    std::vector<double> across_;
    std::vector<double> down_;
};

std::vector<double> product(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> result(a.size());
    std::transform(a.begin(), a.end(), b.begin(), result.begin(), std::multiplies<>());
    return result;
}

/// Wang et al. 2004, equation 13 at each window, then the mean (equation 17).
double structuralSimilarity(const RgbImage& a, const RgbImage& b) {
    std::vector<double> x(a.pixels.size()), y(b.pixels.size());
    std::transform(a.pixels.begin(), a.pixels.end(), x.begin(), luminance);
    std::transform(b.pixels.begin(), b.pixels.end(), y.begin(), luminance);
    const WindowMeans means(a.extent);
    const std::vector<double> mean_x = means.of(x), mean_y = means.of(y);
    const std::vector<double> mean_xx = means.of(product(x, x));
    const std::vector<double> mean_yy = means.of(product(y, y));
    const std::vector<double> mean_xy = means.of(product(x, y));

    constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
    double sum = 0;
    for (std::size_t i = 0; i < mean_x.size(); ++i) {
        const double xx = mean_x[i] * mean_x[i];
        const double yy = mean_y[i] * mean_y[i];
        const double xy = mean_x[i] * mean_y[i];
        const double variances = (mean_xx[i] - xx) + (mean_yy[i] - yy);
        const double covariance = mean_xy[i] - xy;
        sum += ((2 * xy + c1) * (2 * covariance + c2)) / ((xx + yy + c1) * (variances + c2));
    }
    return sum / double(mean_x.size());
}

} // namespace

ImageDifference compareImages(const RgbImage& a, const RgbImage& b) {
    const auto size = [](uvec2 extent) {
        return std::to_string(extent.x) + " x " + std::to_string(extent.y);
    };
    if (a.extent != b.extent || a.pixels.empty() || a.pixels.size() != b.pixels.size())
        throw InputError("images of " + size(a.extent) + " and " + size(b.extent) +
                         " pixels cannot be compared; both must have the same size, not zero");

    ImageDifference result;
    double sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        uint bits = 0;
        bool finite = true;
        for (glm::length_t c = 0; c < 3; ++c) {
            const float x = a.pixels[i][c], y = b.pixels[i][c];
            const uint differing = std::bit_cast<uint>(x) ^ std::bit_cast<uint>(y);
            const bool comparable = std::isfinite(x) && std::isfinite(y);
            bits += static_cast<uint>(std::popcount(differing));
            finite = finite && comparable;
            if (differing == 0)
                continue;
            const double difference = comparable ? std::abs(double(x) - double(y))
                                                 : std::numeric_limits<double>::infinity();
            sum += difference * difference;
            result.max = std::max(result.max, difference);
        }
        result.differing_bits += bits;
        result.differing_pixels += bits != 0 ? 1 : 0;
        result.nonfinite_pixels += finite ? 0 : 1;
    }
    result.mse = sum / (3.0 * double(a.pixels.size()));
    result.rmse = std::sqrt(result.mse);
    result.psnr =
        result.mse > 0 ? -10 * std::log10(result.mse) : std::numeric_limits<double>::infinity();
    result.ssim = structuralSimilarity(a, b);
    return result;
}

} // namespace hone

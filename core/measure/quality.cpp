// SPDX-License-Identifier: Apache-2.0
#include "hone/core/measure/quality.h"

#include "hone/core/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hone {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::vector<float> without(std::span<const float> values, const std::vector<bool>& left_out) {
    std::vector<float> kept;
    kept.reserve(values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!left_out[i])
            kept.push_back(values[i]);
    return kept;
}

/// Distance from one as a factor, whichever way.
double farFromOne(double x) {
    return x > 0 ? std::fabs(std::log(x)) : std::numeric_limits<double>::infinity();
}

} // namespace

std::vector<bool> undecidable(const ViewTruth& truth, uint threshold) {
    std::vector<bool> result(truth.error.size(), false);
    const float value = thresholdValue(threshold);
    for (std::size_t i = 0; i < truth.noise.size(); ++i)
        result[i] =
            truth.noise[i] > value / 4 && std::fabs(truth.error[i] - value) < 3 * truth.noise[i];
    return result;
}

MetricQuality judge(const ViewTruth& truth, std::span<const float> expect,
                    std::span<const float> bound) {
    HONE_ASSERT(expect.size() == truth.error.size() && bound.size() == truth.error.size(),
                "one estimate a pixel");
    MetricQuality quality;
    for (std::size_t t = 0; t < kThresholds.size(); ++t) {
        const float threshold = thresholdValue(kThresholds[t]);
        const auto judgeAt = [&](std::span<const float> error, std::span<const float> score,
                                 std::span<const float> gate) {
            Detection& found = quality.detection[t];
            found = detect(error, gate, threshold);
            if (!(found.worst_miss > double{threshold}))
                found.worst_miss = 0;
            quality.auc[t] = rocAuc(error, score, threshold);
            quality.average_precision[t] = averagePrecision(error, score, threshold);
        };
        if (truth.noise.empty()) {
            judgeAt(truth.error, expect, bound);
        } else {
            const std::vector<bool> left_out = undecidable(truth, kThresholds[t]);
            judgeAt(without(truth.error, left_out), without(expect, left_out),
                    without(bound, left_out));
        }
    }
    quality.spearman = spearman(expect, truth.error);
    quality.calibration = calibrate(truth.error, expect);
    quality.by_pixels = converge(truth.square, expect, {});
    quality.gain = gain(quality.by_pixels, convergeOracle(truth.square, {}));
    quality.by_rays = converge(truth.square, expect, truth.cost);
    for (std::size_t k = 0; k < kShares.size(); ++k) {
        quality.pixels_until[k] = quality.by_pixels.costUntil(kShares[k]);
        quality.rays_until[k] = quality.by_rays.costUntil(kShares[k]);
    }
    quality.gain_by_rays = gain(quality.by_rays, convergeOracle(truth.square, truth.cost));

    std::vector<bool> is_stopped(bound.size());
    std::transform(bound.begin(), bound.end(), is_stopped.begin(),
                   [](float b) { return !(b > 0); });
    const std::vector<float> error = without(truth.error, is_stopped),
                             square = without(truth.square, is_stopped),
                             score = without(expect, is_stopped);
    quality.auc_flagged = rocAuc(error, score, thresholdValue(kThresholds[0]));
    quality.gain_flagged = gain(converge(square, score, {}), convergeOracle(square, {}));
    return quality;
}

std::vector<BlindOrder> blindOrders(uvec2 extent) {
    const std::size_t pixels = std::size_t{extent.x} * extent.y;
    // Scores are floats: past 2^24 some neighbours tie, which changes nothing that can be seen.
    std::vector<BlindOrder> orders{{"random", std::vector<float>(pixels)},
                                   {"scanline", std::vector<float>(pixels)},
                                   {"checkerboard", std::vector<float>(pixels)}};
    for (uint pixel = 0; pixel < pixels; ++pixel) {
        const uint x = pixel % extent.x, y = pixel / extent.x;
        const auto later = static_cast<float>(pixel);
        orders[1].score[pixel] = -later;
        orders[2].score[pixel] = (x + y) % 2 == 0 ? -later : -later - static_cast<float>(pixels);
    }
    return orders;
}

OverViews overViews(std::span<const double> values, Better better) {
    OverViews result{kNan, kNan};
    double sum = 0;
    std::size_t count = 0;
    for (const double value : values) {
        if (std::isnan(value))
            continue;
        sum += value;
        const bool is_worse = better == Better::kGreater ? value < result.worst
                              : better == Better::kLess
                                  ? value > result.worst
                                  : farFromOne(value) > farFromOne(result.worst);
        if (count++ == 0 || is_worse)
            result.worst = value;
    }
    if (count > 0)
        result.mean = sum / static_cast<double>(count);
    return result;
}

} // namespace hone

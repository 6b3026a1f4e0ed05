// SPDX-License-Identifier: Apache-2.0
#include "hone/core/measure/ranking.h"

#include "hone/core/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace hone {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Calls visit(begin, end) for each run of equal scores of a ranking.
template <class Visit>
void forEachTie(std::span<const std::uint32_t> ranking, std::span<const float> score,
                const Visit& visit) {
    for (std::size_t begin = 0; begin < ranking.size();) {
        std::size_t end = begin + 1;
        while (end < ranking.size() && score[ranking[end]] == score[ranking[begin]])
            ++end;
        visit(begin, end);
        begin = end;
    }
}

/// Ranks from 1, least first; ties get their mean.
std::vector<double> meanRanks(std::span<const float> values) {
    const std::vector<std::uint32_t> ranking = rankByScore(values);
    const double count = static_cast<double>(values.size());
    std::vector<double> ranks(values.size());
    forEachTie(ranking, values, [&](std::size_t begin, std::size_t end) {
        const double mean = count - 0.5 * static_cast<double>(begin + end - 1);
        for (std::size_t i = begin; i < end; ++i)
            ranks[ranking[i]] = mean;
    });
    return ranks;
}

struct Line {
    double slope = kNan, offset = kNan, correlation = kNan;
};

/// Least squares of y over x.
template <class X, class Y> Line fitLine(std::span<const X> x, std::span<const Y> y) {
    const double count = static_cast<double>(x.size());
    double mean_x = 0, mean_y = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        mean_x += static_cast<double>(x[i]) / count;
        mean_y += static_cast<double>(y[i]) / count;
    }
    double xx = 0, yy = 0, xy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double dx = static_cast<double>(x[i]) - mean_x;
        const double dy = static_cast<double>(y[i]) - mean_y;
        xx += dx * dx;
        yy += dy * dy;
        xy += dx * dy;
    }
    Line line;
    if (xx > 0) {
        line.slope = xy / xx;
        line.offset = mean_y - line.slope * mean_x;
    }
    if (xx > 0 && yy > 0)
        line.correlation = xy / std::sqrt(xx * yy);
    return line;
}

std::size_t countAbove(std::span<const float> error, float threshold) {
    return static_cast<std::size_t>(
        std::ranges::count_if(error, [&](float e) { return e > threshold; }));
}

} // namespace

std::vector<std::uint32_t> rankByScore(std::span<const float> score) {
    std::vector<std::uint32_t> ranking(score.size());
    std::iota(ranking.begin(), ranking.end(), 0u);
    std::ranges::sort(ranking, [&](std::uint32_t a, std::uint32_t b) {
        return score[a] != score[b] ? score[a] > score[b] : a < b;
    });
    return ranking;
}

Detection detect(std::span<const float> error, std::span<const float> bound, float threshold) {
    HONE_ASSERT(error.size() == bound.size(), "one bound a pixel");
    std::size_t flagged = 0, positives = 0, found = 0;
    double energy = 0, missed_energy = 0;
    Detection result;
    for (std::size_t i = 0; i < error.size(); ++i) {
        const bool is_flagged = bound[i] > 0;
        const bool is_positive = error[i] > threshold;
        const double squared = double{error[i]} * double{error[i]};
        flagged += is_flagged ? 1u : 0u;
        positives += is_positive ? 1u : 0u;
        found += is_flagged && is_positive ? 1u : 0u;
        energy += squared;
        if (is_flagged)
            continue;
        missed_energy += squared;
        result.worst_miss = std::max(result.worst_miss, double{error[i]});
    }
    const auto share = [](std::size_t part, std::size_t whole, double of_none) {
        return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : of_none;
    };
    result.recall = share(found, positives, 1);
    result.precision = share(found, flagged, 1);
    result.flagged = share(flagged, error.size(), 0);
    result.positives = share(positives, error.size(), 0);
    result.missed_energy = energy > 0 ? missed_energy / energy : 0;
    return result;
}

double rocAuc(std::span<const float> error, std::span<const float> score, float threshold) {
    HONE_ASSERT(error.size() == score.size(), "one score a pixel");
    const std::size_t positives = countAbove(error, threshold);
    const std::size_t negatives = error.size() - positives;
    if (positives == 0 || negatives == 0)
        return kNan;
    // Mann and Whitney's statistic from the sum of the positives' ranks.
    const std::vector<double> ranks = meanRanks(score);
    double rank_sum = 0;
    for (std::size_t i = 0; i < error.size(); ++i)
        if (error[i] > threshold)
            rank_sum += ranks[i];
    const double p = static_cast<double>(positives);
    return (rank_sum - 0.5 * p * (p + 1)) / (p * static_cast<double>(negatives));
}

double averagePrecision(std::span<const float> error, std::span<const float> score,
                        float threshold) {
    HONE_ASSERT(error.size() == score.size(), "one score a pixel");
    const std::size_t positives = countAbove(error, threshold);
    if (positives == 0)
        return kNan;
    const std::vector<std::uint32_t> ranking = rankByScore(score);
    double found = 0, sum = 0;
    forEachTie(ranking, score, [&](std::size_t begin, std::size_t end) {
        double here = 0;
        for (std::size_t i = begin; i < end; ++i)
            here += error[ranking[i]] > threshold ? 1 : 0;
        // The k-th positive of the tie stands, in the mean, this far into it.
        const double stretch = static_cast<double>(end - begin) / std::max(here, 1.0);
        for (double k = 1; k <= here; ++k)
            sum += (found + k) / (static_cast<double>(begin) + k * stretch);
        found += here;
    });
    return sum / static_cast<double>(positives);
}

double spearman(std::span<const float> a, std::span<const float> b) {
    HONE_ASSERT(a.size() == b.size(), "pairs");
    const std::vector<double> ranks_a = meanRanks(a);
    const std::vector<double> ranks_b = meanRanks(b);
    return fitLine(std::span<const double>(ranks_a), std::span<const double>(ranks_b)).correlation;
}

Calibration calibrate(std::span<const float> error, std::span<const float> expect) {
    HONE_ASSERT(error.size() == expect.size(), "one estimate a pixel");
    constexpr std::size_t kBins = 20;
    const Line line = fitLine(expect, error);
    Calibration result{.slope = line.slope, .offset = line.offset};
    const std::vector<std::uint32_t> ranking = rankByScore(expect);
    for (std::size_t bin = 0; bin < kBins; ++bin) {
        const std::size_t begin = bin * ranking.size() / kBins;
        const std::size_t end = (bin + 1) * ranking.size() / kBins;
        double difference = 0;
        for (std::size_t i = begin; i < end; ++i)
            difference += double{error[ranking[i]]} - double{expect[ranking[i]]};
        result.expected_error += std::fabs(difference);
    }
    if (!ranking.empty())
        result.expected_error /= static_cast<double>(ranking.size());
    return result;
}

double Convergence::costUntil(double left) const {
    for (std::size_t i = 1; i < curve.size(); ++i) {
        if (curve[i].left > left)
            continue;
        const Point& a = curve[i - 1];
        const Point& b = curve[i];
        return a.left > b.left ? a.cost + (b.cost - a.cost) * (a.left - left) / (a.left - b.left)
                               : b.cost;
    }
    return 1;
}

double Convergence::leftAt(double cost) const {
    const auto after = std::ranges::upper_bound(curve, cost, {}, &Point::cost);
    if (after == curve.begin() || after == curve.end())
        return curve.empty() ? kNan : after == curve.end() ? curve.back().left : curve.front().left;
    const Point& a = *(after - 1);
    return a.left + (after->left - a.left) * (cost - a.cost) / (after->cost - a.cost);
}

Convergence converge(std::span<const float> squared_error, std::span<const float> score,
                     std::span<const float> cost) {
    HONE_ASSERT(squared_error.size() == score.size(), "one score a pixel");
    HONE_ASSERT(cost.empty() || cost.size() == score.size(), "one cost a pixel");
    const std::vector<std::uint32_t> ranking = rankByScore(score);
    const auto costOf = [&](std::uint32_t pixel) {
        return cost.empty() ? 1.0 : double{cost[pixel]};
    };
    // Summed in the order of the ranking, so that the last point is exactly (1, 0).
    double all_cost = 0, all_error = 0;
    for (const std::uint32_t pixel : ranking) {
        all_cost += costOf(pixel);
        all_error += double{squared_error[pixel]};
    }
    Convergence result;
    result.curve.push_back({});
    if (!(all_error > 0)) {
        result.area = kNan;
        return result;
    }
    double spent = 0, removed = 0;
    result.area = 0;
    forEachTie(ranking, score, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            spent += costOf(ranking[i]);
            removed += double{squared_error[ranking[i]]};
        }
        const Convergence::Point before = result.curve.back();
        const Convergence::Point now{spent / all_cost, 1 - removed / all_error};
        result.area += 0.5 * (now.cost - before.cost) * (before.left + now.left);
        result.curve.push_back(now);
    });
    return result;
}

Convergence convergeOracle(std::span<const float> squared_error, std::span<const float> cost) {
    if (cost.empty())
        return converge(squared_error, squared_error, cost);
    std::vector<float> worth(squared_error.size());
    for (std::size_t i = 0; i < worth.size(); ++i)
        worth[i] = squared_error[i] / cost[i];
    return converge(squared_error, worth, cost);
}

double gain(const Convergence& order, const Convergence& oracle) {
    const double possible = 0.5 - oracle.area;
    return possible > 0 ? (0.5 - order.area) / possible : kNan;
}

} // namespace hone

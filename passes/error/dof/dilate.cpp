// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/error/dof/dilate.h"

#include "hone/core/error.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

namespace hone {
namespace {

constexpr int kNever = std::numeric_limits<int>::max();

/// The lower envelope of parabolas (x - q)^2 + height(q), in whole numbers: each of `centers` is
/// lowest from its `begins` to the next one's.
struct Envelope {
    std::span<int> centers, begins;
    std::size_t count = 0;

    template <class Height> void build(int length, Height height) {
        count = 0;
        for (int q = 0; q < length; ++q) {
            const std::int64_t height_q = height(q);
            if (height_q == kNever)
                continue;
            int begin = 0;
            while (count > 0) {
                // The first x at which q's parabola is as low as the last one's.
                const std::int64_t v = centers[count - 1];
                const std::int64_t over =
                    height_q + std::int64_t{q} * q - height(static_cast<int>(v)) - v * v;
                const std::int64_t twice = 2 * (q - v);
                const std::int64_t meets = over <= 0 ? 0 : (over + twice - 1) / twice;
                begin = static_cast<int>(std::min<std::int64_t>(meets, length));
                if (begin > begins[count - 1])
                    break;
                --count;
                begin = 0;
            }
            if (begin >= length)
                continue;
            centers[count] = q;
            begins[count] = begin;
            ++count;
        }
    }
    /// Calls visit(x, q) for each x below `length` with the center q of what is lowest there.
    template <class Visit> void walk(int length, Visit visit) const {
        for (std::size_t k = 0; k < count; ++k) {
            const int end = k + 1 < count ? begins[k + 1] : length;
            for (int x = begins[k]; x < end; ++x)
                visit(x, centers[k]);
        }
    }
};

} // namespace

void Dilation::squares(uvec2 extent, std::span<const int> radius, std::span<std::uint8_t> grown) {
    const auto width = static_cast<int>(extent.x), height = static_cast<int>(extent.y);
    HONE_ASSERT(radius.size() == grown.size() && radius.size() == std::size_t{extent.x} * extent.y,
                "one radius and one result a pixel");
    const std::size_t pitch = extent.x + 1;
    sums_.assign(pitch * (extent.y + 1), 0);

    // Mark where squares begin and end, by their corners.
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const int r =
                radius[static_cast<std::size_t>(y) * extent.x + static_cast<std::size_t>(x)];
            if (r < 0)
                continue;
            const auto left = static_cast<std::size_t>(std::max(x - r, 0));
            const auto right = static_cast<std::size_t>(std::min(x + r + 1, width));
            const std::size_t top = static_cast<std::size_t>(std::max(y - r, 0)) * pitch;
            const std::size_t bottom =
                static_cast<std::size_t>(std::min(y + r + 1, height)) * pitch;
            ++sums_[top + left];
            --sums_[top + right];
            --sums_[bottom + left];
            ++sums_[bottom + right];
        }
    // Sum along rows, then down the columns: how many squares lie over each pixel.
    tbb::parallel_for(std::size_t{0}, std::size_t{extent.y}, [&](std::size_t y) {
        for (std::size_t x = 1; x < extent.x; ++x)
            sums_[y * pitch + x] += sums_[y * pitch + x - 1];
    });
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, extent.x, 64), [&](const auto& columns) {
        for (std::size_t y = 0; y < extent.y; ++y)
            for (std::size_t x = columns.begin(); x < columns.end(); ++x) {
                int& sum = sums_[y * pitch + x];
                if (y > 0)
                    sum += sums_[(y - 1) * pitch + x];
                grown[y * extent.x + x] = sum > 0 ? 1 : 0;
            }
    });
}

void Dilation::discs(uvec2 extent, std::span<const int> radius, std::span<std::uint8_t> grown) {
    const std::size_t width = extent.x, height = extent.y, pixels = width * height;
    HONE_ASSERT(radius.size() == grown.size() && radius.size() == pixels,
                "one radius and one result a pixel");
    by_column_.resize(pixels);
    centers_.resize(pixels);
    begins_.resize(pixels);

    // Along each row: the least of distance^2 - radius^2.
    tbb::parallel_for(std::size_t{0}, height, [&](std::size_t y) {
        const std::span<const int> row = radius.subspan(y * width, width);
        Envelope envelope{std::span(centers_).subspan(y * width, width),
                          std::span(begins_).subspan(y * width, width)};
        const auto depth = [&](int q) {
            const int r = row[static_cast<std::size_t>(q)];
            return r < 0 ? kNever : -r * r;
        };
        envelope.build(static_cast<int>(width), depth);
        if (envelope.count == 0)
            for (std::size_t x = 0; x < width; ++x)
                by_column_[x * height + y] = kNever;
        envelope.walk(static_cast<int>(width), [&](int x, int q) {
            by_column_[static_cast<std::size_t>(x) * height + y] = (x - q) * (x - q) + depth(q);
        });
    });
    // Down each column; what is above 0 already reaches nothing.
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, width, 64), [&](const auto& columns) {
        for (std::size_t x = columns.begin(); x < columns.end(); ++x) {
            const std::span<const int> column = std::span(by_column_).subspan(x * height, height);
            Envelope envelope{std::span(centers_).subspan(x * height, height),
                              std::span(begins_).subspan(x * height, height)};
            const auto depth = [&](int q) {
                const int least = column[static_cast<std::size_t>(q)];
                return least > 0 ? kNever : least;
            };
            envelope.build(static_cast<int>(height), depth);
            for (std::size_t y = 0; y < height; ++y)
                grown[y * width + x] = 0;
            envelope.walk(static_cast<int>(height), [&](int y, int q) {
                grown[static_cast<std::size_t>(y) * width + x] =
                    (y - q) * (y - q) + depth(q) <= 0 ? 1 : 0;
            });
        }
    });
}

} // namespace hone

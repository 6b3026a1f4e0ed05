// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/shading/lens_blur_lanes.h"

#include "hone/core/device/kernel.glsl.h"
#include "hone/passes/shading/lanes.h"
#include "hone/passes/shading/lens_blur.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace hone {
namespace {

constexpr uint kTile = LensBlur::kTile;
static_assert(kTile % kLanes == 0, "lanes of one group share a tile, and so its taps");

/// The source as a kernel sees it, for what is computed pixel by pixel.
struct Pixels : HostKernel {
    using HostKernel::HostKernel;
    static vec3 blurSource(uint) { return vec3(0); }
#include "hone/passes/shading/lens_blur.glsl.h"
};

/// Channels of several pixels' colours.
template <int kChannels> struct LaneColor {
    Lanes channel[kChannels] = {};

    void operator+=(const LaneColor& other) {
        for (int c = 0; c < kChannels; ++c)
            channel[c] += other.channel[c];
    }
    friend LaneColor operator*(Lanes weight, const LaneColor& color) {
        LaneColor result;
        for (int c = 0; c < kChannels; ++c)
            result.channel[c] = weight * color.channel[c];
        return result;
    }
};

/// The arithmetic of the blur in lanes. What GLM calls min, max and clamp, to the bit.
template <int kChannels> struct LaneBlur {
    using BlurReal = Lanes;
    using BlurMask = LaneMask;
    using BlurColor = LaneColor<kChannels>;

    static float sqrt(float a) { return std::sqrt(a); }
    static Lanes abs(Lanes a) {
        return reinterpret_cast<Lanes>(reinterpret_cast<LaneMask>(a) & 0x7fffffff);
    }
    static Lanes min(Lanes a, float b) { return b < a ? b : a; }
    static Lanes max(Lanes a, Lanes b) { return a < b ? b : a; }
    static Lanes max(float a, Lanes b) { return a < b ? b : a; }
    static Lanes clamp(Lanes a, float low, float high) {
        const Lanes raised = a < low ? low : a;
        return high < raised ? high : raised;
    }
#include "hone/passes/shading/blur_layers.glsl.h"
};

/// Blurs one frame. Spreads what is known of its pixels over planes, one of each number, whose rows
/// are padded to both sides, so that nobody has to ask where the image ends.
template <class Color> class FrameBlur {
public:
    FrameBlur(const LensBlurLanes::Frame& frame, std::span<const Color> source,
              std::span<Color> blurred)
        : frame_(frame), source_(source), blurred_(blurred), tiles_(LensBlur::tiles(frame.extent)),
          reach_(frame.reach.as<float>().first(std::size_t{tiles_.x} * tiles_.y)),
          pixels_(argumentsOf(frame), nullptr) {}

    void run(std::vector<float>& memory) {
        const float greatest = *std::ranges::max_element(reach_);
        if (greatest > 0.5f)
            fillPlanes(static_cast<std::size_t>(greatest + 0.5f) + kLanes, memory);
        tbb::parallel_for(tbb::blocked_range<uint>(0, tiles_.x * tiles_.y, 4),
                          [&](const auto& range) {
                              for (uint tile = range.begin(); tile < range.end(); ++tile)
                                  blurTile(tile);
                          });
    }

private:
    /// Looked at while a kernel is made, and no longer.
    static Arguments argumentsOf(const LensBlurLanes::Frame& frame) {
        Arguments arguments;
        arguments.bind("confusion", frame.confusion);
        arguments.bind("blur_reach", frame.reach);
        return arguments;
    }

    static constexpr int kChannels = Color::length();
    using Blur = LaneBlur<kChannels>;
    enum Plane : std::size_t {
        kDiameter,
        kRadius,
        kInverseArea,
        kSlopeX,
        kSlopeY,
        kTolerance,
        kColor, ///< and a plane each for the channels that follow
        kPlanes = kColor + kChannels
    };

    /// Of column 0 of a row; as many columns as are padded may be read before it.
    [[nodiscard]] float* rowOf(std::size_t plane, std::size_t y) const {
        return planes_ + (plane * frame_.extent.y + y) * pitch_ + padding_;
    }
    [[nodiscard]] Lanes load(std::size_t plane, std::size_t row, int column) const {
        return loadLanes(rowOf(plane, row) + column);
    }
    [[nodiscard]] typename Blur::BlurDisc loadDisc(std::size_t row, int column) const {
        return {load(kDiameter, row, column), load(kRadius, row, column),
                load(kInverseArea, row, column)};
    }

    /// Beside the image lie discs of negative radius.
    void fillPlanes(std::size_t padding, std::vector<float>& memory) {
        const uvec2 extent = frame_.extent;
        padding_ = padding;
        pitch_ = std::size_t{tiles_.x} * kTile + 2 * padding;
        if (memory.size() < pitch_ * extent.y * kPlanes)
            memory.resize(pitch_ * extent.y * kPlanes);
        planes_ = memory.data();
        const Pixels::BlurWindow window{extent, frame_.taps, frame_.radius_limit};
        tbb::parallel_for(uint{0}, extent.y, [&](uint y) {
            float* rows[kPlanes];
            for (std::size_t plane = 0; plane < kPlanes; ++plane) {
                rows[plane] = rowOf(plane, y);
                const float beside = plane == kRadius ? -1.0f : 0.0f;
                std::fill_n(rows[plane] - padding, padding, beside);
                std::fill_n(rows[plane] + extent.x, pitch_ - padding - extent.x, beside);
            }
            for (uint x = 0; x < extent.x; ++x) {
                const uint index = y * extent.x + x;
                const Pixels::BlurSurface surface = pixels_.blurSurface(index, window);
                rows[kDiameter][x] = surface.disc.diameter;
                rows[kRadius][x] = surface.disc.radius;
                rows[kInverseArea][x] = surface.disc.inverse_area;
                rows[kSlopeX][x] = surface.slope_x;
                rows[kSlopeY][x] = surface.slope_y;
                rows[kTolerance][x] = surface.inverse_tolerance;
                for (int c = 0; c < kChannels; ++c)
                    rows[kColor + static_cast<std::size_t>(c)][x] =
                        pixels_.cutToSum(source_[index][c]);
            }
        });
    }

    void blurTile(uint tile) {
        const uvec2 first = kTile * uvec2(tile % tiles_.x, tile / tiles_.x);
        const uvec2 end = min(first + kTile, frame_.extent);
        const bool is_wanted = frame_.wanted.empty() || frame_.wanted[tile] != 0;
        for (uint y = first.y; y < end.y; ++y) {
            const std::size_t begin = std::size_t{y} * frame_.extent.x + first.x;
            const std::size_t count = end.x - first.x;
            if (!is_wanted)
                std::ranges::fill(blurred_.subspan(begin, count), Color(0));
            else if (reach_[tile] <= 0.5f)
                std::ranges::copy(source_.subspan(begin, count),
                                  blurred_.subspan(begin, count).begin());
            else
                for (uint x = first.x; x < end.x; x += kLanes)
                    blurLanes(x, y, tile);
        }
    }

    /// Blurs kLanes pixels from (x, y) on, which lie in one tile.
    void blurLanes(uint x, uint y, uint tile) {
        const auto left = static_cast<int>(x), right = static_cast<int>(frame_.extent.x);
        Blur blur;
        const typename Blur::BlurSurface surface{loadDisc(y, left), load(kSlopeX, y, left),
                                                 load(kSlopeY, y, left), load(kTolerance, y, left)};
        const float most = (reach_[tile] + 0.5f) * (reach_[tile] + 0.5f);

        // Sum the layers.
        typename Blur::BlurLayers layers{};
        const Pixels::BlurTaps taps =
            pixels_.blurTaps(y * frame_.extent.x + x, frame_.extent, frame_.taps);
        const int steps = static_cast<int>(std::floor(reach_[tile] + 0.5f)) / taps.stride;
        for (int step_y = taps.first.y; step_y <= taps.last.y; ++step_y) {
            const auto row = static_cast<std::size_t>(static_cast<int>(y) + step_y * taps.stride);
            for (int step_x = -steps; step_x <= steps; ++step_x) {
                const auto off = blur.blurStep(step_x * taps.stride, step_y * taps.stride);
                if (off.dx * off.dx + off.dy * off.dy >= most)
                    continue;
                const int column = left + step_x * taps.stride;
                const typename Blur::BlurDisc disc = loadDisc(row, column);
                LaneMask is_out = blur.isOutOfReach(surface, disc, off);
                if (column < 0 || column + static_cast<int>(kLanes) > right)
                    is_out |= disc.radius < 0.0f;
                typename Blur::BlurShare share = blur.blurShare(surface, disc, off);
                share.spread = is_out ? 0.0f : share.spread;
                share.open = is_out ? 0.0f : share.open;
                typename Blur::BlurColor color; // 0 times what is not finite would be added, too
                for (std::size_t c = 0; c < kChannels; ++c)
                    color.channel[c] = is_out ? 0.0f : load(kColor + c, row, column);
                blur.addToLayers(layers, share, off, color);
            }
        }

        // Lay them over each other. Where nothing arrived but the pixel itself, it stays.
        const auto tap_area = static_cast<float>(taps.stride * taps.stride);
        const uint count = std::min(kLanes, frame_.extent.x - x);
        for (int c = 0; c < kChannels; ++c) {
            const Lanes laid = blur.laidOver(layers, layers.front.channel[c], layers.own.channel[c],
                                             layers.behind.channel[c], tap_area);
            for (uint lane = 0; lane < count; ++lane) {
                const uint index = y * frame_.extent.x + x + lane;
                blurred_[index][c] = layers.arrivals[lane] > 1.0f ? laid[lane] : source_[index][c];
            }
        }
    }

    const LensBlurLanes::Frame& frame_;
    std::span<const Color> source_;
    std::span<Color> blurred_;
    uvec2 tiles_;
    std::span<const float> reach_;
    Pixels pixels_; // shared by all threads: it keeps nothing between calls
    std::size_t padding_ = 0, pitch_ = 0;
    float* planes_ = nullptr;
};

} // namespace

void LensBlurLanes::blur(const Frame& frame, std::span<const vec3> source,
                         std::span<vec3> blurred) {
    FrameBlur<vec3>(frame, source, blurred).run(planes_);
}

void LensBlurLanes::blur(const Frame& frame, std::span<const vec2> source,
                         std::span<vec2> blurred) {
    FrameBlur<vec2>(frame, source, blurred).run(planes_);
}

} // namespace hone

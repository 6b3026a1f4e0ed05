// SPDX-License-Identifier: Apache-2.0
//
// weight.ypg01: errors in units of what an eye would notice.
//
// From the raster image, a tolerance for each pixel: the difference of luminance that is just not
// seen there,
//
//     tolerance = elevation * threshold(adaptation)
//
// threshold: of an eye adapted to the mean luminance of about one degree around. elevation: how
// much the image's own detail hides, 1 + sum over octaves of R_i (S_peak / S(f_i) - 1), where R_i
// is octave i's share of the contrast there and S the sensitivity to its frequency on a retina that
// moves at `velocity`. An octave to which eyes are less sensitive hides more; contrast that is
// below threshold itself hides in proportion. Sensitivities below 1 count as 1: no contrast is
// above it.
//
// out expect = in expect / tolerance, in just noticeable differences. bound passes as it is: what
// is not noticed may be wrong all the same. Errors that are not finite count as 1, negative ones as
// 0. Computed at half resolution, each 2 x 2 pixels one
// tolerance.
//
// What the source has and this has not: velocities by pixel (the scene does not move), and a map of
// what attracts attention.
//
// in   error  Error
// in   color  Radiance: the raster image; 1 is display white
// out  error      Error
// out  tolerance  Tolerance
// params  pixels_per_degree  of visual angle (40: 96 dpi from 60 cm)
//         white              luminance of display white, cd/m^2 (100)
//         velocity           of the image, degrees / s (0)
//
//     "seen": { "type": "weight.ypg01", "in": { "error": "combine.error",
//               "color": "raster.color" } }
//
// Source: Yee, Pattanaik, Greenberg, Spatiotemporal Sensitivity and Visual Attention for Efficient
// Rendering of Dynamic Environments, 2001; its structure as we recall it, constants in vision.h.
#include "hone/passes/passes.h"

#include "hone/core/device/kernel.glsl.h"
#include "hone/passes/weight/ypg01/vision.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace hone {
namespace {

struct Library : HostKernel {
    Library() : HostKernel(Arguments{}, nullptr) {}
#include "hone/passes/shading/sanitised.glsl.h"
};

constexpr std::size_t kOctaves = 7;

/// A grey image.
struct Grey {
    uvec2 extent{0, 0};
    std::vector<float> values;

    void resize(uvec2 size) {
        extent = size;
        values.resize(std::size_t{size.x} * size.y);
    }
    [[nodiscard]] float& at(uint x, uint y) { return values[std::size_t{y} * extent.x + x]; }
    [[nodiscard]] float clamped(int x, int y) const {
        const auto inside = [](int i, uint size) {
            return static_cast<std::size_t>(std::clamp(i, 0, static_cast<int>(size) - 1));
        };
        return values[inside(y, extent.y) * extent.x + inside(x, extent.x)];
    }
    /// Bilinear, at a position in pixels (centres at .5), of a level half as large.
    [[nodiscard]] float between(float x, float y) const {
        const float left = std::floor(x - 0.5f), top = std::floor(y - 0.5f);
        const float fx = x - 0.5f - left, fy = y - 0.5f - top;
        const int ix = static_cast<int>(left), iy = static_cast<int>(top);
        return (1 - fy) * ((1 - fx) * clamped(ix, iy) + fx * clamped(ix + 1, iy)) +
               fy * ((1 - fx) * clamped(ix, iy + 1) + fx * clamped(ix + 1, iy + 1));
    }
};

/// Calls visit(x, y) for every pixel.
template <class Visit> void forEachPixel(uvec2 extent, const Visit& visit) {
    tbb::parallel_for(0u, extent.y, [&](uint y) {
        for (uint x = 0; x < extent.x; ++x)
            visit(x, y);
    });
}

uvec2 half(uvec2 extent) {
    return {(extent.x + 1) / 2, (extent.y + 1) / 2};
}

/// Each pixel the mean of 2 x 2; the last row and column count twice where there is no other.
void shrink(const Grey& from, Grey& to) {
    to.resize(half(from.extent));
    forEachPixel(to.extent, [&](uint x, uint y) {
        const int ix = static_cast<int>(2 * x), iy = static_cast<int>(2 * y);
        to.at(x, y) = 0.25f * ((from.clamped(ix, iy) + from.clamped(ix + 1, iy)) +
                               (from.clamped(ix, iy + 1) + from.clamped(ix + 1, iy + 1)));
    });
}

/// Rec. 709, what a display can show of it; what is not finite is black.
float luminanceOf(vec3 color) {
    const float luminance = glm::dot(color, vec3(0.2126f, 0.7152f, 0.0722f));
    return std::isfinite(luminance) ? std::clamp(luminance, 0.0f, 1.0f) : 0.0f;
}

class Ypg01 final : public RenderPass {
public:
    void execute(PassContext& context) override {
        const float white = context.param<float>("white");
        const float pixels_per_degree = context.param<float>("pixels_per_degree");
        findLuminances(context, white);
        findElevations(pixels_per_degree, context.param<float>("velocity"));
        findTolerances(pixels_per_degree, white);

        const std::span<const vec2> in = context.in("error").as<vec2>();
        const std::span<vec2> out = context.out("error").as<vec2>();
        const std::span<float> tolerance = context.out("tolerance").as<float>();
        Library library;
        forEachPixel(context.extent, [&](uint x, uint y) {
            const std::size_t pixel = std::size_t{y} * context.extent.x + x;
            tolerance[pixel] = tolerance_.at(x / 2, y / 2);
            const float expect = library.sanitised(in[pixel].x) / tolerance[pixel];
            out[pixel] = {std::min(expect, std::numeric_limits<float>::max()),
                          library.sanitised(in[pixel].y)};
        });
    }

private:
    /// The pyramid: level 0 is half the image.
    void findLuminances(const PassContext& context, float white) {
        const std::span<const vec3> color = context.in("color").as<vec3>();
        Grey& whole = scratch_;
        whole.resize(context.extent);
        forEachPixel(context.extent, [&](uint x, uint y) {
            whole.at(x, y) = white * luminanceOf(color[std::size_t{y} * context.extent.x + x]);
        });
        shrink(whole, levels_[0]);
        for (std::size_t level = 1; level < levels_.size(); ++level)
            shrink(levels_[level - 1], levels_[level]);
    }

    /// The highest frequency that level i holds is a cycle in two of its pixels, the lowest half of
    /// that; what is in between counts as their geometric mean.
    static double frequencyOf(std::size_t octave, double pixels_per_degree) {
        return pixels_per_degree / 4.0 / std::sqrt(2.0) / static_cast<double>(1u << octave);
    }

    void findElevations(float pixels_per_degree, float velocity) {
        const double v = vision::retinalVelocity(velocity);
        const double peak = vision::sensitivity(vision::peakFrequency(v), v);
        std::array<float, kOctaves> hides{};
        for (std::size_t i = 0; i < kOctaves; ++i)
            hides[i] = static_cast<float>(
                peak / std::max(vision::sensitivity(frequencyOf(i, pixels_per_degree), v), 1.0) -
                1);
        const float least_contrast = static_cast<float>(1 / peak);

        elevation_.resize(levels_[0].extent);
        forEachPixel(elevation_.extent, [&](uint x, uint y) {
            float total = 0, hidden = 0;
            for (std::size_t i = 0; i < kOctaves; ++i) {
                // The octave is what the next level has lost of this one.
                const float scale = 1.0f / static_cast<float>(1u << i);
                const float px = (static_cast<float>(x) + 0.5f) * scale;
                const float py = (static_cast<float>(y) + 0.5f) * scale;
                const float mean = levels_[i + 1].between(0.5f * px, 0.5f * py);
                const float here = i == 0 ? levels_[0].at(x, y) : levels_[i].between(px, py);
                const float contrast = mean > 0 ? std::abs(here - mean) / mean : 0.0f;
                total += contrast;
                hidden += contrast * hides[i];
            }
            elevation_.at(x, y) = 1 + hidden / std::max(total, least_contrast);
        });
    }

    void findTolerances(float pixels_per_degree, float white) {
        // The level whose pixels are nearest to a degree wide.
        const double level = std::round(std::log2(std::max(0.5 * pixels_per_degree, 1.0)));
        const std::size_t adapted = std::min(static_cast<std::size_t>(level), kOctaves);
        tolerance_.resize(elevation_.extent);
        const float scale = 1.0f / static_cast<float>(1u << adapted);
        forEachPixel(tolerance_.extent, [&](uint x, uint y) {
            const float luminance = levels_[adapted].between(
                (static_cast<float>(x) + 0.5f) * scale, (static_cast<float>(y) + 0.5f) * scale);
            tolerance_.at(x, y) =
                elevation_.at(x, y) * static_cast<float>(vision::thresholdOf(luminance)) / white;
        });
    }

    Grey scratch_;
    std::array<Grey, kOctaves + 1> levels_;
    Grey elevation_, tolerance_;
};

} // namespace

PassType ypg01WeightPass() {
    return PassType("weight.ypg01", "Errors in units of what an eye would notice")
        .in("error", types::kError, "in units of radiance where 1 is display white")
        .in("color", types::kRadiance, "the raster image; 1 is display white")
        .out("error", types::kError, "expect in just noticeable differences; bound as it came")
        .out("tolerance", types::kTolerance, "what is just not noticed")
        .param("pixels_per_degree", 40.0f, {.min = 1, .max = 1000},
               "pixels of a degree of visual angle")
        .param("white", 100.0f, {.min = 1, .max = 100000}, "luminance of display white, cd/m^2")
        .param("velocity", 0.0f, {.min = 0, .max = 1000},
               "how fast the image moves, degrees of visual angle a second")
        .promises(Promise::kMonotone)
        .implementedBy<Ypg01>(Domain::kHost);
}

} // namespace hone

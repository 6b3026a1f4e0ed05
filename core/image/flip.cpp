// SPDX-License-Identifier: Apache-2.0
//
// In the order of the paper (flip.h): what is left of colours at this distance, how far apart they
// look, which edges and points come or go, and all as one number. Luminance and opponent colours
// are those of YCxCz up to a factor and an offset, which filters that sum to 1 keep: (Y, X - Y,
// Y - Z), each relative to white.
#include "hone/core/image/flip.h"

#include "hone/core/error.h"
#include "hone/core/image/flip_filter.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>

namespace hone {
namespace {

using Colors = std::vector<vec3>;

// --- Colours

/// Linear sRGB to XYZ relative to white, from the primaries and white of IEC 61966-2-1.
glm::dmat3 relativeXyz() {
    const glm::dvec3 white = glm::dvec3(0.3127, 0.3290, 0.3583) / 0.3290;
    const glm::dmat3 primaries(0.64, 0.33, 0.03, 0.30, 0.60, 0.10, 0.15, 0.06, 0.79);
    const glm::dvec3 amount = glm::inverse(primaries) * white;
    glm::dmat3 xyz;
    for (glm::length_t c = 0; c < 3; ++c)
        xyz[c] = primaries[c] * amount[c] / white;
    return xyz;
}

/// CIELab of XYZ relative to white, with less colour where it is dark (the Hunt effect).
vec3 huntLab(vec3 xyz) {
    constexpr float kEdge = 6.0f / 29;
    const auto f = [](float t) {
        return t > kEdge * kEdge * kEdge ? std::cbrt(t) : t / (3 * kEdge * kEdge) + 4.0f / 29;
    };
    const float x = f(xyz.x), y = f(xyz.y), z = f(xyz.z);
    const float lightness = 116 * y - 16;
    return {lightness, 0.01f * lightness * 500 * (x - y), 0.01f * lightness * 200 * (y - z)};
}

/// HyAB (Abasi et al., Distancing from a Small Color Distance, 2020), compressed (q_c = 0.7).
float colorDistance(vec3 a, vec3 b) {
    const vec3 d = a - b;
    return std::pow(std::abs(d.x) + std::hypot(d.y, d.z), 0.7f);
}

/// The sRGB transfer function backwards (IEC 61966-2-1), for x in [0,1].
float decodeSrgb(float x) {
    return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
}

/// Linear sRGB, finite and not negative; of a display image at most 1.
Colors linearColors(const RgbImage& image) {
    Colors colors = image.pixels;
    for (vec3& color : colors)
        for (glm::length_t c = 0; c < 3; ++c) {
            const float x = std::isfinite(color[c]) ? std::max(color[c], 0.0f) : 0.0f;
            color[c] = image.is_display ? decodeSrgb(std::min(x, 1.0f)) : x;
        }
    return colors;
}

// --- LDR-FLIP

/// What somebody sees of an image.
struct Percept {
    Colors colors;       ///< huntLab of what is left of them
    Plane edges, points; ///< lengths of the gradients of luminance
};

class Observer {
public:
    Observer(uvec2 extent, double pixels_per_degree, ParallelFor parallel_for)
        : extent_(extent), parallel_for_(parallel_for),
          sensitivities_(sensitivityFilters(pixels_per_degree)),
          edges_(edgeFilters(pixels_per_degree)), points_(pointFilters(pixels_per_degree)) {}

    /// Of linear colours in [0,1].
    [[nodiscard]] std::vector<float> errors(const Colors& a, const Colors& b) const {
        const Percept seen_a = perceive(a), seen_b = perceive(b);
        const float green_to_blue = colorDistance(huntLab(xyz_[1]), huntLab(xyz_[2]));
        std::vector<float> result(a.size());
        forEachPixel([&](std::size_t i) {
            // Distances below p_c = 0.4 of the largest take p_t = 0.95 of the range.
            const float d = colorDistance(seen_a.colors[i], seen_b.colors[i]) / green_to_blue;
            const float color = d < 0.4f ? 0.95f / 0.4f * d : 0.95f + 0.05f / 0.6f * (d - 0.4f);
            const double feature = std::max(std::abs(seen_a.edges[i] - seen_b.edges[i]),
                                            std::abs(seen_a.points[i] - seen_b.points[i]));
            const double amplified = std::sqrt(feature / std::numbers::sqrt2); // q_f = 0.5
            result[i] = std::min(std::pow(color, static_cast<float>(1 - amplified)), 1.0f);
        });
        return result;
    }

private:
    template <class Body> void forEachPixel(const Body& body) const {
        forEachIndex(parallel_for_, extent_.y, [&](std::size_t y) {
            for (std::size_t x = 0; x < extent_.x; ++x)
                body(y * extent_.x + x);
        });
    }

    [[nodiscard]] Percept perceive(const Colors& linear) const {
        std::array<Plane, 3> channels;
        channels.fill(Plane(linear.size()));
        forEachPixel([&](std::size_t i) {
            const glm::dvec3 xyz = xyz_ * glm::dvec3(linear[i]);
            channels[0][i] = xyz.y;
            channels[1][i] = xyz.x - xyz.y;
            channels[2][i] = xyz.y - xyz.z;
        });
        Percept percept{Colors(linear.size()), gradient(channels[0], edges_),
                        gradient(channels[0], points_)};
        for (std::size_t c = 0; c < 3; ++c)
            channels[c] = filtered(channels[c], extent_, sensitivities_[c], parallel_for_);
        forEachPixel([&](std::size_t i) {
            const double y = channels[0][i];
            const glm::dvec3 rgb = rgb_ * glm::dvec3(channels[1][i] + y, y, y - channels[2][i]);
            percept.colors[i] = huntLab(xyz_ * glm::clamp(rgb, 0.0, 1.0));
        });
        return percept;
    }

    [[nodiscard]] Plane gradient(const Plane& luminance, const std::array<Filter, 2>& along) const {
        Plane length = filtered(luminance, extent_, along[0], parallel_for_);
        const Plane down = filtered(luminance, extent_, along[1], parallel_for_);
        forEachPixel([&](std::size_t i) { length[i] = std::hypot(length[i], down[i]); });
        return length;
    }

    uvec2 extent_;
    ParallelFor parallel_for_;
    glm::dmat3 xyz_ = relativeXyz(), rgb_ = glm::inverse(xyz_);
    std::array<Filter, 3> sensitivities_;
    std::array<Filter, 2> edges_, points_;
};

// --- HDR-FLIP

/// x (A x + B) / (x (C x + D) + E) of 0.6 times the radiance: Narkowicz, ACES Filmic Tone Mapping
/// Curve, 2015.
constexpr double kBefore = 0.6, kA = 2.51, kB = 0.03, kC = 2.43, kD = 0.59, kE = 0.14;

Colors toneMapped(const Colors& radiance, double stops) {
    Colors result(radiance.size());
    std::ranges::transform(radiance, result.begin(), [&](vec3 color) {
        const glm::dvec3 x = kBefore * std::exp2(stops) * glm::dvec3(color);
        return vec3(glm::min(x * (kA * x + kB) / (x * (kC * x + kD) + kE), 1.0));
    });
    return result;
}

/// What is tone-mapped to 0.85.
double almostWhite() {
    constexpr double t = 0.85, a = kA - t * kC, b = kB - t * kD, c = -t * kE;
    return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a) / kBefore;
}

void chooseExposures(const Colors& reference, FlipError& result) {
    const mat3 xyz(relativeXyz());
    std::vector<float> luminances;
    for (const vec3 color : reference)
        if (const float y = (xyz * color).y; y > 0)
            luminances.push_back(y);
    result.exposures = 1;
    if (luminances.empty())
        return;
    const auto median = luminances.begin() + static_cast<std::ptrdiff_t>(luminances.size() / 2);
    std::ranges::nth_element(luminances, median);
    const float largest = *std::max_element(median, luminances.end());
    result.first_exposure = std::log2(almostWhite() / largest);
    result.last_exposure = std::log2(almostWhite() / *median);
    if (const double span = result.last_exposure - result.first_exposure; span > 0)
        result.exposures = std::max(2u, static_cast<uint>(std::ceil(span)));
}

bool haveSameBits(vec3 a, vec3 b) {
    return std::bit_cast<std::array<uint, 3>>(a) == std::bit_cast<std::array<uint, 3>>(b);
}

bool isFinite(vec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

} // namespace

FlipError flip(const RgbImage& reference, const RgbImage& test, ParallelFor parallel_for,
               double pixels_per_degree) {
    const std::size_t count = reference.pixels.size();
    HONE_ASSERT(reference.extent == test.extent && count == test.pixels.size() && count > 0,
                std::to_string(count) + " and " + std::to_string(test.pixels.size()) + " pixels");
    HONE_ASSERT(reference.is_display == test.is_display, "a display and a linear image");
    HONE_ASSERT(pixels_per_degree >= 1 && pixels_per_degree <= 1000,
                std::to_string(pixels_per_degree));

    const Observer observer(reference.extent, pixels_per_degree, parallel_for);
    const Colors a = linearColors(reference), b = linearColors(test);
    FlipError result;
    if (reference.is_display) {
        result.pixels = observer.errors(a, b);
    } else {
        chooseExposures(a, result);
        result.pixels.resize(count);
        const double span = result.last_exposure - result.first_exposure;
        for (uint i = 0; i < result.exposures; ++i) {
            const double stops =
                result.first_exposure + (i == 0 ? 0 : span * i / (result.exposures - 1));
            const std::vector<float> errors =
                observer.errors(toneMapped(a, stops), toneMapped(b, stops));
            std::ranges::transform(result.pixels, errors, result.pixels.begin(),
                                   [](float x, float y) { return std::max(x, y); });
        }
    }

    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const vec3 x = reference.pixels[i], y = test.pixels[i];
        if (!haveSameBits(x, y) && !(isFinite(x) && isFinite(y)))
            result.pixels[i] = 1;
        sum += double(result.pixels[i]);
    }
    result.mean = sum / double(count);
    return result;
}

} // namespace hone

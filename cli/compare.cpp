// SPDX-License-Identifier: Apache-2.0
//
// hone compare: how far two images are apart.
#include "hone/cli/color_map.h"
#include "hone/cli/commands.h"
#include "hone/cli/explain_images.h"
#include "hone/cli/json.h"

#include "hone/backends/host/parallel_for.h"
#include "hone/core/error.h"
#include "hone/core/image/compare.h"
#include "hone/core/image/flip.h"
#include "hone/core/image/image.h"

#include <algorithm>
#include <cmath>
#include <ostream>

namespace hone::cli {
namespace {

/// Infinity has no spelling in JSON: null.
nlohmann::ordered_json finite(double number) {
    return std::isfinite(number) ? nlohmann::ordered_json(number) : nlohmann::ordered_json(nullptr);
}

/// Each pixel's largest channel difference; the scale's end is the largest of all.
void writeHeatMap(const std::string& path, const RgbImage& a, const RgbImage& b, double largest) {
    std::vector<vec3> colors(a.pixels.size());
    const float scale =
        largest > 0 && std::isfinite(largest) ? static_cast<float>(1.0 / largest) : 1.0f;
    std::ranges::transform(a.pixels, b.pixels, colors.begin(), [scale](vec3 x, vec3 y) {
        const vec3 d = glm::abs(x - y);
        return heatColor(std::max({d.x, d.y, d.z}) * scale);
    });
    writePng(path, quantize(a.extent, colors));
}

void writeFlipMap(const std::string& path, uvec2 extent, const FlipError& error) {
    std::vector<vec3> colors(error.pixels.size());
    std::ranges::transform(error.pixels, colors.begin(), heatColor);
    writePng(path, quantize(extent, colors));
}

/// Of HDR-FLIP; null of LDR-FLIP.
nlohmann::ordered_json exposures(const FlipError& error) {
    if (error.exposures == 0)
        return nullptr;
    return {
        {"count", error.exposures}, {"first", error.first_exposure}, {"last", error.last_exposure}};
}

void print(const ImageDifference& difference, const FlipError& error, std::size_t pixels,
           std::ostream& out) {
    out << "mse " << difference.mse << "\nrmse " << difference.rmse << "\npsnr " << difference.psnr
        << " dB\nssim " << difference.ssim << "\nflip " << error.mean;
    if (error.exposures > 0)
        out << " (HDR, exposures " << error.exposures << " from " << error.first_exposure << " to "
            << error.last_exposure << " stops)";
    out << "\nmax " << difference.max << "\ndiffering pixels " << difference.differing_pixels
        << " of " << pixels << "\ndiffering bits " << difference.differing_bits << "\n";
}

/// The explained pixels, one a line, and their sums.
void list(const nlohmann::ordered_json& explained, std::ostream& out) {
    for (const auto& pixel : explained["pixels"]) {
        out << "pixel " << pixel["x"] << "," << pixel["y"] << ": "
            << pixel["why"].get<std::string>();
        if (pixel.contains("border"))
            out << " (" << pixel["border"].get<std::string>() << ")";
        if (pixel.contains("ray"))
            out << ", " << pixel["ray_kind"].get<std::string>() << " ray "
                << pixel["ray"].get<std::string>() << ": " << pixel["a"].get<std::string>()
                << " or " << pixel["b"].get<std::string>();
        else
            out << ", no ray is answered differently";
        out << "\n";
    }
    out << "ties " << explained["ties"] << ", silhouettes " << explained["silhouettes"]
        << ", unexplained " << explained["unexplained"] << "\n";
}

} // namespace

int compare(const CompareArguments& arguments, const Console& console) {
    RgbImage a = readRgb(arguments.a, arguments.layer);
    RgbImage b = readRgb(arguments.b, arguments.layer);
    // A linear and a display image are compared as a screen would show them.
    if (a.is_display != b.is_display) {
        a = toDisplay(a);
        b = toDisplay(b);
    }
    const ImageDifference difference = compareImages(a, b);
    if (!arguments.heat_map.empty())
        writeHeatMap(arguments.heat_map, a, b, difference.max);
    const FlipError error = flip(b, a, hostParallelFor, arguments.pixels_per_degree);
    if (!arguments.flip_map.empty())
        writeFlipMap(arguments.flip_map, a.extent, error);
    nlohmann::ordered_json report{{"mse", finite(difference.mse)},
                                  {"rmse", finite(difference.rmse)},
                                  {"psnr", finite(difference.psnr)},
                                  {"ssim", finite(difference.ssim)},
                                  {"flip", error.mean},
                                  {"flip_exposures", exposures(error)},
                                  {"max", finite(difference.max)},
                                  {"differing_pixels", difference.differing_pixels},
                                  {"differing_bits", difference.differing_bits}};
    if (arguments.explain)
        report["explained"] = explainImages(arguments.a, a, arguments.b, b, arguments.plugins);
    const bool is_unexplained = arguments.explain && report["explained"]["unexplained"] != 0;
    if (arguments.json)
        print(console.out, report);
    else
        print(difference, error, a.pixels.size(), console.out);
    if (arguments.explain && !arguments.json)
        list(report["explained"], console.out);
    const bool too_far =
        arguments.max_difference >= 0 && !(difference.max <= arguments.max_difference);
    const bool too_many =
        arguments.max_differing_bits >= 0 &&
        difference.differing_bits > static_cast<std::uint64_t>(arguments.max_differing_bits);
    return too_far || too_many || is_unexplained ? kTargetNotMet : kOk;
}

} // namespace hone::cli

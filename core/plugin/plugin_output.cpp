// SPDX-License-Identifier: Apache-2.0
#include "hone/core/plugin/plugin_output.h"

#include "hone/core/pass/param.h"
#include "hone/core/plugin/plugin_host.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hone {
namespace {

std::string numberOf(float value) {
    return toString(ParamValue(value));
}

/// Which element of an output, in a person's words.
std::string place(const Value& output, std::size_t element) {
    if (output.type->shape == Shape::kPlane)
        return "pixel (" + std::to_string(element % output.extent.x) + ", " +
               std::to_string(element / output.extent.x) + ")";
    return "element " + std::to_string(element);
}

bool isFloatFormat(std::string_view format) {
    return format == "float" || format.starts_with("vec");
}

std::string whyNotInRange(const Value& output) {
    const PortType& type = *output.type;
    if (!isFloatFormat(type.format) || (!std::isfinite(type.min) && !std::isfinite(type.max)))
        return "";
    // NaN is in no range, infinity in none of finite ends.
    constexpr float kGreatest = std::numeric_limits<float>::max();
    const float min = std::max(type.min, -kGreatest), max = std::min(type.max, kGreatest);
    const std::size_t channels = type.stride / sizeof(float);
    const std::span<const float> numbers = output.buffer.as<float>().first(output.count * channels);
    // All at once, for it is fast and nearly always what there is to do.
    bool is_good = true;
    for (const float number : numbers)
        is_good &= number >= min && number <= max;
    if (is_good)
        return "";
    const auto bad = std::ranges::find_if(
        numbers, [&](float number) { return !(number >= min && number <= max); });
    return place(output, static_cast<std::size_t>(bad - numbers.begin()) / channels) + " has " +
           numberOf(*bad) + ", but numbers of " + std::string(type.name) + " are finite" +
           (std::isfinite(type.min) ? ", at least " + numberOf(type.min) : "") +
           (std::isfinite(type.max) ? ", at most " + numberOf(type.max) : "");
}

/// For elements of words, one of which is a pixel.
std::string whyNotPixels(const Value& output, std::size_t word, uvec2 extent) {
    const std::size_t words = output.type->stride / sizeof(uint);
    const std::span<const uint> all = output.buffer.as<uint>();
    const std::size_t pixels = std::size_t{extent.x} * extent.y;
    for (std::size_t i = 0; i < output.count; ++i)
        if (all[i * words + word] >= pixels)
            return place(output, i) + " names pixel " + std::to_string(all[i * words + word]) +
                   ", but the frame has " + std::to_string(pixels);
    return "";
}

std::string whyNotHits(const Value& output, const Scene& scene) {
    const std::span<const Hit> hits = output.as<Hit>();
    const auto bad = std::ranges::find_if_not(hits, [&](Hit hit) { return isInScene(scene, hit); });
    if (bad == hits.end())
        return "";
    return place(output, static_cast<std::size_t>(bad - hits.begin())) + " has instance " +
           std::to_string(bad->instance) + ", primitive " + std::to_string(bad->primitive) +
           ", which the scene does not have";
}

} // namespace

std::string whyNotUsable(const Value& output, uvec2 extent, const Scene* scene) {
    if (*output.type == types::kPixelList || *output.type == types::kRequestList)
        return whyNotPixels(output, 0, extent);
    if (*output.type == types::kSamples)
        return whyNotPixels(output, 3, extent);
    if (*output.type == types::kHits && scene != nullptr)
        return whyNotHits(output, *scene);
    return whyNotInRange(output);
}

} // namespace hone

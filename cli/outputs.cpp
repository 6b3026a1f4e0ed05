// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/outputs.h"

#include "hone/cli/color_map.h"
#include "hone/cli/value_file.h"
#include "hone/core/image/atomic_file.h"
#include "hone/core/image/png.h"

#include <algorithm>
#include <functional>

namespace hone::cli {
std::string fileStem(std::string name) {
    const auto is_plain = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '_' || c == '-';
    };
    std::ranges::replace_if(name, std::not_fn(is_plain), '_');
    return name;
}

std::vector<vec3> picture(const Value& value) {
    std::vector<vec3> result;
    if (value.type->shape != Shape::kPlane)
        return result;
    const auto map = [&]<class T>(std::span<T> elements, auto color) {
        result.resize(elements.size());
        std::ranges::transform(elements, result.begin(), color);
    };
    if (*value.type == types::kRadiance) {
        const std::span<vec3> pixels = value.as<vec3>();
        result = toDisplay({value.extent, {pixels.begin(), pixels.end()}, false}).pixels;
    } else if (*value.type == types::kDisplay) {
        map(value.as<vec3>(), [](vec3 color) { return color; });
    } else if (*value.type == types::kError) {
        map(value.as<vec2>(), [](vec2 error) { return heatColor(error.x); });
    } else if (*value.type == types::kRound) {
        const std::span<uint> rounds = value.as<uint>();
        const uint last = rounds.empty() ? 0u : std::max(1u, *std::ranges::max_element(rounds));
        // Early rounds glow, later ones fade; what was never traced is black.
        map(rounds, [last](uint round) {
            return round == 0 ? vec3(0)
                              : heatColor(1.0f - 0.85f * static_cast<float>(round - 1) /
                                                     static_cast<float>(last));
        });
    } else if (*value.type == types::kSampleCounts) {
        const std::span<uint> counts = value.as<uint>();
        const uint most = counts.empty() ? 1u : std::max(1u, *std::ranges::max_element(counts));
        map(counts, [most](uint count) {
            return heatColor(static_cast<float>(count) / static_cast<float>(most));
        });
    } else if (*value.type == types::kPixelOcclusion || *value.type == types::kTolerance) {
        map(value.as<float>(), [](float x) { return vec3(std::clamp(x, 0.0f, 1.0f)); });
    } else if (*value.type == types::kDepth) {
        const std::span<float> depths = value.as<float>();
        const float far =
            depths.empty() ? 1.0f : std::max(1e-6f, *std::ranges::max_element(depths));
        map(depths, [far](float depth) { return vec3(depth > 0 ? 1.0f - depth / far : 0.0f); });
    } else if (*value.type == types::kHits) {
        map(value.as<uvec2>(),
            [](uvec2 hit) { return idColor(hit.x == kNone ? 0u : hit.x * 7919u + hit.y + 1u); });
    }
    return result;
}

std::vector<std::string> writeOutputs(const Executor& executor, const std::string& directory,
                                      const Provenance& provenance, const std::string& number) {
    const auto file = [&](const std::string& name, const char* ending) {
        return directory + "/" + name + (number.empty() ? "" : "." + number) + ending;
    };
    std::vector<std::string> paths;
    LayeredImage layered{{0, 0}, {}, provenance};
    for (const std::string& name : executor.outputs()) {
        const Value& value = executor.output(name);
        if (value.type->shape == Shape::kCurve && value.curve != nullptr) {
            const std::string text = toCsv(value);
            paths.push_back(file(name, ".csv"));
            writeFileAtomically(paths.back(), std::as_bytes(std::span(text)));
        }
        if (value.type->shape != Shape::kPlane || value.version == 0)
            continue;
        layered.extent = value.extent;
        layered.layers.push_back(toLayer(name, value));
        if (const std::vector<vec3> pixels = picture(value); !pixels.empty()) {
            paths.push_back(file(name, ".png"));
            writePng(paths.back(), quantize(value.extent, pixels), provenance);
        }
    }
    if (!layered.layers.empty()) {
        paths.push_back(file(fileStem(executor.graph().name), ".exr"));
        writeExr(paths.back(), layered);
    }
    return paths;
}

} // namespace hone::cli

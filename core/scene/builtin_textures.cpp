// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/builtin_textures.h"

#include "hone/core/scene/builtin_shape.h"
#include "hone/core/scene/mipmap.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hone {
namespace {

constexpr float kTau = 2.0f * std::numbers::pi_v<float>;

std::uint8_t encodeSrgb(float linear) {
    const float x = std::clamp(linear, 0.0f, 1.0f);
    const float code = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
    return static_cast<std::uint8_t>(code * 255.0f + 0.5f);
}

float smooth(float low, float high, float x) {
    const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

/// Value noise of `period` cells, which repeats at 1.
float noise(vec2 p, uint period, uint seed) {
    const vec2 scaled = p * float(period);
    const vec2 cell = floor(scaled);
    const vec2 f = scaled - cell;
    const vec2 w = f * f * (3.0f - 2.0f * f);
    const auto corner = [&](int dx, int dy) {
        const int n = static_cast<int>(period);
        const auto x = static_cast<uint>(((static_cast<int>(cell.x) + dx) % n + n) % n);
        const auto y = static_cast<uint>(((static_cast<int>(cell.y) + dy) % n + n) % n);
        return chance(x + hashed(y + hashed(seed)));
    };
    return glm::mix(glm::mix(corner(0, 0), corner(1, 0), w.x),
                    glm::mix(corner(0, 1), corner(1, 1), w.x), w.y);
}

/// Octaves of noise, halved each; about 0 to 1.
float turbulence(vec2 p, uint period, uint octaves, uint seed) {
    float sum = 0, weight = 0.5f;
    for (uint octave = 0; octave < octaves; ++octave, weight *= 0.5f)
        sum += weight * noise(p, period << octave, seed + octave);
    return sum;
}

} // namespace

uint addTexture(Scene& scene, uvec2 extent, const std::function<vec4(vec2)>& color, uint wrap_u,
                uint wrap_v) {
    std::vector<std::uint8_t> rgba;
    rgba.reserve(4 * std::size_t(extent.x) * extent.y);
    for (uint y = 0; y < extent.y; ++y)
        for (uint x = 0; x < extent.x; ++x) {
            const vec4 c = color((vec2(x, y) + 0.5f) / vec2(extent));
            for (const float channel : {c.x, c.y, c.z})
                rgba.push_back(encodeSrgb(channel));
            rgba.push_back(static_cast<std::uint8_t>(std::clamp(c.w, 0.0f, 1.0f) * 255.0f + 0.5f));
        }
    return appendTexture(scene, extent, rgba, wrap_u, wrap_v);
}

uint addStoneTexture(Scene& scene, vec3 color, float contrast, uint seed) {
    return addTexture(scene, {512, 512}, [=](vec2 p) {
        const float stains = turbulence(p, 4, 5, seed) - 0.5f;
        const float grain = noise(p, 256, seed + 9) - 0.5f;
        const float rain = turbulence({p.x * 1.0f, p.y * 0.25f}, 24, 2, seed + 17) - 0.4f;
        const float shade = 1.0f + contrast * (1.1f * stains + 0.35f * grain + 0.3f * rain);
        const vec3 warm(1.0f + 0.10f * contrast * stains, 1.0f, 1.0f - 0.16f * contrast * stains);
        return vec4(color * shade * warm, 1.0f);
    });
}

uint addMasonryTexture(Scene& scene, uint across, uint courses, float joint, vec3 block,
                       vec3 mortar, uint seed) {
    return addTexture(scene, {512, 512}, [=](vec2 p) {
        const float wobble = 0.1f * joint * (noise(p, 24, seed + 3) - 0.5f);
        const float y = (p.y + wobble) * float(courses);
        const auto course = static_cast<uint>(std::floor(y + float(courses))) % courses;
        const float x = (p.x + wobble) * float(across) + (course % 2 == 1 ? 0.5f : 0.0f);
        const auto column = static_cast<uint>(std::floor(x + float(across))) % across;
        // Distance to the nearest joint, in courses; blocks are wider than high.
        const float aspect = float(courses) / float(across);
        const float fx = x - std::floor(x), fy = y - std::floor(y);
        const float edge = std::min(std::min(fx, 1.0f - fx) * aspect, std::min(fy, 1.0f - fy));
        const float is_block = smooth(0.5f * joint, 0.5f * joint + 0.06f, edge);
        const uint id = hashed(column + 131 * course + seed);
        const float tone = 0.78f + 0.40f * chance(id);
        const float stains = 0.62f + 0.76f * turbulence(p, 8, 5, seed + 5);
        const vec3 hue(1.0f + 0.10f * (chance(id + 1) - 0.5f), 1.0f,
                       1.0f - 0.14f * (chance(id + 2) - 0.5f));
        const vec3 stone = block * tone * stains * hue * (0.86f + 0.14f * smooth(0, 0.3f, edge));
        return vec4(glm::mix(mortar * stains, stone, is_block), 1.0f);
    });
}

uint addMarbleTexture(Scene& scene, vec3 ground, vec3 veins, uint seed) {
    return addTexture(scene, {512, 512}, [=](vec2 p) {
        const float swirl = turbulence(p, 3, 5, seed);
        const float vein = std::abs(std::sin(kTau * (p.x + p.y + 1.6f * swirl)));
        const float cloud = 0.85f + 0.3f * turbulence(p, 6, 4, seed + 31);
        return vec4(glm::mix(veins, ground, smooth(0.0f, 0.35f, vein)) * cloud, 1.0f);
    });
}

uint addClothTexture(Scene& scene, vec3 cloth, vec3 ornament) {
    return addTexture(scene, {256, 256}, [=](vec2 p) {
        const float weave = 0.92f + 0.08f * std::sin(kTau * 64 * p.x) * std::sin(kTau * 64 * p.y);
        // A lozenge in each cell of 4 x 4, with a stripe between every second row.
        const vec2 cell = abs(fract(p * 4.0f) - 0.5f);
        const float lozenge = cell.x + cell.y;
        const bool is_ornament =
            (lozenge > 0.17f && lozenge < 0.23f) || lozenge < 0.06f || cell.y > 0.475f;
        return vec4((is_ornament ? ornament : cloth) * weave, 1.0f);
    });
}

uint addLeafTexture(Scene& scene) {
    return addTexture(
        scene, {128, 256},
        [](vec2 p) {
            const float along = 1.0f - p.y; // 0 at the stem
            const float across = 2.0f * p.x - 1.0f;
            const float half_width =
                0.9f * std::pow(std::sin(0.5f * kTau * std::pow(along, 0.8f)), 0.8f);
            const float side_ribs =
                0.5f + 0.5f * std::sin(kTau * (14 * along - 5 * std::abs(across)));
            const float rib = smooth(0.09f, 0.03f, std::abs(across));
            const vec3 green =
                glm::mix(vec3(0.035f, 0.16f, 0.022f), vec3(0.10f, 0.30f, 0.045f), side_ribs);
            const vec3 color = glm::mix(green, vec3(0.28f, 0.42f, 0.12f), rib);
            // Colour goes on outside of the outline, so that no filter brings in another one.
            const float inside = half_width - std::abs(across) - 0.05f * side_ribs;
            return vec4(color * (0.75f + 0.5f * along), smooth(-0.04f, 0.04f, inside));
        },
        1, 1);
}

} // namespace hone

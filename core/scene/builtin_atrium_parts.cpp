// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/builtin_atrium_parts.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hone {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

using Profile = std::vector<vec2>;

/// Appends an arc about `center`; degrees run counter-clockwise from +radius.
void addArc(Profile& profile, vec2 center, vec2 radius, float from, float to, uint steps) {
    for (uint i = 0; i <= steps; ++i) {
        const float angle = glm::radians(glm::mix(from, to, float(i) / float(steps)));
        profile.push_back(center + radius * vec2(std::cos(angle), std::sin(angle)));
    }
}

float smooth(float low, float high, float x) {
    const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

} // namespace

Shape columnPart(float radius, float height, uint sides) {
    const float r = radius;
    const float side = 1.42f * r + 0.02f;
    Shape shape;
    shape.addBox({-side, -0.05f, -side}, {side, 0.16f, side});
    shape.addBox({-0.42f, height - 0.14f, -0.42f}, {0.42f, height, 0.42f});
    shape.projectUvs();

    Profile profile{{0, 0.10f}, {1.2f * r, 0.10f}};
    // Attic base: two bulges with a hollow between.
    addArc(profile, {1.22f * r, 0.23f}, {0.07f, 0.07f}, -90, 90, 6);
    addArc(profile, {1.24f * r, 0.34f}, {0.05f, 0.035f}, 250, 110, 4);
    addArc(profile, {1.12f * r, 0.40f}, {0.035f, 0.03f}, -60, 90, 5);
    // The shaft swells a little and thins to 0.84 of its foot.
    const float foot = 0.47f, neck = height - 0.52f;
    for (uint i = 0; i <= 12; ++i) {
        const float t = float(i) / 12.0f;
        const float swell = 1.0f - 0.16f * t * t + 0.03f * std::sin(kPi * t);
        profile.push_back({r * swell, glm::mix(foot, neck, t)});
    }
    addArc(profile, {0.86f * r, neck + 0.03f}, {0.03f, 0.025f}, -70, 80, 4);
    profile.push_back({0.84f * r, neck + 0.08f});
    profile.push_back({0.86f * r, neck + 0.20f});
    // Echinus.
    addArc(profile, {0.88f * r, height - 0.18f}, {0.40f - 0.88f * r, 0.13f}, -90, 0, 6);
    profile.push_back({0.40f, height - 0.12f});
    profile.push_back({0, height - 0.12f});
    shape.addLathe(profile, sides);
    return shape;
}

Shape archPart(float top) {
    constexpr float kRadius = 1.1f, kHalf = 1.5f, kDepth = 0.32f;
    constexpr uint kSteps = 24;
    const float corner = std::atan2(top, kHalf);
    std::vector<float> angles{corner, kPi - corner};
    for (uint i = 0; i <= kSteps; ++i)
        angles.push_back(kPi * float(i) / float(kSteps));
    std::sort(angles.begin(), angles.end());

    // One face, from the arch out to the frame.
    Shape face;
    const auto inner = [&](float a) {
        return vec3(kRadius * std::cos(a), kRadius * std::sin(a), kDepth);
    };
    const auto outer = [&](float a) {
        const vec2 d(std::cos(a), std::max(std::sin(a), 0.0f));
        const float reach =
            std::min(kHalf / std::max(std::abs(d.x), 1e-6f), top / std::max(d.y, 1e-6f));
        return vec3(reach * d.x, reach * d.y, kDepth);
    };
    for (std::size_t i = 0; i + 1 < angles.size(); ++i)
        face.addQuad(inner(angles[i]), outer(angles[i]), outer(angles[i + 1]),
                     inner(angles[i + 1]));
    face.projectUvs();
    // The moulding around it: half a torus, sunk into the wall.
    face.addSheet({kSteps, 6}, {3.9f, 0.3f}, [&](float u, float v) {
        const float r = kRadius + 0.12f + 0.085f * std::cos(kPi * v);
        const float z = kDepth - 0.01f + 0.07f * std::sin(kPi * v);
        return vec3(r * std::cos(kPi * u), r * std::sin(kPi * u), z);
    });
    Shape shape;
    shape.add(face, mat4(1));
    shape.add(face, placed(vec3(0), 180));
    shape.addSheet({kSteps, 1}, {3.5f, 2 * kDepth}, [&](float u, float v) {
        return vec3(kRadius * std::cos(kPi * u), kRadius * std::sin(kPi * u),
                    kDepth - 2 * kDepth * v);
    });
    for (const float x : {-kHalf, kRadius})
        shape.addQuad({x, 0, -kDepth}, {x + kHalf - kRadius, 0, -kDepth},
                      {x + kHalf - kRadius, 0, kDepth}, {x, 0, kDepth});
    return shape;
}

Shape bandPart(float length, float height, float depth) {
    // Seen along x: from the lower back edge forward, up in steps, and back.
    const float h = height, d = depth;
    Profile outline{{-d, 0}};
    addArc(outline, {-0.55f * d, 0.30f * h}, {0.25f * d, 0.30f * h}, -90, 0, 5);
    outline.push_back({-0.22f * d, 0.30f * h});
    addArc(outline, {-0.22f * d, 0.80f * h}, {0.22f * d, 0.40f * h}, -90, 0, 6);
    outline.push_back({0, h});
    outline.push_back({-d, h});
    Shape shape;
    const float x = 0.5f * length;
    for (std::size_t i = 0; i + 1 < outline.size(); ++i) {
        const vec2 a = outline[i], b = outline[i + 1];
        shape.addQuad({-x, a.y, a.x}, {x, a.y, a.x}, {x, b.y, b.x}, {-x, b.y, b.x});
    }
    shape.projectUvs();
    return shape;
}

Shape dentilPart(uint count, float pitch) {
    Shape shape;
    for (uint i = 0; i < count; ++i) {
        const float x = (float(i) - 0.5f * float(count - 1)) * pitch;
        shape.addBox({x - 0.07f, 0, -0.2f}, {x + 0.07f, 0.17f, 0});
    }
    shape.projectUvs();
    return shape;
}

Shape railingPart(float length, uint bars) {
    Shape shape;
    const float x = 0.5f * length;
    const auto rail = [&](float y, float radius, uint sides) {
        const vec3 path[] = {{-x, y, 0}, {x, y, 0}};
        shape.addTube(path, radius, sides);
    };
    rail(1.0f, 0.032f, 10);
    rail(0.82f, 0.012f, 6);
    rail(0.10f, 0.016f, 6);

    Profile bar{{0, 0.09f}, {0.009f, 0.09f}, {0.009f, 0.36f}};
    addArc(bar, {0.009f, 0.42f}, {0.016f, 0.05f}, -90, 90, 3);
    bar.insert(bar.end(), {{0.009f, 0.48f}, {0.009f, 0.99f}, {0, 0.99f}});
    const float pitch = length / float(bars);
    for (uint i = 0; i < bars; ++i) {
        Shape one;
        one.addLathe(bar, 6);
        const float at = (float(i) + 0.5f) * pitch - x;
        shape.add(one, placed({at, 0, 0}));
        if (i + 1 == bars)
            continue;
        // A ring between this bar and the next, under the second rail.
        std::vector<vec3> ring;
        const float radius = 0.5f * pitch - 0.004f;
        for (uint k = 0; k < 14; ++k) {
            const float angle = 2 * kPi * float(k) / 14.0f;
            ring.push_back({at + 0.5f * pitch + radius * std::cos(angle),
                            0.81f - radius + radius * std::sin(angle), 0});
        }
        shape.addTube(ring, 0.006f, 4, true);
    }
    return shape;
}

Shape curtainPart(float width, float height) {
    // The left half: drawn to x = -width / 2 by a tie at 0.58 of its height.
    Shape half;
    half.addSheet({30, 18}, {1.6f, height}, [&](float u, float v) {
        const float to_tie = smooth(0.0f, 0.58f, v), past_tie = smooth(0.58f, 1.0f, v);
        const float spread = 0.48f * width;
        const float across = spread * (1.0f - 0.72f * std::pow(to_tie, 1.4f) + 0.25f * past_tie);
        // Cloth that is pulled aside hangs lower inside than at the edge.
        const float sag = 0.12f * u * to_tie * (1.0f - past_tie);
        const float fold = std::sin(2 * kPi * (5.0f * u + 0.3f * std::sin(5.0f * u + 2.0f * v)));
        const float depth = glm::mix(0.045f, 0.075f, past_tie) * (1.0f - 0.35f * to_tie);
        const float belly = 0.06f * std::sin(kPi * v) * std::sin(3.0f * u + 1.0f);
        return vec3(-0.5f * width + across * u, -height * v - sag, depth * fold + belly);
    });
    // v runs down: seen from +z the sheet's front is away, which two sides do not mind.
    Shape shape;
    shape.add(half, mat4(1));
    shape.add(half, glm::scale(mat4(1), vec3(-1, 1, 1)));
    return shape;
}

Shape curtainRodPart(float width) {
    Shape shape;
    const vec3 path[] = {{-0.5f * width, 0.02f, 0}, {0.5f * width, 0.02f, 0}};
    shape.addTube(path, 0.022f, 10);
    return shape;
}

Shape bannerPart(float width, float height) {
    Shape shape;
    shape.addSheet({12, 24}, {width, height}, [&](float u, float v) {
        const float wave = 0.05f * std::sin(9.0f * u + 4.0f * v) * v + 0.03f * std::sin(7.0f * v);
        const float tail = 0.35f * (1.0f - 2.0f * std::abs(u - 0.5f));
        return vec3((u - 0.5f) * width, -height * v + tail * v * v * v, wave);
    });
    return shape;
}

Shape potPart() {
    Profile profile{{0, -0.03f}, {0.19f, -0.03f}, {0.20f, 0.0f}, {0.21f, 0.05f}};
    addArc(profile, {0.14f, 0.34f}, {0.18f, 0.29f}, -62, 30, 8);
    profile.push_back({0.27f, 0.54f});
    addArc(profile, {0.30f, 0.60f}, {0.035f, 0.035f}, -80, 140, 7);
    profile.push_back({0.25f, 0.57f});
    profile.push_back({0, 0.55f});
    Shape shape;
    shape.addLathe(profile, 22);
    return shape;
}

Shape leavesPart(uint count, float length, float lift, uint seed) {
    Shape shape;
    for (uint i = 0; i < count; ++i) {
        const uint id = hashed(seed) + 16 * i;
        const float azimuth = 2.399963f * float(i) + 0.6f * chance(id); // the golden angle
        const float inner = float(i) / float(count);                    // 0: outermost and lowest
        const float elevation =
            glm::radians(glm::mix(14.0f, 78.0f, inner) + 12.0f * chance(id + 1));
        const float reach = length * (0.75f + 0.5f * chance(id + 2));
        const float half_width = 0.085f * length * (1.1f + 0.6f * chance(id + 3));
        const float droop = glm::mix(0.75f, 0.35f, inner) * reach;
        const vec3 out(std::cos(azimuth), 0, std::sin(azimuth));
        const vec3 side(-out.z, 0, out.x);
        const float start = 0.05f * (1.0f - inner);
        shape.addSheet({2, 6}, vec2(1), [&](float u, float v) {
            const float s = 1.0f - v; // the texture's stem is at its bottom
            const float away = start + reach * s * std::cos(elevation);
            const float up = lift + reach * s * std::sin(elevation) - droop * s * s;
            const float crease = 0.5f * half_width * std::abs(2.0f * u - 1.0f);
            return away * out + (2.0f * u - 1.0f) * half_width * side + vec3(0, up + crease, 0);
        });
    }
    return shape;
}

Shape hangingBowlPart(float drop) {
    Profile profile{{0, 0}};
    addArc(profile, {0, 0.19f}, {0.22f, 0.19f}, -70, 15, 10);
    profile.push_back({0.20f, 0.28f});
    addArc(profile, {0.225f, 0.31f}, {0.02f, 0.02f}, -60, 150, 5);
    profile.push_back({0.17f, 0.27f});
    profile.push_back({0, 0.25f});
    for (vec2& point : profile)
        point.y -= drop;
    Shape shape;
    shape.addLathe(profile, 20);
    return shape;
}

Shape hangingChainsPart(float drop) {
    Shape shape;
    const float knot = -drop + 0.95f;
    const vec3 hook[] = {{0, 0.03f, 0}, {0, knot, 0}};
    shape.addTube(hook, 0.009f, 6);
    for (uint i = 0; i < 3; ++i) {
        const float angle = 2 * kPi * float(i) / 3.0f;
        const vec3 chain[] = {{0, knot, 0},
                              {0.225f * std::cos(angle), 0.31f - drop, 0.225f * std::sin(angle)}};
        shape.addTube(chain, 0.006f, 5);
    }
    return shape;
}

Shape knotPart(float size) {
    constexpr uint kRings = 260;
    const float tube = 0.155f * size, wave = 0.27f * size, radius = size - wave - tube;
    std::vector<vec3> path;
    for (uint i = 0; i < kRings; ++i) {
        const float t = 2 * kPi * float(i) / float(kRings);
        const float r = radius + wave * std::cos(3 * t);
        // Lobes where cos 3t = 1, at 2t = 0, 120 and 240 degrees: turned so that one is down.
        const float turn = 2 * t - 0.5f * kPi;
        path.push_back({wave * std::sin(3 * t), r * std::sin(turn), r * std::cos(turn)});
    }
    Shape shape;
    shape.addTube(path, tube, 22, true);
    return shape;
}

Shape basinPart(float radius, float height) {
    const float outer = radius, inner = radius - 0.36f, h = height;
    Profile profile{{outer + 0.02f, -0.05f}, {outer + 0.02f, 0.07f}};
    addArc(profile, {outer - 0.07f, 0.10f}, {0.05f, 0.03f}, -30, 90, 4);
    profile.push_back({outer - 0.09f, h - 0.16f});
    addArc(profile, {outer - 0.02f, h - 0.06f}, {0.06f, 0.06f}, -110, 90, 9);
    profile.push_back({inner + 0.06f, h});
    addArc(profile, {inner + 0.06f, h - 0.06f}, {0.06f, 0.06f}, 90, 180, 4);
    profile.push_back({inner, -0.05f});
    Shape shape;
    shape.addLathe(profile, 72);
    return shape;
}

Shape pedestalPart(float height) {
    Profile profile{{0, 0}, {0.50f, 0}, {0.50f, 0.34f}};
    addArc(profile, {0.44f, 0.40f}, {0.06f, 0.06f}, -90, 90, 5);
    addArc(profile, {0.44f, 0.60f}, {0.18f, 0.14f}, 270, 180, 5);
    profile.push_back({0.22f, height - 0.22f});
    addArc(profile, {0.22f, height - 0.10f}, {0.13f, 0.10f}, -90, 0, 5);
    profile.push_back({0.35f, height});
    profile.push_back({0, height});
    Shape shape;
    shape.addLathe(profile, 40);
    return shape;
}

} // namespace hone

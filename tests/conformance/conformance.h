// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/tests/conformance/conformance_kit.h"
#include "hone/tests/support/scene_builder.h"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace hone::test {

/// Adds a tracer to the suite; call it before testing::InitGoogleTest, for a program of one's own
/// with all of GoogleTest's options. runConformance() (conformance_kit.h) is the simpler way.
void addTracer(TracerUnderTest tracer);

/// What every tracer promises (trace_backend.h), asked in every way that there is: as a coherent
/// and as an incoherent list, plain and exact.
class TracerConformance : public testing::TestWithParam<TracerUnderTest> {
protected:
    struct Mode {
        Coherence coherence;
        TraceOptions options;
    };
    static constexpr Mode kModes[] = {{Coherence::kCoherent, {false}},
                                      {Coherence::kCoherent, {true}},
                                      {Coherence::kIncoherent, {false}},
                                      {Coherence::kIncoherent, {true}}};

    /// Makes the tracer.
    void SetUp() override;

    /// Keeps the scene and builds the tracer for it.
    void build(Scene scene);
    void build(const SceneBuilder& builder) { build(builder.finish()); }

    /// Places an instance elsewhere and lets the tracer follow.
    void move(uint instance, const mat4x3& place);

    [[nodiscard]] std::vector<Hit> closestOf(std::span<const Ray> rays, const Mode& mode) const;
    [[nodiscard]] std::vector<uint> occludedOf(std::span<const Ray> rays, const Mode& mode) const;

    /// The answer for a ray alone in its list; fails the test if the modes disagree.
    [[nodiscard]] Hit closest(const Ray& ray) const;
    [[nodiscard]] bool occluded(const Ray& ray) const;
    /// The answers in all modes, for rays that may have several right answers.
    [[nodiscard]] std::vector<Hit> closestInAllModes(const Ray& ray) const;

    /// Holds the answers for the scene as it is now against the brute loop's. Two tracers may round
    /// apart which of two hits is nearer that lie within 1e-5 of the distance; nothing else is
    /// forgiven. (In random_test.cpp.)
    void expectAgreementWithBrute(std::span<const Ray> rays) const;

    /// As many rays as `count`, or a sixteenth of them where the tracer is slow.
    [[nodiscard]] static std::size_t rayCount(std::size_t count) {
        return GetParam().is_slow ? count / 16 : count;
    }

    Scene scene_;
    std::unique_ptr<TraceBackend> tracer_;
};

inline constexpr Hit kMiss{kNone, kNone};

/// A ray from `origin` to `target`, which it reaches at t = 1; it ends at tmax.
[[nodiscard]] inline Ray rayTo(vec3 origin, vec3 target, float tmax = 1e30f) {
    return {origin, 0.0f, target - origin, tmax};
}

/// The square with corners (0,0,0) and (1,1,0), seen from positive z. Triangle 0 lies below the
/// diagonal from (0,0,0) to (1,1,0), triangle 1 above it. Texture coordinates are x and y.
struct UnitSquare {
    std::vector<vec3> positions{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    std::vector<uvec3> triangles{{0, 1, 2}, {0, 2, 3}};
    std::vector<vec2> uvs{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    uint addTo(SceneBuilder& builder, uint material) const {
        return builder.add(positions, triangles, material, uvs);
    }
    uint addMeshTo(SceneBuilder& builder, uint material) const {
        return builder.addMesh(positions, triangles, material, uvs);
    }
};

} // namespace hone::test

namespace hone {
inline bool operator==(const Hit& a, const Hit& b) {
    return a.instance == b.instance && a.primitive == b.primitive;
}
void PrintTo(const Hit& hit, std::ostream* out);
} // namespace hone

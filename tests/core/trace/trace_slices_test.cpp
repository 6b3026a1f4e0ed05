// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/embree/embree_backend.h"
#include "hone/core/trace/trace_slices.h"
#include "hone/tests/support/fake_tracers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hone {
namespace {

using test::FakeTracer;

const Interrupt kNever{};

/// Due from the start.
Interrupt due() {
    return {.deadline = Interrupt::Clock::now()};
}

TEST(TraceSlices, AnswersEveryRayInItsPlace) {
    const FakeTracer tracer;
    const std::vector<Ray> rays = FakeTracer::rays(1001);
    std::vector<Hit> hits(rays.size());
    std::vector<uint> occluded(rays.size());
    ClosestQuery closest{rays, hits};
    OccludedQuery occlusion{rays, occluded};
    TraceSlices slices;
    EXPECT_TRUE(slices.answer(tracer, closest, kNever));
    EXPECT_TRUE(slices.answer(tracer, occlusion, kNever));
    EXPECT_EQ(closest.answered, 1001u);
    for (uint i = 0; i < rays.size(); ++i) {
        EXPECT_EQ(hits[i].instance, i);
        EXPECT_EQ(occluded[i], i % 2);
    }
}

TEST(TraceSlices, AsksNothingForAnEmptyList) {
    const FakeTracer tracer;
    TraceSlices slices;
    ClosestQuery query;
    EXPECT_TRUE(slices.answer(tracer, query, due()));
    EXPECT_TRUE(tracer.lengths.empty());
}

TEST(TraceSlices, HandsAFastBackendItsListsWhole) {
    const FakeTracer tracer;
    const std::vector<Ray> rays = FakeTracer::rays(100'000);
    std::vector<Hit> hits(rays.size());
    TraceSlices slices;
    ClosestQuery query{rays, hits};
    slices.answer(tracer, query, kNever);
    // 256 * 8^k, and the rest.
    EXPECT_EQ(tracer.lengths, (std::vector<std::size_t>{256, 2048, 16384, 81312}));
    tracer.lengths.clear();
    query.answered = 0;
    slices.answer(tracer, query, kNever);
    EXPECT_EQ(tracer.lengths, std::vector<std::size_t>{100'000});
}

TEST(TraceSlices, BeginAtMultiplesOfTheGrainAndAreShortOnASlowBackend) {
    FakeTracer tracer;
    tracer.us_per_ray = 20; // 0.05 Mray/s
    const std::vector<Ray> rays = FakeTracer::rays(9999);
    std::vector<Hit> hits(rays.size());
    TraceSlices slices;
    ClosestQuery query{rays, hits};
    slices.answer(tracer, query, kNever);
    EXPECT_EQ(std::accumulate(tracer.lengths.begin(), tracer.lengths.end(), std::size_t{0}), 9999u);
    tracer.lengths.pop_back();
    for (const std::size_t length : tracer.lengths) {
        EXPECT_EQ(length % TraceSlices::kGrain, 0u);
        EXPECT_LE(length, 1250u); // 25 ms
    }
}

TEST(TraceSlices, StopAfterOneWhereTheInterruptIsDueAndGoOnThere) {
    const FakeTracer tracer;
    const std::vector<Ray> rays = FakeTracer::rays(1000);
    std::vector<Hit> hits(rays.size(), Hit{99, 99});
    TraceSlices slices;
    ClosestQuery query{rays, hits};
    EXPECT_FALSE(slices.answer(tracer, query, due()));
    EXPECT_EQ(query.answered, TraceSlices::kFirstSlice);
    EXPECT_EQ(hits[query.answered - 1].instance, query.answered - 1);
    EXPECT_EQ(hits[query.answered].instance, 99u);
    EXPECT_TRUE(slices.answer(tracer, query, due()));
    EXPECT_EQ(query.answered, 1000u);
    EXPECT_EQ(hits.back().instance, 999u);
}

TEST(TraceSlices, BeginShortForAnotherBackend) {
    const FakeTracer fast, other;
    const std::vector<Ray> rays = FakeTracer::rays(100'000);
    std::vector<uint> occluded(rays.size());
    TraceSlices slices;
    for (const FakeTracer* tracer : {&fast, &other}) {
        OccludedQuery query{rays, occluded};
        slices.answer(*tracer, query, kNever);
        EXPECT_EQ(tracer->lengths.front(), TraceSlices::kFirstSlice);
    }
}

/// Rays at the corners and edges of the scene's triangles, where the rays beside it in a packet
/// could decide what one of them hits.
TEST(TraceSlices, ChangeNoAnswerOfPackets) {
    const Scene scene = loadScene("builtin:cornell");
    const std::unique_ptr<TraceBackend> embree = makeEmbreeBackend();
    embree->build(scene);
    std::vector<Ray> rays;
    const vec3 eye = scene.cameras.front().position;
    for (uint k = 0; rays.size() < 10'000; ++k)
        for (const Instance& instance : scene.instances) {
            const Mesh& mesh = scene.meshes[instance.mesh];
            for (uint t = 0; t < mesh.triangle_count; ++t) {
                const uvec3 corners = scene.triangles[mesh.first_triangle + t];
                const float at = static_cast<float>(k % 17) / 16.0f;
                const vec3 target =
                    instance.to_world *
                    vec4(glm::mix(scene.positions[corners.x], scene.positions[corners.y], at),
                         1.0f);
                rays.push_back({eye, 0, target - eye, 2});
            }
        }
    std::vector<Hit> whole(rays.size()), sliced(rays.size());
    std::vector<uint> whole_occluded(rays.size()), sliced_occluded(rays.size());
    embree->closest(rays, whole, Coherence::kCoherent, {});
    embree->occluded(rays, whole_occluded, Coherence::kCoherent, {});
    TraceSlices slices;
    ClosestQuery closest{rays, sliced, Coherence::kCoherent};
    OccludedQuery occlusion{rays, sliced_occluded, Coherence::kCoherent};
    while (slices.step(*embree, closest))
        slices = {}; // short ones all the time
    slices = {};
    while (slices.step(*embree, occlusion))
        slices = {};
    EXPECT_TRUE(std::ranges::equal(whole, sliced, [](const Hit& a, const Hit& b) {
        return a.instance == b.instance && a.primitive == b.primitive;
    }));
    EXPECT_EQ(whole_occluded, sliced_occluded);
}

} // namespace
} // namespace hone

// SPDX-License-Identifier: Apache-2.0
//
// What is the Vulkan tracers' own; what every tracer promises is in tests/conformance.
#include "hone/backends/vulkan/vulkan_ray_tracer.h"

#include "hone/backends/host/host_device.h"
#include "hone/core/error.h"
#include "hone/tests/support/scene_builder.h"
#include "hone/tests/support/vulkan_fixture.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>

namespace hone::test {
namespace {

/// Ray queries and ray pipelines, each where the device offers it.
class VulkanRays : public VulkanTest, public testing::WithParamInterface<const char*> {
protected:
    void SetUp() override {
        VulkanTest::SetUp();
        if (IsSkipped())
            return;
        const RayTracing offered = rayTracing(device());
        if (!(isQuery() ? offered.query : offered.pipeline))
            GTEST_SKIP() << device().info().driver << " offers no " << GetParam();
    }
    [[nodiscard]] static bool isQuery() { return GetParam() == std::string("ray_query"); }
    [[nodiscard]] static std::unique_ptr<TraceBackend> make(const RayTracerParams& params = {}) {
        return isQuery() ? makeRayQueryTracer(device(), params)
                         : makeRayPipelineTracer(device(), params);
    }
};

INSTANTIATE_TEST_SUITE_P(All, VulkanRays, testing::Values("ray_query", "ray_pipeline"),
                         [](const auto& tested) { return std::string(tested.param); });

/// Flat trees apart, flat trees together, a tree for each mesh.
constexpr RayTracerParams kTrees[] = {
    {}, {.flatten_triangles = 100, .most_apart = 0}, {.flatten_triangles = 0, .most_apart = 0}};

constexpr Hit kMiss{kNone, kNone};

Ray downAt(float x, float y) {
    return {{x, y, 5}, 0, {0, 0, -1}, 1e30f};
}

Hit closestOf(const TraceBackend& tracer, const Ray& ray) {
    Hit hit{12345, 67890};
    tracer.closest({&ray, 1}, {&hit, 1}, Coherence::kCoherent, {});
    return hit;
}

void expectHit(const TraceBackend& tracer, const Ray& ray, Hit expected) {
    const Hit hit = closestOf(tracer, ray);
    EXPECT_EQ(hit.instance, expected.instance) << ray.origin.x << ", " << ray.origin.y;
    EXPECT_EQ(hit.primitive, expected.primitive) << ray.origin.x << ", " << ray.origin.y;
}

/// `copies` instances of the triangle (0,0,0), (1,0,0), (0,1,0), two units apart along x.
Scene triangles(int copies, uint flags = 0) {
    SceneBuilder builder;
    const uint mesh =
        builder.addMesh(std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                        std::vector<uvec3>{{0, 1, 2}}, builder.addMaterial(plainMaterial(flags)));
    for (int i = 0; i < copies; ++i)
        builder.addInstance(mesh, glm::translate(mat4(1), vec3(2 * i, 0, 0)));
    return builder.finish();
}

void move(Scene& scene, uint instance, vec3 to, vec3 scale = vec3(1)) {
    moveInstance(scene, instance, mat4x3(glm::scale(glm::translate(mat4(1), to), scale)));
}

TEST_P(VulkanRays, SayWhatTheyAre) {
    const TraceCaps caps = make()->caps();
    EXPECT_EQ(caps.name, std::string("vulkan.") + GetParam());
    EXPECT_EQ(caps.version, device().info().driver);
    EXPECT_EQ(caps.runs_on, device().info().name);
    EXPECT_EQ(caps.memory, TraceMemory::kDevice);
    EXPECT_TRUE(caps.always_exact);
    EXPECT_TRUE(caps.updates);
    EXPECT_FALSE(caps.settles_ties);
}

TEST_P(VulkanRays, CopyNothingWhereListsLieInTheDevicesBuffers) {
    const auto tracer = make();
    const Scene scene = triangles(3);
    tracer->build(scene);
    const auto& inside = dynamic_cast<const VulkanRayTracer&>(*tracer);
    // Past the chunk of a software device (65,536 rays), and at odd places in the buffers.
    constexpr std::size_t kCount = 70'001;
    const Buffer rays = device().createBuffer((kCount + 3) * sizeof(Ray), "rays");
    const Buffer hits = device().createBuffer((kCount + 5) * sizeof(Hit), "hits");
    const Buffer occluded = device().createBuffer((kCount + 7) * sizeof(uint), "occluded");
    const auto asked = rays.as<Ray>().subspan(3, kCount);
    for (std::size_t i = 0; i < kCount; ++i)
        asked[i] = downAt(static_cast<float>(i % 4 * 2) + 0.25f, 0.25f); // the fourth misses
    std::ranges::fill(hits.as<uint>(), 77u);
    std::ranges::fill(occluded.as<uint>(), 77u);
    tracer->closest(asked, hits.as<Hit>().subspan(3, kCount), Coherence::kCoherent, {});
    tracer->occluded(asked, occluded.as<uint>().subspan(5, kCount), Coherence::kCoherent, {});
    EXPECT_EQ(inside.copiedBytes(), 0u);
    std::size_t wrong = 0;
    for (uint i = 0; i < kCount; ++i) {
        const Hit expected = i % 4 == 3 ? kMiss : Hit{i % 4, 0};
        const Hit hit = hits.as<Hit>()[i + 3];
        wrong += hit.instance != expected.instance || hit.primitive != expected.primitive ||
                 occluded.as<uint>()[i + 5] != (i % 4 == 3 ? 0u : 1u);
    }
    EXPECT_EQ(wrong, 0u);
    // What lies around the answers stays as it was.
    for (const uint i : {0u, 5u})
        EXPECT_EQ(hits.as<uint>()[i], 77u);
    EXPECT_EQ(hits.as<uint>()[2 * (kCount + 3)], 77u);
    EXPECT_EQ(occluded.as<uint>()[4], 77u);
    EXPECT_EQ(occluded.as<uint>()[kCount + 5], 77u);
}

TEST_P(VulkanRays, CopyListsThatLieElsewhere) {
    const auto tracer = make();
    const Scene scene = triangles(1);
    tracer->build(scene);
    const std::vector<Ray> rays(10, downAt(0.25f, 0.25f));
    std::vector<Hit> hits(10);
    tracer->closest(rays, hits, Coherence::kCoherent, {});
    EXPECT_EQ(hits[9].instance, 0u);
    EXPECT_EQ(dynamic_cast<const VulkanRayTracer&>(*tracer).copiedBytes(),
              10 * (sizeof(Ray) + sizeof(Hit)));
}

TEST_P(VulkanRays, ReadTheMasksOfSharedBuffers) {
    SceneBuilder builder;
    Material hole = plainMaterial(kMaterialMasked);
    hole.alpha = 0.1f;
    builder.add(std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, std::vector<uvec3>{{0, 1, 2}},
                builder.addMaterial(hole));
    const Scene scene = builder.finish();
    const SceneBuffers shared(device(), scene);
    const auto tracer = make();
    EXPECT_EQ(tracer->build(scene, &shared).copied_bytes, 0u);
    expectHit(*tracer, downAt(0.25f, 0.25f), kMiss);
    tracer->build(scene); // brings them over itself
    expectHit(*tracer, downAt(0.25f, 0.25f), kMiss);
}

TEST_P(VulkanRays, InstanceMeshesPastTheBudget) {
    const Scene scene = triangles(5); // the copies add 4 triangles
    EXPECT_EQ(make()->build(scene).triangles, 5u);
    EXPECT_EQ(make({.flatten_triangles = 4})->build(scene).triangles, 5u);
    EXPECT_EQ(make({.flatten_triangles = 3})->build(scene).triangles, 1u);
}

TEST_P(VulkanRays, FollowInstancesThatMove) {
    for (const RayTracerParams& params : kTrees) {
        Scene scene = triangles(3);
        const auto tracer = make(params);
        tracer->build(scene);
        for (const float y : {10.0f, 20.0f}) { // the first move builds, the second refits
            move(scene, 1, {2, y, 0});
            tracer->update(std::vector<uint>{1});
            expectHit(*tracer, downAt(2.25f, y + 0.25f), {1, 0});
            expectHit(*tracer, downAt(2.25f, y - 9.75f), kMiss);
            expectHit(*tracer, downAt(0.25f, 0.25f), {0, 0});
            expectHit(*tracer, downAt(4.25f, 0.25f), {2, 0});
        }
    }
}

TEST_P(VulkanRays, FollowInstancesThatAMoveMirrors) {
    for (const RayTracerParams& params : kTrees) {
        Scene scene = triangles(2);
        const auto tracer = make(params);
        tracer->build(scene);
        const Ray up{{0.25f, 0.25f, -5}, 0, {0, 0, 1}, 1e30f};
        for (int round = 0; round < 3; ++round) {
            move(scene, 0, {}, {1, 1, -1}); // its front looks down
            tracer->update(std::vector<uint>{0});
            expectHit(*tracer, downAt(0.25f, 0.25f), kMiss);
            expectHit(*tracer, up, {0, 0});
            move(scene, 0, {});
            tracer->update(std::vector<uint>{0});
            expectHit(*tracer, downAt(0.25f, 0.25f), {0, 0});
            expectHit(*tracer, up, kMiss);
        }
    }
}

TEST_P(VulkanRays, FollowInstancesThatAMoveFlattens) {
    for (const RayTracerParams& params : kTrees) {
        Scene scene = triangles(2);
        const auto tracer = make(params);
        tracer->build(scene);
        for (int round = 0; round < 2; ++round) {
            move(scene, 0, {}, {1, 1, 0}); // into its own plane: still there
            tracer->update(std::vector<uint>{0});
            EXPECT_EQ(closestOf(*tracer, downAt(0.25f, 0.25f)).instance, 0u);
            move(scene, 0, {}, {1, 0, 1}); // into a line: gone
            tracer->update(std::vector<uint>{0});
            expectHit(*tracer, downAt(0.25f, 0.25f), kMiss);
            expectHit(*tracer, downAt(2.25f, 0.25f), {1, 0});
            move(scene, 0, {});
            tracer->update(std::vector<uint>{0});
            expectHit(*tracer, downAt(0.25f, 0.25f), {0, 0});
        }
    }
}

TEST_P(VulkanRays, FollowAMoveFromAndToNothing) {
    Scene scene = triangles(1);
    const auto tracer = make();
    move(scene, 0, {}, {0, 0, 0});
    EXPECT_EQ(tracer->build(scene).triangles, 0u);
    move(scene, 0, {});
    tracer->update(std::vector<uint>{0});
    expectHit(*tracer, downAt(0.25f, 0.25f), {0, 0});
    move(scene, 0, {}, {0, 0, 0});
    EXPECT_EQ(tracer->update(std::vector<uint>{0}).triangles, 0u);
    expectHit(*tracer, downAt(0.25f, 0.25f), kMiss);
}

TEST_P(VulkanRays, RefuseQueriesBeforeBuild) {
    const auto tracer = make();
    EXPECT_THROW(closestOf(*tracer, downAt(0, 0)), std::logic_error);
    EXPECT_THROW(tracer->update({}), std::logic_error);
}

template <class Make> std::string refusal(const Make& make) {
    try {
        (void)make();
    } catch (const DeviceError& error) {
        return error.what();
    }
    return "no DeviceError";
}

TEST(VulkanRayTracers, RefuseOtherDevices) {
    const auto host = makeHostDevice();
    EXPECT_FALSE(rayTracing(*host).query);
    EXPECT_FALSE(rayTracing(*host).pipeline);
    const std::string query = refusal([&] { return makeRayQueryTracer(*host); });
    EXPECT_EQ(query, "vulkan.ray_query: " + host->info().name +
                         " is no Vulkan device; trace with vulkan, which takes what there is, or "
                         "with embree");
    EXPECT_TRUE(
        refusal([&] { return makeRayPipelineTracer(*host); }).starts_with("vulkan.ray_pipeline: "));
}

using VulkanWithoutRays = VulkanTest;

TEST_F(VulkanWithoutRays, TracersSayWhatTheDeviceLacks) {
    VulkanOptions plain = options();
    plain.ray_tracing = false;
    const auto device = makeVulkanDevice(plain);
    EXPECT_FALSE(rayTracing(*device).query);
    EXPECT_FALSE(rayTracing(*device).pipeline);
    EXPECT_NE(refusal([&] {
                  return makeRayQueryTracer(*device);
              }).find("was opened without VK_KHR_ray_query"),
              std::string::npos);
    EXPECT_NE(refusal([&] {
                  return makeRayPipelineTracer(*device);
              }).find("was opened without VK_KHR_ray_tracing_pipeline"),
              std::string::npos);
}

} // namespace
} // namespace hone::test

// SPDX-License-Identifier: Apache-2.0
//
// What is the BVH tracer's own; what every tracer promises is in tests/conformance.
#include "hone/backends/bvh/bvh_backend.h"

#include "hone/backends/bvh/binned_builder.h"
#include "hone/backends/embree/embree_bvh.h"
#include "hone/backends/host/host_device.h"
#include "hone/core/device/recording_device.h"
#include "hone/core/error.h"
#include "hone/core/scene/scene_buffers.h"
#include "hone/tests/support/scene_builder.h"
#include "hone/tests/support/vulkan_fixture.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>

namespace hone::test {
namespace {

/// A device that does what another does, and counts the buffers that it makes for copies of
/// queries. Its kernels can read `max_binding_bytes` of a buffer.
class CountingDevice final : public Device {
public:
    explicit CountingDevice(Device& inner, std::size_t max_binding_bytes = SIZE_MAX)
        : inner_(&inner), info_(inner.info()) {
        info_.max_binding_bytes = std::min(info_.max_binding_bytes, max_binding_bytes);
    }
    const DeviceInfo& info() const override { return info_; }
    Buffer createBuffer(std::size_t bytes, std::string_view name) override {
        copies += name == "copy of a query" ? 1 : 0;
        return inner_->createBuffer(bytes, name);
    }
    BufferView viewOf(std::span<const std::byte> bytes) const override {
        return inner_->viewOf(bytes);
    }
    ImageHandle createImage(const ImageDesc& desc) override { return inner_->createImage(desc); }
    PipelineHandle createRasterPipeline(const RasterPipelineDesc& desc) override {
        return inner_->createRasterPipeline(desc);
    }
    void destroy(ImageHandle image) override { inner_->destroy(image); }
    void destroy(PipelineHandle pipeline) override { inner_->destroy(pipeline); }
    CommandEncoder& encoder() override { return inner_->encoder(); }
    std::vector<ScopeTiming> takeTimings() override { return inner_->takeTimings(); }

    int copies = 0;

private:
    void destroyBuffer(std::uint64_t) override {} // buffers are the inner device's

    Device* inner_;
    DeviceInfo info_;
};

/// Triangles of all kinds of materials, placed any way; every mesh has several instances.
Scene mixedScene() {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> unit(-1, 1);
    const auto vector = [&] {
        const float x = unit(random);
        const float y = unit(random);
        return vec3(x, y, unit(random));
    };
    SceneBuilder builder;
    const uint texels[] = {0xff'00'00'00u, 0x00'00'00'00u, 0x40'00'00'00u, 0xc0'00'00'00u};
    const uint texture = builder.addTexture(2, 2, texels, 0);
    for (const uint flags : {0u, kMaterialTwoSided, kMaterialMasked | kMaterialTwoSided}) {
        Material material = plainMaterial(flags);
        material.base_color_texture = texture;
        std::vector<vec3> positions;
        std::vector<vec2> uvs;
        std::vector<uvec3> triangles;
        for (uint i = 0; i < 150; ++i) {
            const vec3 center = vector();
            for (int corner = 0; corner < 3; ++corner) {
                positions.push_back(center + 0.3f * vector());
                uvs.emplace_back(3.0f * vector());
            }
            triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
        }
        const uint mesh = builder.addMesh(positions, triangles, builder.addMaterial(material), uvs);
        for (int i = 0; i < 3; ++i) {
            mat4 place(1);
            for (int column = 0; column < 3; ++column)
                place[column] += vec4(0.5f * vector(), 0);
            place[0] *= i == 1 ? -1.0f : 1.0f;
            place[3] = vec4(vector(), 1);
            builder.addInstance(mesh, place);
        }
    }
    return builder.finish();
}

std::vector<Ray> randomRays(std::size_t count) {
    std::mt19937 random(8);
    std::uniform_real_distribution<float> unit(-1, 1);
    std::vector<Ray> rays(count);
    for (Ray& ray : rays) {
        for (int axis = 0; axis < 3; ++axis) {
            ray.origin[axis] = 3 * unit(random);
            ray.direction[axis] = unit(random) - ray.origin[axis];
        }
        ray.tmin = 0;
        ray.tmax = unit(random) > 0 ? 1e30f : 1.0f;
    }
    rays[3].direction = vec3(0); // and one that sees nothing
    return rays;
}

struct Answers {
    std::vector<uint> hits; ///< two words a hit
    std::vector<uint> occluded;
    bool operator==(const Answers&) const = default;
};

Answers ask(const TraceBackend& tracer, std::span<const Ray> rays) {
    std::vector<Hit> hits(rays.size());
    Answers answers{.hits = std::vector<uint>(2 * rays.size()),
                    .occluded = std::vector<uint>(rays.size())};
    tracer.closest(rays, hits, Coherence::kCoherent, {});
    tracer.occluded(rays, answers.occluded, Coherence::kCoherent, {});
    std::memcpy(answers.hits.data(), hits.data(), hits.size() * sizeof(Hit));
    return answers;
}

std::size_t hitCount(const Answers& answers) {
    return answers.occluded.size() -
           static_cast<std::size_t>(std::ranges::count(answers.occluded, 0u));
}

constexpr std::size_t kFlat = 1'000'000;
constexpr std::size_t kInstanced = 0;

TEST(BvhBackend, AnswersAlikeOverManyDispatches) {
    const Scene scene = mixedScene();
    const std::vector<Ray> rays = randomRays(300);
    for (const std::size_t flatten : {kFlat, kInstanced}) {
        RecordingDevice device;
        const auto whole = makeBvhTracer(device, buildBinnedBvh, {.flatten_triangles = flatten});
        const auto parts =
            makeBvhTracer(device, buildBinnedBvh, {.flatten_triangles = flatten, .step_limit = 5});
        whole->build(scene);
        parts->build(scene);
        const Answers expected = ask(*whole, rays);
        EXPECT_GT(hitCount(expected), 100u);
        EXPECT_EQ(std::ranges::count(device.takeLines(), std::string("finish")), 2);
        EXPECT_EQ(ask(*parts, rays), expected);
        EXPECT_GT(std::ranges::count(device.takeLines(), std::string("dispatch bvh_closest 300")),
                  5);
    }
}

TEST(BvhBackend, FollowsMovedInstancesAsIfBuiltAnew) {
    const std::vector<Ray> rays = randomRays(3000);
    const auto device = makeHostDevice();
    for (const BvhBuilder& builder : {BvhBuilder(buildBinnedBvh), BvhBuilder(buildEmbreeBvh)})
        for (const std::size_t flatten : {kFlat, kInstanced}) {
            Scene scene = mixedScene();
            const auto moved = makeBvhTracer(*device, builder, {.flatten_triangles = flatten});
            moved->build(scene);
            const Answers before = ask(*moved, rays);
            for (int round = 0; round < 3; ++round) {
                const std::array<uint, 2> instances{1, 7};
                for (const uint instance : instances) {
                    // Turned over as well, so that fronts change; flat the last time.
                    mat4 place = glm::translate(mat4(1), vec3(0.3f * static_cast<float>(round)));
                    place = glm::rotate(place, 1.0f + static_cast<float>(round), vec3(0, 1, 0.5f));
                    place = glm::scale(place, vec3(-1, 1, round == 1 ? 0.7f : 1.2f));
                    moveInstance(scene, instance, mat4x3(place));
                }
                moved->update(instances);
                const auto anew = makeBvhTracer(*device, builder, {.flatten_triangles = flatten});
                anew->build(scene);
                const Answers after = ask(*moved, rays);
                EXPECT_EQ(after, ask(*anew, rays));
                EXPECT_NE(after, before);
            }
        }
}

TEST(BvhBackend, FollowsAnInstanceThatHadNoArea) {
    SceneBuilder builder;
    const uint mesh =
        builder.addMesh(std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                        std::vector<uvec3>{{0, 1, 2}}, builder.addMaterial(plainMaterial()));
    builder.addInstance(mesh, glm::scale(mat4(1), vec3(0)));
    Scene scene = builder.finish();
    const auto device = makeHostDevice();
    const auto tracer = makeBvhTracer(*device, buildBinnedBvh);
    tracer->build(scene);
    const Ray ray{{0.25f, 0.25f, 5}, 0, {0, 0, -1}, 1e30f};
    EXPECT_EQ(hitCount(ask(*tracer, {&ray, 1})), 0u);
    moveInstance(scene, 0, mat4x3(1));
    tracer->update(std::array{0u});
    EXPECT_EQ(hitCount(ask(*tracer, {&ray, 1})), 1u);
}

TEST(BvhBackend, TakesMemoryForUniqueTrianglesOnly) {
    SceneBuilder builder;
    std::vector<vec3> positions;
    std::vector<uvec3> triangles;
    for (uint i = 0; i < 500; ++i) {
        const vec3 at(static_cast<float>(i), 0, 0);
        positions.insert(positions.end(), {at, at + vec3(1, 0, 0), at + vec3(0, 1, 0)});
        triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    const uint mesh = builder.addMesh(positions, triangles, builder.addMaterial(plainMaterial()));
    for (int i = 0; i < 20; ++i)
        builder.addInstance(mesh, glm::translate(mat4(1), vec3(0, 2 * i, 0)));
    const Scene scene = builder.finish();
    const auto device = makeHostDevice();
    const BuildStats flat = makeBvhTracer(*device, buildBinnedBvh)->build(scene);
    const BuildStats placed =
        makeBvhTracer(*device, buildBinnedBvh, {.flatten_triangles = kInstanced})->build(scene);
    EXPECT_EQ(flat.triangles, 10'000u);
    EXPECT_EQ(placed.triangles, 500u);
    EXPECT_LT(placed.bytes, flat.bytes / 10);
}

TEST(BvhBackend, RefusesASceneThatTheDeviceCannotRead) {
    const auto host = makeHostDevice();
    CountingDevice device(*host, 1000); // fewer than mixedScene's 1350 triangles take
    const auto tracer = makeBvhTracer(device, buildBinnedBvh);
    try {
        tracer->build(mixedScene());
        FAIL() << "it was taken";
    } catch (const DeviceError& error) {
        EXPECT_NE(std::string(error.what()).find("reads at most 1000 from one buffer"),
                  std::string::npos)
            << error.what();
    }
}

TEST(BvhBackend, RefusesQueriesBeforeBuildAndListsOfUnequalSize) {
    const auto device = makeHostDevice();
    const auto tracer = makeBvhTracer(*device, buildBinnedBvh);
    const Ray ray{{0, 0, 1}, 0, {0, 0, -1}, 1};
    Hit hit;
    EXPECT_THROW(tracer->closest({&ray, 1}, {&hit, 1}, Coherence::kCoherent, {}), std::logic_error);
    const Scene scene = mixedScene();
    tracer->build(scene);
    EXPECT_THROW(tracer->closest({&ray, 1}, {}, Coherence::kCoherent, {}), std::logic_error);
    EXPECT_THROW(tracer->occluded({&ray, 1}, {}, Coherence::kCoherent, {}), std::logic_error);
}

/// The same on Vulkan, with validation.
class BvhOnVulkan : public VulkanTest {};

TEST_F(BvhOnVulkan, AnswersAsOnTheHost) {
    const Scene scene = mixedScene();
    const std::vector<Ray> rays = randomRays(200);
    const auto host = makeHostDevice();
    for (const std::size_t flatten : {kFlat, kInstanced}) {
        const auto expected = makeBvhTracer(*host, buildBinnedBvh, {.flatten_triangles = flatten});
        const auto whole = makeBvhTracer(device(), buildBinnedBvh, {.flatten_triangles = flatten});
        const auto parts = makeBvhTracer(device(), buildBinnedBvh,
                                         {.flatten_triangles = flatten, .step_limit = 100});
        for (TraceBackend* tracer : {expected.get(), whole.get(), parts.get()})
            tracer->build(scene);
        EXPECT_EQ(ask(*whole, rays), ask(*expected, rays));
        EXPECT_EQ(ask(*parts, rays), ask(*expected, rays));
    }
}

// More than one dispatch tests, and more turns of a loop than some drivers bear (BvhParams).
TEST_F(BvhOnVulkan, FollowsARayThroughAHundredThousandBoxes) {
    // The ray runs through every box beside its triangle, and meets the last one.
    constexpr uint kCount = 100'000;
    std::vector<vec3> positions;
    std::vector<uvec3> triangles;
    for (uint i = 0; i < kCount; ++i) {
        const float z = -static_cast<float>(i);
        const float side = i + 1 < kCount ? 1.0f : -1.0f;
        positions.insert(positions.end(), {{-1, -1, z}, {side, -side, z}, {1, 1, z}});
        triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    SceneBuilder builder;
    builder.add(positions, triangles, builder.addMaterial(plainMaterial(kMaterialTwoSided)));
    const Scene scene = builder.finish();
    const auto tracer = makeBvhTracer(device(), buildBinnedBvh);
    tracer->build(scene);
    const Ray ray{{-0.5f, 0.5f, 5}, 0, {0, 0, -1}, 1e30f};
    const Answers answers = ask(*tracer, {&ray, 1});
    EXPECT_EQ(answers.hits, (std::vector<uint>{0, kCount - 1}));
    EXPECT_EQ(answers.occluded, std::vector<uint>{1});
}

TEST_F(BvhOnVulkan, ReadsAndWritesTheListsWhereTheyAre) {
    const Scene scene = mixedScene();
    CountingDevice counted(device());
    const auto tracer = makeBvhTracer(counted, buildBinnedBvh);
    const SceneBuffers shared(device(), scene);
    EXPECT_EQ(tracer->build(scene, &shared).copied_bytes, 0u);
    const std::vector<Ray> rays = randomRays(100);
    const Buffer ray_buffer = device().createBuffer(rays.size() * sizeof(Ray), "rays");
    const Buffer hit_buffer = device().createBuffer(rays.size() * sizeof(Hit), "hits");
    std::ranges::copy(rays, ray_buffer.as<Ray>().begin());

    // Parts of lists, too, wherever they begin.
    for (const std::size_t first : {std::size_t{0}, std::size_t{1}, std::size_t{37}})
        tracer->closest(ray_buffer.as<Ray>().subspan(first), hit_buffer.as<Hit>().subspan(first),
                        Coherence::kCoherent, {});
    EXPECT_EQ(counted.copies, 0);
    std::vector<Hit> elsewhere(rays.size());
    tracer->closest(rays, elsewhere, Coherence::kCoherent, {});
    EXPECT_EQ(counted.copies, 2);
    EXPECT_EQ(std::memcmp(elsewhere.data(), hit_buffer.view().data, hit_buffer.bytes()), 0);
}

} // namespace
} // namespace hone::test

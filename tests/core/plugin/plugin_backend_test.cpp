// SPDX-License-Identifier: Apache-2.0
#include "hone/core/plugin/plugin_backend.h"

#include "hone/backends/host/parallel_for.h"
#include "hone/core/error.h"
#include "hone/core/plugin/plugin.h"
#include "hone/tests/support/bad_plugins.h"
#include "hone/tests/support/scene_builder.h"

#include <gtest/gtest.h>

#include <functional>

namespace hone::test {
namespace {

std::unique_ptr<TraceBackend> make(const std::string& plugin, const std::string& backend) {
    PassRegistry passes;
    TraceBackendRegistry registry;
    Plugin(pluginFile(plugin), hostParallelFor).addTo(passes, registry);
    return registry.create(backend, {}); // the plug-in stays although the others go
}

/// Two triangles, the second placed at x = 10; the right half of their texture is a hole.
Scene twoMaskedTriangles() {
    SceneBuilder builder;
    const uint texels[] = {0xff'ff'ff'ffu, 0x00'ff'ff'ffu};
    Material material = plainMaterial(kMaterialMasked);
    material.base_color_texture = builder.addTexture(2, 1, texels);
    const uint masked = builder.addMaterial(material);
    const std::vector<vec3> positions{{1, 2, 3}, {2, 2, 3}, {1, 3, 3}};
    const std::vector<uvec3> triangles{{0, 1, 2}};
    builder.addInstance(
        builder.addMesh(positions, triangles, masked, std::vector<vec2>{{0, 0}, {1, 0}, {0, 1}}));
    mat4 place(1);
    place[3] = vec4(10, 0, 0, 1);
    builder.addInstance(
        builder.addMesh(positions, triangles, masked, std::vector<vec2>{{0, 0}, {1, 0}, {0, 1}}),
        place);
    builder.addInstance(
        builder.addMesh(positions, triangles, masked, std::vector<vec2>{{1, 0}, {0, 0}, {1, 1}}),
        glm::mat4(vec4(1, 0, 0, 0), vec4(0, 1, 0, 0), vec4(0, 0, 1, 0), vec4(20, 0, 0, 1)));
    return builder.finish();
}

Ray from(vec3 origin) {
    return {origin, 0, {0, 0, -1}, 1e30f};
}

TEST(PluginBackend, SaysWhatTheTableSays) {
    const TraceCaps caps = make("plain_c", "plain_c")->caps();
    EXPECT_EQ(caps.name, "plain_c");
    EXPECT_EQ(caps.version, "2.1");
    EXPECT_EQ(caps.runs_on, "host");
    EXPECT_EQ(caps.memory, TraceMemory::kHost);
    EXPECT_TRUE(caps.masked);
    EXPECT_TRUE(caps.always_exact);
    EXPECT_TRUE(caps.is_reference);
    EXPECT_FALSE(caps.settles_ties);
    EXPECT_FALSE(caps.updates);
}

TEST(PluginBackend, CountsWhatTheBuildMade) {
    const Scene scene = twoMaskedTriangles();
    const BuildStats stats = make("plain_c", "plain_c")->build(scene);
    EXPECT_EQ(stats.triangles, 3u);
    EXPECT_GT(stats.bytes, 0u);
    EXPECT_EQ(stats.copied_bytes, 0u);
    EXPECT_GE(stats.ms, 0);
}

// The plug-in answers with what the host tells it: places in the world and holes.
TEST(PluginBackend, GivesThePluginTheSceneAndTheHostsServices) {
    Scene scene = twoMaskedTriangles();
    const auto tracer = make("plain_c", "plain_c");
    tracer->build(scene);
    std::vector<Ray> rays(100, from({1, 2, 3}));
    rays[40] = from({11, 2, 3});
    rays[41] = from({21, 2, 3}); // starts in a hole
    rays[42] = from({5, 5, 5});
    std::vector<Hit> hits(rays.size());
    std::vector<uint> occluded(rays.size());
    tracer->closest(rays, hits, Coherence::kIncoherent, {});
    tracer->occluded(rays, occluded, Coherence::kCoherent, {.exact = true});
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const uint instance = i == 40 ? 1 : i == 41 || i == 42 ? kNone : 0;
        EXPECT_EQ(hits[i].instance, instance) << i;
        EXPECT_EQ(hits[i].primitive, instance == kNone ? kNone : 0) << i;
        EXPECT_EQ(occluded[i], instance == kNone ? 0u : 1u) << i;
    }
}

TEST(PluginBackend, BuildsAgainWhereThePluginCannotUpdate) {
    Scene scene = twoMaskedTriangles();
    finishScene(scene);
    const auto tracer = make("plain_c", "plain_c");
    tracer->build(scene);
    moveInstance(scene, 1, mat4x3(1, 0, 0, 0, 1, 0, 0, 0, 1, 7, 0, 0));
    const uint moved[] = {1};
    EXPECT_EQ(tracer->update(moved).triangles, 3u);
    const Ray ray = from({8, 2, 3});
    Hit hit{};
    tracer->closest({&ray, 1}, {&hit, 1}, Coherence::kIncoherent, {});
    EXPECT_EQ(hit.instance, 1u);
}

TEST(PluginBackend, AsksNothingForAnEmptyList) {
    const Scene scene = twoMaskedTriangles();
    const auto tracer = make("failing", "closest_fails");
    tracer->build(scene);
    EXPECT_NO_THROW(tracer->closest({}, {}, Coherence::kIncoherent, {}));
}

/// A backend of the failing plug-in, built and asked one ray in every way.
void use(const std::string& backend) {
    const Scene scene = twoMaskedTriangles();
    const auto tracer = make("failing", backend);
    tracer->build(scene);
    const uint moved[] = {0};
    tracer->update(moved);
    const Ray ray = from({1, 2, 3});
    Hit hit{};
    uint occluded = 0;
    tracer->closest({&ray, 1}, {&hit, 1}, Coherence::kIncoherent, {});
    tracer->occluded({&ray, 1}, {&occluded, 1}, Coherence::kIncoherent, {});
}

struct Failure {
    const char* backend;
    const char* reason;
};

class PluginFailures : public testing::TestWithParam<Failure> {};

TEST_P(PluginFailures, AreReportedWithTheirReason) {
    const std::string who = std::string("trace backend \"") + GetParam().backend + "\": ";
    try {
        use(GetParam().backend);
        FAIL() << "nothing was thrown";
    } catch (const PluginError& problem) {
        const std::string text = problem.what();
        EXPECT_EQ(text.find("plug-in /"), 0) << text;
        EXPECT_NE(text.find(who + GetParam().reason), std::string::npos) << text;
    }
}

INSTANTIATE_TEST_SUITE_P(
    All, PluginFailures,
    testing::Values(
        Failure{"create_fails", "create failed: no licence server?[31m"},
        Failure{"create_gives_no_reason", "create failed: it gave no reason"},
        Failure{"create_makes_nothing", "create said that all is well, but made nothing"},
        Failure{"create_throws", "create threw an exception: lost my keys"},
        Failure{"build_fails", "build failed: too many triangles"},
        Failure{"build_throws", "build threw an exception: std::bad_alloc"},
        Failure{"update_fails", "update failed: cannot move"},
        Failure{"closest_fails", "closest failed: bored"},
        Failure{"closest_throws", "closest threw something that is no std::exception"},
        Failure{"closest_ends_oddly", "closest failed: it gave no reason"},
        Failure{"closest_writes_no_end", "closest failed: xxxxxxxx"},
        Failure{"closest_names_no_instance",
                "closest answered ray 0 with instance 1000000, primitive 0, which the scene"},
        Failure{"closest_names_no_primitive",
                "closest answered ray 0 with instance 0, primitive 1000000, which the scene"},
        Failure{"closest_names_half",
                "closest answered ray 0 with instance 4294967295, primitive 0"},
        Failure{"occluded_fails", "occluded failed: too dark"},
        Failure{"occluded_throws", "occluded threw an exception: dusk"},
        Failure{"occluded_says_two", "occluded answered ray 0 with 2, not 1 or 0"}),
    [](const auto& tested) { return std::string(tested.param.backend); });

TEST(PluginBackend, PassesOnThatItsDeviceIsMissing) {
    EXPECT_THROW(use("create_has_no_device"), DeviceError);
}

TEST(PluginBackend, PassesOnThatMemoryIsShort) {
    EXPECT_THROW(use("create_has_no_memory"), OutOfMemory);
}

TEST(PluginBackend, OutlivesADestroyThatThrows) {
    EXPECT_NO_THROW(use("destroy_throws"));
}

TEST(PluginBackend, IsUsableAgainAfterAFailure) {
    const Scene scene = twoMaskedTriangles();
    const auto tracer = make("failing", "update_fails");
    tracer->build(scene);
    const uint moved[] = {0};
    EXPECT_THROW(tracer->update(moved), PluginError);
    const Ray ray = from({1, 2, 3});
    Hit hit{};
    EXPECT_THROW(tracer->closest({&ray, 1}, {&hit, 1}, Coherence::kIncoherent, {}),
                 std::logic_error)
        << "nobody knows what a failed update left behind";
    tracer->build(scene);
    EXPECT_NO_THROW(tracer->closest({&ray, 1}, {&hit, 1}, Coherence::kIncoherent, {}));
}

} // namespace
} // namespace hone::test

// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/brute/brute_backend.h"
#include "hone/core/trace/sample.glsl.h"
#include "hone/passes/passes.h"
#include "hone/tests/support/run_pass.h"
#include "hone/tests/support/scene_builder.h"
#include "hone/tests/support/vulkan_fixture.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <array>
#include <cmath>

namespace hone {

static bool operator==(const Sample& a, const Sample& b) {
    return a.pixel == b.pixel && a.radiance == b.radiance;
}

namespace {

constexpr float kPi = 3.14159265f;

/// At `position`, looking along `forward` with 90 degrees.
Camera cameraAt(vec3 position, vec3 forward, vec3 up) {
    return {.position = position,
            .forward = forward,
            .right = glm::cross(forward, up),
            .up = up,
            .tan_half_fov_y = 1.0f,
            .near = 0.01f,
            .lens_radius = 0,
            .focus = 1};
}

/// A square of side 2 * half around `center`, facing along the unit axis u x v.
void addSquare(test::SceneBuilder& builder, vec3 center, vec3 u, vec3 v, uint material) {
    const std::array<vec3, 4> corners{center - u - v, center + u - v, center + u + v,
                                      center - u + v};
    const std::array<uvec3, 2> triangles{uvec3(0, 1, 2), uvec3(0, 2, 3)};
    builder.add(corners, triangles, material);
}

/// A white floor at y = 0, 200 m wide, seen from 1 m above its origin. x of the image is +x.
Scene floorScene(vec3 ambient = vec3(0), const Material& material = test::plainMaterial()) {
    test::SceneBuilder builder;
    addSquare(builder, vec3(0), vec3(100, 0, 0), vec3(0, 0, -100), builder.addMaterial(material));
    Scene scene = builder.finish();
    scene.environment.ambient = ambient;
    return scene;
}
const Camera kDown = cameraAt({0, 1, 0}, {0, -1, 0}, {0, 0, -1});

TraceBackendRegistry bruteOnly() {
    TraceBackendRegistry registry;
    registry.add("brute", "every triangle", [](const Devices&) { return makeBruteBackend(); });
    return registry;
}

/// A pass over `scene` at 1 x 1 pixels.
struct TraceRun : PassRun {
    TraceRun(const Scene& traced, const Camera& eye, uint samples = 1) : PassRun(tracePass()) {
        prepare(traced, eye, samples);
    }
    TraceRun(const Scene& traced, const Camera& eye, uint samples, Device& device)
        : PassRun(tracePass(), device) {
        prepare(traced, eye, samples);
    }
    void prepare(const Scene& traced, const Camera& eye, uint samples) {
        extent({1, 1}).scene(traced).camera(eye).tracers(registry).param("samples", samples);
        list<uvec3>("requests", {{0, 0, samples}});
    }
    vec3 radiance() { return execute().output<Sample>("samples").front().radiance; }
    TraceBackendRegistry registry = bruteOnly();
};

Light pointLight(vec3 position, vec3 intensity) {
    Light light{};
    light.kind = kLightPoint;
    light.position = position;
    light.intensity = intensity;
    return light;
}

TEST(Trace, SeesTheEnvironmentWhereNothingIs) {
    Scene scene = floorScene();
    scene.environment.zenith = vec3(0.25f, 0.5f, 1.0f);
    const Camera up = cameraAt({0, 1, 0}, {0, 1, 0}, {0, 0, 1});
    EXPECT_EQ(TraceRun(scene, up).radiance(), scene.environment.zenith);
}

TEST(Trace, ShadesAmbientEmissionAndAPointLight) {
    Material material = test::plainMaterial();
    material.base_color = vec3(0.5f, 1, 1);
    material.emission = vec3(0, 0.125f, 0);
    Scene scene = floorScene(vec3(0.25f), material);
    scene.lights = {pointLight({0, 2, 0}, vec3(8 * kPi))};
    // albedo * 0.25 + emission + albedo / pi * 8 pi / 2^2
    TraceRun run(scene, kDown);
    const vec3 radiance = run.radiance();
    EXPECT_NEAR(radiance.x, 1.125f, 1e-6f);
    EXPECT_NEAR(radiance.y, 2.375f, 1e-6f);
    EXPECT_NEAR(radiance.z, 2.25f, 1e-6f);
    EXPECT_EQ(run.counter("rays.primary"), 1);
    EXPECT_EQ(run.counter("rays.shadow"), 1);
    EXPECT_EQ(run.counter("rays.reflection"), 0);
}

TEST(Trace, LeavesShadowsTheAmbientLight) {
    test::SceneBuilder builder;
    const uint white = builder.addMaterial(test::plainMaterial());
    addSquare(builder, vec3(0), vec3(100, 0, 0), vec3(0, 0, -100), white);
    addSquare(builder, vec3(0, 1.5f, 0), vec3(1, 0, 0), vec3(0, 0, -1), white);
    Scene scene = builder.finish();
    scene.environment.ambient = vec3(0.25f);
    scene.lights = {pointLight({0, 2, 0}, vec3(8))};
    EXPECT_EQ(TraceRun(scene, kDown).radiance(), vec3(0.25f));
}

TEST(Trace, AddsLightsAndAsksOnlyThoseThatArrive) {
    Scene scene = floorScene();
    Light sun{};
    sun.kind = kLightDirectional;
    sun.direction = vec3(0, -1, 0);
    sun.intensity = vec3(2 * kPi, 0, 0);
    scene.lights = {pointLight({0, 2, 0}, vec3(0, 4 * kPi, 0)), sun,
                    pointLight({0, -1, 0}, vec3(100))}; // below the floor
    TraceRun run(scene, kDown);
    const vec3 radiance = run.radiance();
    EXPECT_NEAR(radiance.x, 2.0f, 1e-6f);
    EXPECT_NEAR(radiance.y, 1.0f, 1e-6f);
    EXPECT_EQ(radiance.z, 0.0f);
    EXPECT_EQ(run.counter("rays.shadow"), 2);
}

Light lampAbove(uint kind) {
    Light light{};
    light.kind = kind;
    light.position = vec3(0, 10, 0);
    light.direction = vec3(0, -1, 0);
    light.half_u = vec3(1, 0, 0);
    light.half_v = vec3(0, 0, 1);
    light.intensity = vec3(1);
    light.radius = kind == kLightDirectional ? 0.1f : 1.0f;
    return light;
}

/// The part of the light that a floor sees at x beside the edge of a half-plane x <= 0 at height 4.
float visiblePart(const Light& light, float x, uint samples) {
    const Camera camera = cameraAt({x, 1, 0}, {0, -1, 0}, {0, 0, -1});
    Scene open = floorScene();
    open.lights = {light};
    test::SceneBuilder builder;
    const uint white = builder.addMaterial(test::plainMaterial(kMaterialTwoSided));
    addSquare(builder, vec3(0), vec3(100, 0, 0), vec3(0, 0, -100), white);
    addSquare(builder, vec3(-50, 4, 0), vec3(50, 0, 0), vec3(0, 0, -50), white);
    Scene edge = builder.finish();
    edge.lights = {light};
    TraceRun run(edge, camera, samples);
    float sum = 0;
    for (const Sample& sample : run.execute().output<Sample>("samples"))
        sum += sample.radiance.x;
    EXPECT_EQ(run.counter("rays.primary"), 1);
    EXPECT_EQ(run.counter("rays.shadow"), samples);
    return sum / static_cast<float>(samples) / TraceRun(open, camera).radiance().x;
}

TEST(Trace, SeesTheVisiblePartOfALightWithAnExtent) {
    // From x, the edge hides what of the light is left of -1.5 x: at x = 0.3 of a side of 2 the
    // share 1/2 - 0.225; of a disc of radius 1 the segment (acos t - t sqrt(1 - t^2)) / pi beyond
    // t = 0.45. A sphere's disc faces the floor's point: t = 0.4487 / cos(0.0449), the centre's
    // distance to the plane through point and edge. The sun's t is 0.3 / 4 / 0.1 = 0.75.
    const uint samples = 16384;
    const struct {
        uint kind;
        float visible;
    } cases[] = {{kLightRectangle, 0.725f},
                 {kLightDisc, 0.77649f},
                 {kLightSphere, 0.77603f},
                 {kLightDirectional, 0.92785f}};
    // The deviation of the mean is at most sqrt(0.725 * 0.275 / 16384) = 0.0035.
    for (const auto& expected : cases)
        EXPECT_NEAR(visiblePart(lampAbove(expected.kind), 0.3f, samples), expected.visible, 0.014f)
            << expected.kind;
}

TEST(Trace, SeesAllOrNothingBesideThePenumbra) {
    // L h / (H - h) = 4/3 wide under the lamp; the sun's is 4 * 2 tan = 0.8 wide.
    for (uint kind : {kLightRectangle, kLightDisc, kLightSphere, kLightDirectional}) {
        const float half = kind == kLightDirectional ? 0.4f : 2.0f / 3.0f;
        // One sample of them would be 1/1024.
        EXPECT_NEAR(visiblePart(lampAbove(kind), half + 0.01f, 1024), 1.0f, 1e-4f) << kind;
        EXPECT_EQ(visiblePart(lampAbove(kind), -half - 0.01f, 1024), 0.0f) << kind;
        const float inside = visiblePart(lampAbove(kind), half - 0.05f, 1024);
        EXPECT_GT(inside, 0.5f) << kind;
        EXPECT_LT(inside, 1.0f) << kind;
    }
}

/// Two mirrors of reflectance 1/2 that face each other and emit 1, seen perpendicularly between
/// them.
Scene facingMirrors(vec3 sky) {
    test::SceneBuilder builder;
    Material mirror = test::plainMaterial(kMaterialMirror);
    mirror.f0 = vec3(0.5f);
    mirror.emission = vec3(1);
    const uint material = builder.addMaterial(mirror);
    addSquare(builder, vec3(-1, 0, 0), vec3(0, 2, 0), vec3(0, 0, 2), material);
    addSquare(builder, vec3(1, 0, 0), vec3(0, 2, 0), vec3(0, 0, -2), material);
    Scene scene = builder.finish();
    scene.environment.zenith = scene.environment.horizon = scene.environment.ground = sky;
    return scene;
}
const Camera kAcross = cameraAt({0, 0, 0}, {1, 0, 0}, {0, 1, 0});

TEST(Trace, FollowsMirrorsToTheLastDepth) {
    const Scene scene = facingMirrors(vec3(1));
    const struct {
        uint depth;
        const char* terminal;
        float radiance;
    } cases[] = {
        {3, "black", 1.875f}, // 1 + 1/2 + 1/4 + 1/8
        {3, "sky", 1.9375f},  // and 1/16 of the sky
        {0, "black", 1.0f},
        {0, "sky", 1.5f},
    };
    for (const auto& expected : cases) {
        TraceRun run(scene, kAcross);
        run.param("max_depth", expected.depth).param("terminal", expected.terminal);
        EXPECT_EQ(run.radiance(), vec3(expected.radiance)) << expected.terminal;
        EXPECT_EQ(run.counter("rays.reflection"), expected.depth);
    }
}

TEST(Trace, GivesDiffuseLightWhatTheMirrorLeaves) {
    Scene scene = facingMirrors(vec3(0));
    scene.environment.ambient = vec3(2);
    // At each level: emission 1 and (1 - 1/2) * 2 ambient.
    TraceRun run(scene, kAcross);
    run.param("max_depth", 1u).param("terminal", "black");
    EXPECT_EQ(run.radiance(), vec3(3.0f));
}

/// Mirrors, shadows and an area light at once, in 23 x 17 pixels.
Scene busyScene() {
    test::SceneBuilder builder;
    const uint white = builder.addMaterial(test::plainMaterial(kMaterialTwoSided));
    Material mirror = test::plainMaterial(kMaterialMirror | kMaterialTwoSided);
    mirror.f0 = vec3(0.9f, 0.7f, 0.5f);
    const uint shiny = builder.addMaterial(mirror);
    addSquare(builder, vec3(0, -1, -4), vec3(6, 0, 0), vec3(0, 0, -6), white);
    addSquare(builder, vec3(0, 0, -6), vec3(2, 0.5f, 0), vec3(0, 2, 0.4f), shiny);
    addSquare(builder, vec3(2, 0, -3), vec3(0.3f, 0, 0.5f), vec3(0, 0.7f, 0), shiny);
    addSquare(builder, vec3(-1, 0.5f, -3), vec3(0.5f, 0, 0), vec3(0, 0, -0.5f), white);
    Scene scene = builder.finish();
    scene.environment = {.zenith = vec3(0.2f, 0.3f, 0.6f),
                         .horizon = vec3(0.7f),
                         .ground = vec3(0.2f),
                         .ambient = vec3(0.1f)};
    Light area{};
    area.kind = kLightRectangle;
    area.position = vec3(0, 4, -3);
    area.direction = vec3(0, -1, 0);
    area.half_u = vec3(1, 0, 0);
    area.half_v = vec3(0, 0, 1);
    area.intensity = vec3(3);
    scene.lights = {area, pointLight({-3, 3, 0}, vec3(4, 5, 6))};
    return scene;
}
const Camera kAhead = cameraAt({0, 0, 0}, {0, 0, -1}, {0, 1, 0});
constexpr uvec2 kExtent{23, 17};

std::vector<Sample> traced(const Scene& scene, const std::vector<uvec3>& requests,
                           std::uint64_t seed = 1) {
    TraceRun run(scene, kAhead, 8);
    run.extent(kExtent).seed(seed).list("requests", requests).execute();
    return run.output<Sample>("samples");
}

std::vector<uvec3> allPixels(uint first, uint count) {
    std::vector<uvec3> requests;
    for (uint pixel = 0; pixel < kExtent.x * kExtent.y; ++pixel)
        requests.push_back({pixel, first, count});
    return requests;
}

TEST(Trace, ListsSamplesByRequest) {
    const Scene scene = busyScene();
    const std::vector<Sample> samples = traced(scene, {{7, 0, 2}, {3, 5, 1}, {200, 0, 3}});
    std::vector<uint> pixels;
    for (const Sample& sample : samples)
        pixels.push_back(sample.pixel);
    EXPECT_EQ(pixels, (std::vector<uint>{7, 7, 3, 200, 200, 200}));
}

TEST(Trace, SampleDependsOnSeedPixelAndNumberOnly) {
    const Scene scene = busyScene();
    const std::vector<Sample> all = traced(scene, allPixels(0, 5));
    const std::vector<Sample> first = traced(scene, allPixels(0, 2));
    const std::vector<Sample> rest = traced(scene, allPixels(2, 3));
    bool differ = false;
    for (std::size_t pixel = 0; pixel < first.size() / 2; ++pixel) {
        for (std::size_t i = 0; i < 5; ++i)
            ASSERT_TRUE(all[5 * pixel + i] ==
                        (i < 2 ? first[2 * pixel + i] : rest[3 * pixel + i - 2]));
        const auto pixel_index = static_cast<uint>(pixel);
        ASSERT_TRUE(traced(scene, {{pixel_index, 4, 1}}).front() == all[5 * pixel + 4]);
        differ |= !(all[5 * pixel] == all[5 * pixel + 1]);
    }
    EXPECT_TRUE(differ); // the area light's penumbra
    EXPECT_FALSE(traced(scene, allPixels(0, 5), 2) == all);
}

TEST(Trace, IsTheSameBitsAtAnyThreadCount) {
    const Scene scene = busyScene();
    std::vector<std::vector<Sample>> results;
    for (std::size_t threads : {1, 2, 8}) {
        tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        results.push_back(traced(scene, allPixels(0, 8)));
    }
    EXPECT_TRUE(results[0] == results[1]);
    EXPECT_TRUE(results[0] == results[2]);
}

// With no time at all an execution still takes a step: many of them are one without a limit.
TEST(Trace, GoesOnWhereItGaveUpToTheSameBits) {
    const Scene scene = busyScene();
    std::vector<uvec3> requests;
    for (int k = 0; k < 6; ++k) // two waves
        for (const uvec3& request : allPixels(0, 8))
            requests.push_back(request);
    TraceRun whole(scene, kAhead, 8), cut(scene, kAhead, 8);
    for (TraceRun* run : {&whole, &cut})
        run->extent(kExtent).seed(1).list("requests", requests);
    whole.execute();
    cut.interrupt({.deadline = Interrupt::Clock::now()});
    int executions = 1;
    try {
        cut.execute();
    } catch (const Interrupted&) {
        for (bool is_done = false; !is_done; ++executions)
            try {
                cut.goOn();
                is_done = true;
            } catch (const Interrupted&) {
                continue;
            }
    }
    // Each wave asks for primary rays, for reflections three times, and after each for two lights.
    EXPECT_GT(executions, 2 * 4 * 2);
    EXPECT_TRUE(cut.output<Sample>("samples") == whole.output<Sample>("samples"));
    for (const char* counter : {"rays.primary", "rays.shadow", "rays.reflection"})
        EXPECT_EQ(cut.counter(counter), whole.counter(counter)) << counter;

    // Executed anew, it does not go on.
    cut.interrupt({}).execute();
    EXPECT_TRUE(cut.output<Sample>("samples") == whole.output<Sample>("samples"));
}

class TraceVulkan : public VulkanTest {};

TEST_F(TraceVulkan, ShadesAsTheHostDoes) {
    const Scene scene = busyScene();
    TraceRun run(scene, kAhead, 2, device());
    run.extent(kExtent).seed(1).list("requests", allPixels(0, 2)).execute();
    const std::vector<Sample> device_samples = run.output<Sample>("samples");
    const std::vector<Sample> host_samples = traced(scene, allPixels(0, 2));
    ASSERT_EQ(device_samples.size(), host_samples.size());
    // Vulkan may round divisions and roots otherwise, and a ray at an edge may then see another
    // triangle: all but a few samples are near.
    std::size_t far = 0;
    for (std::size_t i = 0; i < host_samples.size(); ++i) {
        EXPECT_EQ(device_samples[i].pixel, host_samples[i].pixel);
        far += glm::distance(device_samples[i].radiance, host_samples[i].radiance) > 1e-3f ? 1 : 0;
    }
    EXPECT_LE(far, host_samples.size() / 50);
}

TEST(Trace, GivesNothingForNoRequests) {
    const Scene scene = busyScene();
    EXPECT_TRUE(traced(scene, {}).empty());
}

TEST(Trace, ManyWavesGiveWhatOneWouldGive) {
    const Scene scene = busyScene();
    const std::vector<Sample> once = traced(scene, allPixels(0, 1));
    std::vector<uvec3> requests;
    for (uint k = 0; k < 100; ++k)
        for (const uvec3& request : allPixels(0, 1))
            requests.push_back(request);
    const std::vector<Sample> many = traced(scene, requests);
    ASSERT_EQ(many.size(), 100 * once.size());
    for (std::size_t i = 0; i < many.size(); ++i)
        ASSERT_TRUE(many[i] == once[i % once.size()]) << i;
}

TEST(Trace, SaysWhenMoreIsRequestedThanThereIsRoomFor) {
    const Scene scene = busyScene();
    TraceRun run(scene, kAhead);
    run.list<uvec3>("requests", {{0, 0, 2}});
    try {
        run.execute();
        FAIL();
    } catch (const GraphError& error) {
        EXPECT_STREQ(error.what(), "trace: 2 samples are requested, but there is room for 1; set "
                                   "this pass's parameter \"samples\" to that of request");
    }
}

/// sort, request, trace, accumulate and blend until all is done, as graphs/sir.json does.
std::vector<vec3> refined(const Scene& scene, bool has_order, const char* strategy, uint batch,
                          uint samples, uint per_visit) {
    const std::size_t pixels = kExtent.x * kExtent.y;
    PassRun sort(sortPass());
    std::vector<vec2> errors(pixels);
    for (std::size_t i = 0; i < pixels; ++i)
        errors[i] = vec2(static_cast<float>(i * 7919 % 101) / 100.0f);
    sort.extent(kExtent).param("strategy", strategy).param("batch", batch);
    sort.plane("error", errors).execute();

    PassRun request(requestPass());
    request.extent(kExtent).param("batch", batch).param("samples", samples);
    request.param("per_visit", per_visit);
    if (has_order)
        request.input("order", sort.value("order"));
    TraceRun trace(scene, kAhead, samples);
    trace.extent(kExtent).seed(1);
    PassRun accumulate(accumulatePass());
    accumulate.extent(kExtent);
    PassRun blend(blendPass());
    blend.extent(kExtent).param("samples", samples).param("mode", "ramp");
    const std::vector<vec3> raster(pixels, vec3(0.5f));
    blend.plane("base", raster).plane("image", raster);
    while (request.execute().value("requests").count > 0) {
        trace.input("requests", request.value("requests")).execute();
        accumulate.input("samples", trace.value("samples")).execute();
        blend.input("requests", request.value("requests"));
        blend.input("accumulation", accumulate.value("accumulation")).execute();
    }
    return blend.output<vec3>("image");
}

TEST(Refinement, EndsAtTheSameBitsWhateverOrderBatchAndThreads) {
    const Scene scene = busyScene();
    const uint pixels = kExtent.x * kExtent.y;
    for (uint samples : {1u, 3u}) {
        const std::vector<vec3> truth = refined(scene, false, "select", 0, samples, 0);
        for (std::size_t threads : {1, 2}) {
            tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
            for (const char* strategy : {"select", "radix"})
                for (uint batch : {1u, 7u, 8192u, pixels})
                    for (uint per_visit : {0u, 1u})
                        EXPECT_EQ(refined(scene, true, strategy, batch, samples, per_visit), truth)
                            << strategy << ", batch " << batch << ", samples " << samples;
        }
    }
}

} // namespace
} // namespace hone

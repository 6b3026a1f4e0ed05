// SPDX-License-Identifier: Apache-2.0
#include "hone/core/plugin/plugin_pass.h"

#include "hone/backends/host/parallel_for.h"
#include "hone/cli/allocation_count.h"
#include "hone/core/error.h"
#include "hone/core/plugin/plugin.h"
#include "hone/core/trace/trace_backend.h"
#include "hone/tests/support/bad_plugins.h"
#include "hone/tests/support/graph_fixture.h"
#include "hone/tests/support/run_pass.h"
#include "hone/tests/support/scene_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>

namespace hone::test {
namespace {

using Floats = std::vector<float>;

/// A pass type of one of the tests' plug-ins; the plug-in itself goes, its code stays.
PassType typeOf(const std::string& plugin, const std::string& name) {
    PassRegistry passes;
    TraceBackendRegistry backends;
    Plugin(pluginFile(plugin), hostParallelFor).addTo(passes, backends);
    const PassType* type = passes.find(name);
    if (type == nullptr)
        throw std::logic_error("no pass " + name);
    return *type;
}

PassRun run(const std::string& name) {
    return PassRun(typeOf("good_passes", name));
}

/// One triangle, from (1, 2, 3), placed at x = `x`.
Scene oneTriangle(float x) {
    SceneBuilder builder;
    const std::vector<vec3> positions{{1, 2, 3}, {2, 2, 3}, {1, 3, 3}};
    const std::vector<uvec3> triangles{{0, 1, 2}};
    mat4 place(1);
    place[3] = vec4(x, 0, 0, 1);
    builder.addInstance(builder.addMesh(positions, triangles, builder.addMaterial(plainMaterial())),
                        place);
    return builder.finish();
}

Floats first(const Floats& all, std::size_t count) {
    return {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count)};
}

TEST(PluginPass, IsDeclaredAsItsTablesSay) {
    const PassType type = typeOf("good_passes", "test.tell");
    EXPECT_EQ(type.doc, "Tells what it was told");
    EXPECT_EQ(type.plugin, "good_passes");
    EXPECT_EQ(type.domain, Domain::kHost);
    ASSERT_EQ(type.params.size(), 4u);
    EXPECT_EQ(type.params[0].type, ParamType::kBool);
    EXPECT_EQ(type.params[0].fallback, ParamValue(true));
    EXPECT_EQ(type.params[1].fallback, ParamValue(7u));
    EXPECT_EQ(type.params[1].min, 1.0);
    EXPECT_EQ(type.params[1].max, 9.0);
    EXPECT_EQ(type.params[1].unit, "px");
    EXPECT_EQ(type.params[2].fallback, ParamValue(0.25f));
    EXPECT_EQ(type.params[2].min, 0.0);
    EXPECT_FALSE(type.params[2].max);
    EXPECT_EQ(type.params[3].choices, (std::vector<std::string>{"one", "two", "three"}));
    EXPECT_EQ(type.params[3].fallback, ParamValue(std::string("two")));
    const PassType mix = typeOf("good_passes", "test.mix");
    EXPECT_TRUE(mix.inputs[0].variadic);
    EXPECT_EQ(mix.inputs[0].edge_params[0].name, "weight");
    EXPECT_EQ(mix.inputs[0].edge_params[0].fallback, ParamValue(1.0f));
    EXPECT_TRUE(mix.inputs[1].optional);
    EXPECT_EQ(typeOf("good_passes", "test.increase").outputs[0].in_place_of, "before");
}

TEST(PluginPass, BringsTypesOfItsOwnAndUsesHones) {
    // A pass type keeps the plug-in's library, and with it its port types' texts, alive.
    const PassType tell = typeOf("good_passes", "test.tell");
    const PortType& told = tell.outputs[0].type;
    EXPECT_EQ(told.name, "Told");
    EXPECT_EQ(told.shape, Shape::kRecord);
    EXPECT_EQ(told.stride, 4u);
    EXPECT_EQ(told.format, "float");
    EXPECT_FALSE(std::isfinite(told.min));
    const PassType scale = typeOf("plain_c_pass", "plain_c.scale");
    EXPECT_EQ(describe(scale.outputs[0].type),
              "ScaledDepth (float, m, at least 0): depth by a factor");
    EXPECT_EQ(scale.inputs[0].type.doc, types::kDepth.doc);
}

TEST(PluginPass, IsToldItsParametersSizeAndSeed) {
    PassRun tell = run("test.tell");
    tell.extent({5, 3}).seed(11).iteration(2);
    EXPECT_EQ(first(tell.execute().output<float>("told"), 9),
              (Floats{1, 7, 0.25f, 1, 5, 3, 11, 2, 1}));
    tell.param("flag", false).param("number", 9u).param("share", 3.5f);
    tell.param("mode", std::string("three"));
    EXPECT_EQ(first(tell.execute().output<float>("told"), 9),
              (Floats{0, 9, 3.5f, 2, 5, 3, 11, 2, 2}))
        << "one object from the first execution to the last";
}

TEST(PluginPass, Counts) {
    PassRun tell = run("test.tell");
    tell.extent({1, 1}).execute().execute();
    EXPECT_EQ(tell.counter("told.things"), 18u);
    EXPECT_EQ(tell.counter("told.times"), 2u);
}

TEST(PluginPass, RunsInPlainC) {
    PassRun scale(typeOf("plain_c_pass", "plain_c.scale"));
    scale.extent({4, 2}).plane<float>("depth", {1, 2, 3, 4, 5, 6, 7, 8});
    EXPECT_EQ(scale.execute().output<float>("scaled"), (Floats{2, 4, 6, 8, 10, 12, 14, 16}));
    scale.param("factor", 0.5f);
    EXPECT_EQ(scale.execute().output<float>("scaled"),
              (Floats{0.5f, 1, 1.5f, 2, 2.5f, 3, 3.5f, 4}));
}

TEST(PluginPass, TakesSeveralEdgesWithTheirParameters) {
    PassRun mix = run("test.mix");
    mix.extent({2, 1})
        .plane<float>("planes", {1, 2}, {3.0f, 0.0f})
        .plane<float>("planes", {10, 20}, {0.5f, 100.0f});
    EXPECT_EQ(mix.execute().output<float>("sum"), (Floats{108, 116})); // 3 * 1 + 0.5 * 10 + 100
}

TEST(PluginPass, KnowsWhetherAnOptionalInputIsThere) {
    PassRun mix = run("test.mix");
    mix.extent({2, 1}).plane<float>("planes", {1, 2}).plane<float>("offset", {7, 8});
    EXPECT_EQ(mix.execute().output<float>("sum"), (Floats{8, 10}));
}

TEST(PluginPass, SaysHowManyElementsItListed) {
    PassRun near = run("test.near");
    near.extent({3, 2}).plane<float>("depth", {5, 0.5f, 5, 5, 0.25f, 5});
    EXPECT_EQ(near.execute().output<uint>("pixels"), (std::vector<uint>{1, 4}));
    near.plane<float>("depth", {5, 5, 5, 5, 5, 5});
    EXPECT_EQ(near.execute().output<uint>("pixels"), std::vector<uint>{});
    // Room was asked for half the pixels.
    near.plane<float>("depth", {0, 0, 0, 0, 0, 0});
    EXPECT_THROW(near.execute(), PluginError);
}

TEST(PluginPass, UpdatesInPlace) {
    PassRun increase = run("test.increase");
    increase.extent({2, 1}).plane<float>("before", {1, 2}).execute();
    EXPECT_EQ(increase.output<float>("after"), (Floats{2, 3}));
    PassRun alone = run("test.increase");
    EXPECT_EQ(alone.extent({2, 1}).execute().output<float>("after"), (Floats{1, 1}));
}

TEST(PluginPass, SeesSceneAndCamera) {
    Scene scene = oneTriangle(10);
    Camera camera{};
    camera.position = {7, 8, 9};
    camera.focus = 2;
    PassRun look = run("test.look");
    look.extent({1, 1}).scene(scene).camera(camera).execute();
    EXPECT_EQ(first(look.output<float>("told"), 9), (Floats{1, 1, 11, 2, 3, 7, 8, 9, 2}));
    moveInstance(scene, 0, mat4x3(1, 0, 0, 0, 1, 0, 0, 0, 1, 20, 0, 0));
    EXPECT_EQ(look.execute().output<float>("told")[2], 21) << "moved instances are seen moved";
}

// A cancelled pass gets a row further each time, and ends where an undisturbed one does.
TEST(PluginPass, GivesUpWhenAskedToAndGoesOn) {
    std::atomic<bool> cancel = true;
    PassRun patient = run("test.patient");
    patient.extent({2, 3}).interrupt({.cancel = &cancel});
    EXPECT_THROW(patient.execute(), Interrupted);
    EXPECT_THROW(patient.goOn(), Interrupted);
    patient.goOn();
    EXPECT_EQ(patient.output<float>("plane"), (Floats{0, 0, 1, 1, 2, 2}));
}

/// A failing pass, made and executed on 3 x 2 pixels and one triangle, called "node" in its graph.
void use(const std::string& name) {
    const Scene scene = oneTriangle(0);
    PassRun failing(typeOf("failing_passes", name));
    failing.extent({3, 2}).scene(scene).execute();
}

struct Failure {
    const char* pass;
    const char* reason;
};

class PassFailures : public testing::TestWithParam<Failure> {};

TEST_P(PassFailures, AreReportedWithTheirReason) {
    try {
        use(GetParam().pass);
        FAIL() << "nothing was thrown";
    } catch (const PluginError& problem) {
        const std::string text = problem.what();
        EXPECT_EQ(text.find("plug-in /"), 0) << text;
        EXPECT_NE(text.find(GetParam().pass), std::string::npos) << text;
        EXPECT_NE(text.find(GetParam().reason), std::string::npos) << text;
    }
}

INSTANTIATE_TEST_SUITE_P(
    All, PassFailures,
    testing::Values(
        Failure{"create_fails", "create failed: no licence server?[31m"},
        Failure{"create_makes_nothing", "create said that all is well, but made nothing"},
        Failure{"create_throws", "create threw an exception: lost my keys"},
        Failure{"create_throws_a_number", "create threw something that is no std::exception"},
        Failure{"create_throws_bad_alloc", "create threw an exception: std::bad_alloc"},
        Failure{"execute_fails", "execute failed: bored?"},
        Failure{"execute_gives_no_reason", "execute failed: it gave no reason"},
        Failure{"execute_throws", "execute threw an exception: dusk"},
        Failure{"execute_throws_a_number", "execute threw something that is no std::exception"},
        Failure{"execute_throws_bad_alloc", "execute threw an exception: std::bad_alloc"},
        Failure{"execute_ends_oddly", "execute failed: it gave no reason"},
        Failure{"execute_writes_no_end", "execute failed: xxxxxxxx"},
        Failure{"execute_gives_up", "execute gave up, although nobody had asked it to"},
        Failure{"execute_counts_the_unknown", "execute counted by counter 5 of 0"},
        Failure{"writes_nan", "output \"result\": pixel (2, 0) has nan, but numbers of Error are "
                              "finite, at least 0"},
        Failure{"writes_infinity", "pixel (0, 0) has inf, but numbers of Error are finite"},
        Failure{"writes_less_than_nothing", "pixel (0, 0) has -0.5, but numbers of Error"},
        Failure{"writes_more_than_white",
                "pixel (1, 0) has 1.5, but numbers of Display are finite, at least 0, at most 1"},
        Failure{"lists_no_pixel", "element 0 names pixel 6, but the frame has 6"},
        Failure{"requests_no_pixel", "element 0 names pixel 1000000, but the frame has 6"},
        Failure{"samples_no_pixel", "element 0 names pixel 1000000, but the frame has 6"},
        Failure{"lists_too_much", "it says that 5 elements are valid, but there is room for 4"},
        Failure{"size_throws", "output \"result\": size threw an exception: cannot count"},
        Failure{"size_is_huge", "size answered 18446744073709551615 elements"},
        Failure{"sees_no_instance", "pixel (1, 0) has instance 1000000, primitive 0, which the"}),
    [](const auto& tested) { return std::string(tested.param.pass); });

TEST(PluginPass, PassesOnThatItsDeviceIsMissingOrMemoryShort) {
    EXPECT_THROW(use("create_has_no_device"), DeviceError);
    EXPECT_THROW(use("execute_has_no_device"), DeviceError);
    EXPECT_THROW(use("create_has_no_memory"), OutOfMemory);
    EXPECT_THROW(use("execute_has_no_memory"), OutOfMemory);
}

TEST(PluginPass, OutlivesADestroyThatThrows) {
    EXPECT_NO_THROW(use("destroy_throws"));
}

TEST(PluginPass, NeedsNoCreateWhereItKeepsNothing) {
    EXPECT_NO_THROW(use("keeps_nothing"));
}

TEST(PluginPass, OfATakenNameIsRefusedAndNamesWhoHasIt) {
    PassRegistry passes;
    TraceBackendRegistry backends;
    const Plugin plugin(pluginFile("good_passes"), hostParallelFor);
    plugin.addTo(passes, backends);
    const std::size_t count = passes.all().size();
    try {
        plugin.addTo(passes, backends);
        FAIL();
    } catch (const PluginError& problem) {
        EXPECT_NE(std::string(problem.what())
                      .find("its pass \"test.tell\" has the name of one of plug-in good_passes"),
                  std::string::npos)
            << problem.what();
    }
    EXPECT_EQ(passes.all().size(), count);
}

TEST(PluginPass, IsRefusedWhereAnothersTypeOfItsNameIsLaidOutOtherwise) {
    PassRegistry passes;
    TraceBackendRegistry backends;
    static constexpr PortType kOther{"Told", Shape::kPlane, 4, "another"};
    passes.add(PassType("other", "Other.").out("told", kOther, "told"));
    try {
        Plugin(pluginFile("good_passes"), hostParallelFor).addTo(passes, backends);
        FAIL();
    } catch (const PluginError& problem) {
        EXPECT_NE(std::string(problem.what()).find("port type \"Told\" has the name of another"),
                  std::string::npos)
            << problem.what();
    }
    EXPECT_EQ(passes.all().size(), 1u);
}

class PluginPassInAGraph : public GraphTest {};

TEST_F(PluginPassInAGraph, RunsWhenItsInputsChangeAndAllocatesNothing) {
    TraceBackendRegistry backends;
    Plugin(pluginFile("good_passes"), hostParallelFor).addTo(catalog.passes, backends);
    const auto executor = start(R"({ "hone": 1, "inputs": { "scene": "scene", "camera": "camera" },
  "passes": { "raster": { "type": "raster", "in": { "scene": "$scene", "camera": "$camera" } },
              "mix": { "type": "test.mix", "in": { "planes": [
                  { "from": "raster.depth", "weight": 2 }, { "from": "raster.depth", "bias": 0.5 } ] } },
              "more": { "type": "test.increase", "in": { "before": "mix.sum" } },
              "near": { "type": "test.near", "in": { "depth": "more.after" }, "params": { "limit": 4 } } },
  "outputs": { "sum": "more.after", "near": "near.pixels" } })");
    const auto run = [&](float x) {
        camera.position.x = x;
        executor->setCamera(camera);
        executor->run();
    };
    run(1);
    run(2);
    const std::uint64_t before = cli::allocationCount();
    run(3);
    EXPECT_EQ(cli::allocationCount() - before, 0u);
    EXPECT_EQ(runs(*executor, "mix"), 3u);
    executor->run();
    EXPECT_EQ(runs(*executor, "mix"), 3u) << "nothing changed";
    // Depth is 1 everywhere: 2 * 1 + (1 * 1 + 0.5) + 1.
    EXPECT_EQ(executor->output("sum").as<float>()[9], 4.5f);
    EXPECT_EQ(executor->output("near").count, 0u);
}

} // namespace
} // namespace hone::test

// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/host/host_device.h"
#include "hone/core/error.h"
#include "hone/core/pass/pass.h"
#include "hone/tests/support/fake_tracers.h"
#include "hone/tests/support/scene_builder.h"

#include <gtest/gtest.h>

#include <array>

namespace hone {
namespace {

using test::FakeTracer;
using testing::Test;

class TracerChoiceTest : public Test {
protected:
    /// Registers a fake; `made` counts how many were made.
    void add(TraceCaps caps, double us_per_ray = 0) {
        registry.add(caps.name, "", [this, caps, us_per_ray](const Devices&) {
            ++made;
            auto tracer = std::make_unique<FakeTracer>(caps);
            tracer->us_per_ray = us_per_ray;
            return tracer;
        });
    }
    void addRefusing(const std::string& name, const std::string& why) {
        registry.add(name, "", [why](const Devices&) -> std::unique_ptr<TraceBackend> {
            throw DeviceError(why);
        });
    }
    [[nodiscard]] TracerChoice choose(bool masked = false) const {
        return chooseTracer(registry, devices, masked);
    }
    static TraceCaps host(const std::string& name) {
        return {.name = name, .version = "1", .runs_on = "host"};
    }
    static TraceCaps gpu(const std::string& name) {
        return {.name = name, .version = "1", .runs_on = "some GPU"};
    }
    static bool contains(std::string_view text, std::string_view part) {
        return text.find(part) != std::string_view::npos;
    }
    /// One triangle.
    static Scene sceneOf(uint material_flags) {
        test::SceneBuilder builder;
        const std::array corners{vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)};
        const std::array triangles{uvec3(0, 1, 2)};
        builder.add(corners, triangles, builder.addMaterial(test::plainMaterial(material_flags)));
        Scene scene = builder.finish();
        scene.name = "leaves.gltf";
        return scene;
    }

    int made = 0;
    TraceBackendRegistry registry;
    std::unique_ptr<Device> device = makeHostDevice();
    std::unique_ptr<Device> software = makeHostDevice();
    Devices devices{device.get(), nullptr};
};

TEST_F(TracerChoiceTest, TakesTheFastestAndSaysHowFastTheyWere) {
    add(gpu("slow"), 20);
    add(gpu("fast"));
    add(host("slower"), 50);
    const TracerChoice choice = choose();
    EXPECT_EQ(choice.name, "fast");
    ASSERT_NE(choice.backend, nullptr);
    EXPECT_EQ(choice.backend->caps().name, "fast");
    // fastest of slow 0.049, fast 1e+04, slower 0.0198 Mray/s
    EXPECT_TRUE(choice.reason.starts_with("fastest of slow 0.0")) << choice.reason;
    EXPECT_TRUE(contains(choice.reason, ", fast ")) << choice.reason;
    EXPECT_TRUE(choice.reason.ends_with(" Mray/s")) << choice.reason;
}

TEST_F(TracerChoiceTest, TimesNothingWhereThereIsNoChoice) {
    add(host("only"), 1000);
    const TracerChoice choice = choose();
    EXPECT_EQ(choice.name, "only");
    EXPECT_EQ(choice.reason, "the only one there is");
    EXPECT_EQ(dynamic_cast<FakeTracer&>(*choice.backend).builds, 0);
}

TEST_F(TracerChoiceTest, LeavesOutWhatIsNoUseWithoutATrial) {
    devices.raster = software.get();
    TraceCaps reference = host("brute");
    reference.is_reference = true;
    TraceCaps on_software = host("vulkan.compute");
    on_software.runs_on = software->info().name;
    addRefusing("vulkan.ray_query", "no ray query");
    add(reference);
    add(on_software);
    add(host("embree"), 1000);
    add(host("bvh"));
    const TracerChoice choice = choose();
    EXPECT_EQ(choice.name, "embree");
    EXPECT_EQ(choice.reason,
              "the only one fit (vulkan.ray_query: no ray query; brute: references, for tiny "
              "scenes; vulkan.compute: of a software device, on the same cores; bvh: on the same "
              "cores as embree, which comes first)");
    EXPECT_EQ(dynamic_cast<FakeTracer&>(*choice.backend).builds, 0);
}

TEST_F(TracerChoiceTest, PrefersASoftwareDeviceToAReferenceAndThatToNothing) {
    devices.raster = software.get();
    TraceCaps reference = host("brute");
    reference.is_reference = true;
    add(reference);
    reference.name = "null";
    add(reference);
    EXPECT_EQ(choose().name, "brute"); // the first, fast as others may be
    TraceCaps on_software = host("vulkan.compute");
    on_software.runs_on = software->info().name;
    add(on_software);
    EXPECT_EQ(choose().name, "vulkan.compute");
}

TEST_F(TracerChoiceTest, AsksForMasksOnlyWhereASceneHasThem) {
    TraceCaps unmasked = host("unmasked");
    unmasked.masked = false;
    add(unmasked);
    add(host("masked"));
    EXPECT_EQ(choose(false).name, "unmasked");
    EXPECT_EQ(choose(true).name, "masked");
}

TEST_F(TracerChoiceTest, KnowsASecondNameOfABackend) {
    registry.add("best", "",
                 [](const Devices&) { return std::make_unique<FakeTracer>(gpu("ray_query")); });
    add(gpu("ray_query"));
    EXPECT_EQ(choose().name, "ray_query");
}

TEST_F(TracerChoiceTest, DropsWhatFailsItsTrial) {
    registry.add("broken", "", [](const Devices&) {
        auto tracer = std::make_unique<FakeTracer>(gpu("broken"));
        tracer->on_query = [] { throw DeviceError("lost"); };
        return tracer;
    });
    add(host("sound"));
    const TracerChoice choice = choose();
    EXPECT_EQ(choice.name, "sound");
    EXPECT_EQ(choice.reason, "the only one fit (broken: lost)");
}

TEST_F(TracerChoiceTest, SaysWhyNoneIsLeft) {
    TraceCaps unmasked = host("unmasked");
    unmasked.masked = false;
    add(unmasked);
    addRefusing("vulkan.ray_query", "no ray query");
    try {
        (void)choose(true);
        FAIL();
    } catch (const DeviceError& error) {
        EXPECT_TRUE(contains(error.what(), "unmasked: sees no alpha masks"));
        EXPECT_TRUE(contains(error.what(), "vulkan.ray_query: no ray query"));
    }
}

TEST_F(TracerChoiceTest, IsMadeOnceAndAgainForMasks) {
    add(host("a"));
    add(gpu("b"), 20);
    Tracers tracers(registry, devices);
    const Scene plain = sceneOf(0), masked = sceneOf(kMaterialMasked);
    Value value;
    value.scene = &plain;
    EXPECT_EQ(tracers.get("auto", value).caps().name, "a");
    EXPECT_EQ(made, 2); // the one that was tried is the one that is used
    EXPECT_EQ(tracers.resolve("auto", plain).name, "a");
    EXPECT_TRUE(tracers.resolve("auto", plain).reason.starts_with("fastest of a "));
    EXPECT_EQ(made, 2);
    value.scene = &masked;
    EXPECT_EQ(tracers.get("auto", value).caps().name, "a");
    EXPECT_EQ(made, 4);
    EXPECT_EQ(tracers.resolve("b", plain).name, "b");
}

TEST_F(TracerChoiceTest, RefusesAMaskedSceneToABackendThatIsNamedButSeesNoHoles) {
    TraceCaps unmasked = host("solid");
    unmasked.masked = false;
    add(unmasked);
    Tracers tracers(registry, devices);
    const Scene plain = sceneOf(0), masked = sceneOf(kMaterialMasked);
    Value value;
    value.scene = &plain;
    EXPECT_EQ(tracers.get("solid", value).caps().name, "solid");
    value.scene = &masked;
    for (int time = 0; time < 2; ++time)
        try {
            (void)tracers.get("solid", value);
            FAIL();
        } catch (const DeviceError& error) {
            EXPECT_STREQ(error.what(),
                         "trace backend \"solid\" does not honour alpha-masked materials, which "
                         "scene \"leaves.gltf\" has; set parameter \"backend\" to \"auto\"");
        }
    EXPECT_THROW((void)tracers.make("solid", masked), DeviceError);
}

} // namespace
} // namespace hone

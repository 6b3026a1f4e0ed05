// SPDX-License-Identifier: Apache-2.0
#include "hone/core/device/recording_device.h"
#include "hone/core/pass/pass_type.h"
#include "hone/tests/support/graph_fixture.h"
#include "hone/tests/support/scene_builder.h"

#include <algorithm>

namespace hone {
namespace {

/// Says that it copied 100 bytes of each scene, and 7 bytes for each list that it is asked.
class CopyingTracer final : public TraceBackend {
public:
    TraceCaps caps() const override {
        TraceCaps caps;
        caps.name = "copying";
        return caps;
    }
    BuildStats build(const Scene&, const SceneBuffers*) override {
        ++builds;
        return {.copied_bytes = 100};
    }
    BuildStats update(std::span<const uint>) override { return {}; }
    void closest(std::span<const Ray>, std::span<Hit>, Coherence,
                 const TraceOptions&) const override {
        copied_ += 7;
    }
    void occluded(std::span<const Ray>, std::span<uint>, Coherence,
                  const TraceOptions&) const override {}
    std::size_t copiedBytes() const override { return copied_; }

    static inline int builds = 0;

private:
    mutable std::size_t copied_ = 0;
};

/// Asks its tracer one empty list.
class Ask final : public RenderPass {
public:
    void execute(PassContext& context) override {
        context.tracers->get(context.param<std::string>("backend"), context.scene())
            .closest({}, {}, Coherence::kCoherent, {});
    }
};

class ExecutorCopies : public testing::Test {
protected:
    ExecutorCopies() {
        backends_.add("copying", "",
                      [](const Devices&) { return std::make_unique<CopyingTracer>(); });
        passes_.add(PassType("ask", "asks a tracer")
                        .in("scene", types::kScene, "the scene")
                        .out("color", types::kRadiance, "nothing")
                        .backendParam("backend", "whom")
                        .implementedBy<Ask>(Domain::kHost));
        test::SceneBuilder builder;
        builder.add(std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                    std::vector<uvec3>{{0, 1, 2}}, builder.addMaterial(test::plainMaterial()));
        scene_ = builder.finish();
        CopyingTracer::builds = 0;
    }

    std::unique_ptr<Executor> start(Device* raster) {
        const Catalog catalog{&passes_, &backends_};
        std::vector<Diagnostic> diagnostics;
        const GraphDesc desc = parseGraph("test.json", R"({
            "hone": 1, "name": "ask", "inputs": { "scene": "scene" },
            "passes": { "ask": { "type": "ask", "in": { "scene": "$scene" } } },
            "outputs": { "color": "ask.color" }
        })",
                                          diagnostics);
        CompiledGraph graph = compile(desc, catalog, {}, diagnostics);
        EXPECT_TRUE(diagnostics.empty()) << format(diagnostics);
        auto executor =
            std::make_unique<Executor>(std::move(graph), catalog, Devices{host_.get(), raster});
        executor->setScene(scene_);
        executor->setExtent({1, 1});
        return executor;
    }

    static std::vector<std::string> names(const std::vector<MemoryCopy>& copies) {
        std::vector<std::string> result;
        for (const MemoryCopy& copy : copies)
            result.push_back(copy.what);
        return result;
    }

    PassRegistry passes_;
    TraceBackendRegistry backends_;
    std::unique_ptr<Device> host_ = makeHostDevice();
    Scene scene_;
};

TEST_F(ExecutorCopies, OfTheSceneByATracerAreKnownBeforeItRuns) {
    const auto executor = start(nullptr);
    EXPECT_TRUE(executor->copies().empty());
    executor->prepare();
    const std::vector<MemoryCopy> copies = executor->copies();
    ASSERT_EQ(copies.size(), 1u) << "the host device uses the scene's own arrays";
    EXPECT_EQ(copies[0].what, "the scene in copying");
    EXPECT_EQ(copies[0].bytes, 100u);
    EXPECT_NE(copies[0].why, "");
    EXPECT_NE(copies[0].cure, "");
}

TEST_F(ExecutorCopies, OfListsAreKnownOnceTheyWereAsked) {
    const auto executor = start(nullptr);
    executor->run();
    const std::vector<MemoryCopy> copies = executor->copies();
    EXPECT_EQ(names(copies),
              (std::vector<std::string>{"the scene in copying", "rays and answers of copying"}));
    EXPECT_EQ(copies[1].bytes, 7u);
}

TEST_F(ExecutorCopies, NameEachArrayThatADeviceCannotUse) {
    RecordingDevice device; // imports nothing
    const auto executor = start(&device);
    executor->prepare();
    const std::vector<std::string> what = names(executor->copies());
    EXPECT_EQ(what.front(), "scene_positions");
    EXPECT_EQ(std::ranges::count(what, "scene_lights"), 0) << "it is empty";
    EXPECT_EQ(std::ranges::count(what, "scene_environment"), 1);
}

TEST_F(ExecutorCopies, PreparingIsNotDoneTwice) {
    const auto executor = start(nullptr);
    executor->prepare();
    executor->prepare();
    executor->run();
    EXPECT_EQ(CopyingTracer::builds, 1);
}

} // namespace
} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/pixel_probe.h"

#include "hone/cli/commands.h"
#include "hone/core/error.h"
#include "hone/core/graph/executor.h"
#include "hone/core/pass/pass_type.h"
#include "hone/core/scene/camera_path.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace hone::cli {
namespace {

using Json = nlohmann::ordered_json;

/// Requests all samples of one pixel.
class OnePixel final : public RenderPass {
public:
    void execute(PassContext& context) override {
        context.out("requests").as<uvec3>().front() =
            uvec3(context.param<uint>("pixel"), 0u, context.param<uint>("samples"));
    }
};

PassType onePixelPass() {
    return PassType("probe.pixel", "Requests all samples of one pixel")
        .out("requests", types::kRequestList, "the pixel",
             [](const SizeQuery&) { return std::size_t{1}; })
        .param("pixel", 0u, {}, "y * width + x")
        .param("samples", 1u, {.min = 1, .max = {}}, "from the first")
        .implementedBy<OnePixel>(Domain::kHost);
}

const PlannedNode& tracingNode(const CompiledGraph& graph) {
    for (const PlannedNode& node : graph.nodes)
        if (node.culled.empty() && node.type != nullptr && node.type->name == "trace")
            return node;
    throw InputError("graph \"" + graph.name +
                     "\" has no trace pass, so no backend made the image");
}

/// The pixel's request, and the graph's own trace pass, asking "both".
CompiledGraph makeProbeGraph(const PlannedNode& trace, const Catalog& catalog) {
    Json params = Json::object();
    for (const ParamDecl& decl : trace.type->params)
        std::visit([&](const auto& value) { params[decl.name] = value; },
                   trace.params.value(decl.name));
    params["backend"] = "both";
    const Json graph = {
        {"hone", 1},
        {"name", "probe"},
        {"inputs", {{"scene", "scene"}, {"camera", "camera"}}},
        {"passes",
         {{"pixel", {{"type", "probe.pixel"}, {"params", {{"samples", params["samples"]}}}}},
          {"trace",
           {{"type", "trace"},
            {"in", {{"requests", "pixel.requests"}, {"scene", "$scene"}, {"camera", "$camera"}}},
            {"params", params}}}}},
        {"outputs", {{"samples", "trace.samples"}}}};
    std::vector<Diagnostic> diagnostics;
    CompiledGraph compiled =
        compile(parseGraph("probe", graph.dump(2), diagnostics), catalog, {}, diagnostics);
    HONE_ASSERT(diagnostics.empty(), format(diagnostics));
    return compiled;
}

} // namespace

/// Answers as the first backend does, and notes the first ray that the second answers otherwise.
class PixelProbe::BothTracers final : public TraceBackend {
public:
    BothTracers(std::unique_ptr<TraceBackend> first, std::unique_ptr<TraceBackend> second,
                std::optional<PixelReason>& reason)
        : first_(std::move(first)), second_(std::move(second)), reason_(&reason) {}

    TraceCaps caps() const override { return first_->caps(); }
    BuildStats build(const Scene& scene, const SceneBuffers* shared) override {
        scene_ = &scene;
        second_->build(scene, shared);
        return first_->build(scene, shared);
    }
    BuildStats update(std::span<const uint> moved) override {
        second_->update(moved);
        return first_->update(moved);
    }

    void closest(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence,
                 const TraceOptions& options) const override {
        std::vector<Hit> others(rays.size());
        first_->closest(rays, hits, coherence, options);
        second_->closest(rays, others, coherence, options);
        // Lists after the first are those of mirrors.
        const char* kind = lists_asked_++ == 0 ? "primary" : "mirror";
        for (std::size_t i = 0; i < rays.size() && !*reason_; ++i)
            if (hits[i].instance != others[i].instance || hits[i].primitive != others[i].primitive)
                *reason_ = {
                    kind,
                    rays[i],
                    DifferenceExplainer(*scene_).explainClosest(rays[i], hits[i], others[i]),
                    {nameOf(*scene_, hits[i]), nameOf(*scene_, others[i])}};
    }

    void occluded(std::span<const Ray> rays, std::span<uint> occluded, Coherence coherence,
                  const TraceOptions& options) const override {
        std::vector<uint> others(rays.size());
        first_->occluded(rays, occluded, coherence, options);
        second_->occluded(rays, others, coherence, options);
        const char* kind = lists_asked_ == 1 ? "shadow" : "mirror_shadow";
        for (std::size_t i = 0; i < rays.size() && !*reason_; ++i)
            if (occluded[i] != others[i])
                *reason_ = {
                    kind,
                    rays[i],
                    DifferenceExplainer(*scene_).explainOccluded(rays[i], occluded[i], others[i]),
                    {occluded[i] != 0 ? "occluded" : "free", others[i] != 0 ? "occluded" : "free"}};
    }

    void begin() { lists_asked_ = 0; }

private:
    std::unique_ptr<TraceBackend> first_, second_;
    std::optional<PixelReason>* reason_;
    const Scene* scene_ = nullptr;
    mutable int lists_asked_ = 0; ///< of closest hits, for the pixel
};

PixelProbe::PixelProbe(const Setup& setup)
    : session_(setup.plugins), scene_(loadScene(setup.scene)) {
    const CompiledGraph graph =
        loadGraph(findGraph(setup.graph), session_.catalog(), setup.overrides);
    const Devices devices = session_.openDevices("", false);
    const TraceBackendRegistry& known = session_.traceBackends();
    for (const std::string& name : setup.backends)
        if (!known.contains(name))
            throw InputError("no trace backend is called \"" + name + "\"");
    tracers_.add("both", "", [&](const Devices& on) {
        auto both = std::make_unique<BothTracers>(known.create(setup.backends[0], on),
                                                  known.create(setup.backends[1], on), reason_);
        tracer_ = both.get();
        return both;
    });
    passes_.add(onePixelPass());
    passes_.add(*session_.passes().find("trace"));
    const Catalog catalog{&passes_, &tracers_};
    executor_ = std::make_unique<Executor>(makeProbeGraph(tracingNode(graph), catalog), catalog,
                                           devices, setup.seed);
    executor_->setScene(scene_);
    executor_->setCamera(makeCamera(setup.path.empty()
                                        ? scene_.camera(setup.camera)
                                        : cameraAt(cameraPath(scene_, setup.path), setup.time)));
    executor_->setExtent(setup.extent);
}

PixelProbe::~PixelProbe() = default;

std::optional<PixelReason> PixelProbe::ask(uint pixel) {
    reason_.reset();
    if (tracer_ != nullptr)
        tracer_->begin();
    executor_->setParameter("pixel.pixel", std::to_string(pixel));
    executor_->run();
    return reason_;
}

} // namespace hone::cli

// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/bench_passes.h"

#include "hone_spirv/visibility_vert.h"

#include "hone/core/scene/scene_buffers.h"
#include "hone/passes/shading/visibility.h"

#include <algorithm>

namespace hone::cli {
namespace {

class BenchVisibility final : public RenderPass {
public:
    void execute(PassContext& context) override {
        visibility_.drawHits(context, {context.camera(), context.extent, 0.0f}, {},
                             context.out("gbuffer").buffer);
        context.device->finish();
    }

private:
    Visibility visibility_;
};

class BenchDepthOnly final : public RenderPass {
public:
    ~BenchDepthOnly() override {
        if (device_ == nullptr)
            return;
        device_->destroy(depth_);
        device_->destroy(pipeline_);
    }

    void execute(PassContext& context) override {
        prepare(context);
        const View view{context.camera(), context.extent, 0.0f};
        Arguments arguments;
        arguments.bind("world_positions", world_.positions());
        context.device->beginRaster({ImageHandle::kNone, depth_, context.extent});
        context.device->drawIndexed(pipeline_, CullMode::kBack, arguments,
                                    std::as_bytes(std::span(&view, 1)), indices_.view(),
                                    draws_.view());
        context.device->endRaster();
        context.device->copyImage(depth_, context.out("depth").buffer);
        context.device->finish();
    }

private:
    void prepare(PassContext& context) {
        const Scene& scene = *context.scene().scene;
        device_ = context.memory;
        if (pipeline_ == PipelineHandle::kNone)
            pipeline_ = device_->createRasterPipeline({.name = "bench_depth_only",
                                                       .vertex_spirv = spirv::visibility_vert,
                                                       .fragment_spirv = {}});
        if (extent_ != context.extent) {
            device_->destroy(std::exchange(depth_, ImageHandle::kNone));
            depth_ = device_->createImage({context.extent, ImageFormat::kDepth32, "bench_depth"});
            extent_ = context.extent;
        }
        if (version_ == scene.version)
            return;
        version_ = scene.version;
        world_.update(*device_, scene);
        std::vector<uvec3> triangles;
        for (uint index = 0; index < scene.instances.size(); ++index) {
            const Mesh& mesh = scene.meshes[scene.instances[index].mesh];
            for (uint k = 0; k < mesh.triangle_count; ++k)
                triangles.push_back(scene.triangles[mesh.first_triangle + k] +
                                    uvec3(world_.vertexOffset(index)));
        }
        indices_ = device_->createBuffer(triangles.size() * sizeof(uvec3), "bench_indices");
        std::ranges::copy(triangles, indices_.as<uvec3>().begin());
        draws_ = device_->createBuffer(sizeof(DrawIndexed), "bench_draws");
        draws_.as<DrawIndexed>()[0] = {.index_count = static_cast<uint>(3 * triangles.size())};
    }

    Device* device_ = nullptr;
    WorldGeometry world_;
    Buffer indices_, draws_;
    PipelineHandle pipeline_ = PipelineHandle::kNone;
    ImageHandle depth_ = ImageHandle::kNone;
    uvec2 extent_{0, 0};
    std::uint64_t version_ = 0;
};

class BenchNoise final : public RenderPass {
public:
    void execute(PassContext& context) override {
        const std::span<const vec2> errors = context.in("error").as<vec2>();
        const std::span<vec2> noisy = context.out("noisy").as<vec2>();
        for (uint pixel = 0; pixel < errors.size(); ++pixel) {
            // Thomas Wang's integer hash, to [0, 0.01).
            uint hash = (pixel ^ 61u) ^ (pixel >> 16u);
            hash *= 9u;
            hash ^= hash >> 4u;
            hash *= 0x27d4eb2du;
            hash ^= hash >> 15u;
            noisy[pixel] =
                errors[pixel] + vec2(0.01f * static_cast<float>(hash >> 8u) / 16777216.0f);
        }
    }
};

} // namespace

PassType benchVisibilityPass() {
    return PassType("bench.visibility", "Which triangle each pixel sees, as raster finds it")
        .in("scene", types::kScene, "what is drawn")
        .in("camera", types::kCamera, "where from")
        .out("gbuffer", types::kHits, "the triangles")
        .implementedBy<BenchVisibility>(Domain::kDevice);
}

PassType benchDepthOnlyPass() {
    return PassType("bench.depth_only", "One draw of all triangles, depth only")
        .in("scene", types::kScene, "what is drawn")
        .in("camera", types::kCamera, "where from")
        .out("depth", types::kDepth, "camera.near over view depth")
        .implementedBy<BenchDepthOnly>(Domain::kDevice);
}

PassType benchNoisePass() {
    return PassType("bench.noise", "Errors with a little noise, all different")
        .in("error", types::kError, "errors")
        .out("noisy", types::kError, "the same plus less than 0.01")
        .implementedBy<BenchNoise>(Domain::kHost);
}

} // namespace hone::cli

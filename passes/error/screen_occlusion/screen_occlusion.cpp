// SPDX-License-Identifier: Apache-2.0
//
// error.screen_occlusion: how much of its hemisphere a mirror's own object covers, by what the
// image shows.
//
// For objects that move or change too often for error.self_occlusion: no rays are traced. For each
// pixel that shows a mirror, points along cosine-weighted directions are looked up in the image; a
// direction is covered when the image shows the same instance in front of one of them, however thin
// it is there. Directions start from the triangle's plane, so convex objects are 0 up to the width
// of a pixel.
//
// Not conservative: what the image does not show (the object's far sides, what lies outside the
// frame or behind others) covers nothing. error.self_occlusion does not have that fault.
//
// in   gbuffer    Hits
//      scene      Scene
//      camera     Camera
// out  occlusion  PixelOcclusion
// params  rays   directions from each pixel (16)
//         steps  points along each (12), a pixel to the object's diameter away
//
//     "occlusion": { "type": "error.screen_occlusion", "in": { "gbuffer": "raster.gbuffer",
//                    "scene": "$scene", "camera": "$camera" } }
//
// Source: Amann, Chajdas, Westermann, Error Metrics for Smart Image Refinement, 2012, metric 5, by
// screen-space ambient occlusion as Mittring, Finding Next Gen: CryEngine 2, 2007.
#include "hone/passes/passes.h"

#include "hone_spirv/screen_occlusion.h"

#include "hone/core/device/kernel.glsl.h"

namespace hone {
namespace {

struct ScreenOcclusion : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/error/screen_occlusion/screen_occlusion.glsl.h"
};
constexpr Kernel kScreenOcclusion =
    makeKernel<ScreenOcclusion>("screen_occlusion", spirv::screen_occlusion);

/// The diagonal of the instance's box in the world.
float diagonal(const Scene& scene, const Instance& instance) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    Bounds bounds;
    for (const uvec3& corners :
         std::span(scene.triangles).subspan(mesh.first_triangle, mesh.triangle_count))
        for (int corner = 0; corner < 3; ++corner)
            bounds.add(instance.to_world * vec4(scene.positions[corners[corner]], 1.0f));
    return bounds.empty() ? 0.0f : glm::distance(bounds.low, bounds.high);
}

class ScreenOcclusionPass final : public RenderPass {
public:
    void execute(PassContext& context) override {
        const Scene& scene = *context.scene().scene;
        if (version_ != scene.version) {
            context.chosen->finish();
            const std::size_t bytes = std::max<std::size_t>(scene.instances.size(), 1) * 4;
            if (!object_size_ || object_size_.bytes() < bytes)
                object_size_ = context.memory->createBuffer(bytes, "object_size");
            for (std::size_t i = 0; i < scene.instances.size(); ++i) {
                const Instance& instance = scene.instances[i];
                const uint flags = scene.materials[scene.meshes[instance.mesh].material].flags;
                object_size_.as<float>()[i] =
                    (flags & kMaterialMirror) != 0 ? diagonal(scene, instance) : 0.0f;
            }
            version_ = scene.version;
        }
        const ScreenOcclusion::Params params{context.camera(), context.extent,
                                             context.param<uint>("rays"),
                                             context.param<uint>("steps")};
        const Argument extra[] = {{"object_size", object_size_.view()}};
        context.dispatch(kScreenOcclusion, params, context.extent.x * context.extent.y, extra);
    }

private:
    Buffer object_size_;
    std::uint64_t version_ = 0;
};

} // namespace

PassType screenOcclusionPass() {
    return PassType("error.screen_occlusion",
                    "How much of its hemisphere a mirror's own object covers, by what is seen")
        .in("gbuffer", types::kHits, "what the raster image sees")
        .in("scene", types::kScene, "the mirrors")
        .in("camera", types::kCamera, "of the raster image")
        .out("occlusion", types::kPixelOcclusion, "0 where there is no mirror; not conservative")
        .param("rays", 16u, {.min = 1, .max = 4096}, "directions from each pixel")
        .param("steps", 12u, {.min = 1, .max = 4096}, "points along each direction")
        .implementedBy<ScreenOcclusionPass>(Domain::kEither);
}

} // namespace hone

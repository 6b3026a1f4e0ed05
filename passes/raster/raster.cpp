// SPDX-License-Identifier: Apache-2.0
//
// raster: what the camera sees, rasterised and shaded.
//
// Draws which triangle is behind each pixel's centre, then recomputes the surface from the pixel's
// ray and shades it with the functions that the trace pass uses, in the same order. Shadows are
// hard ones from shadow maps, mirrors look up the environment map of their object's probe; every
// other pixel is the same bits as the traced one.
//
// Which triangle is behind a pixel can be asked of a trace backend, too: on machines whose Vulkan
// device is software, a tracer answers in less than half the time, and then silhouettes are those
// of the traced image to the last pixel.
//
// in   scene             Scene
//      camera            Camera
//      shadow_maps       ShadowMaps; not connected: everything is lit
//      environment_maps  EnvironmentMaps; not connected: mirrors reflect the sky
// out  gbuffer           Hits
//      depth             Depth
//      color             Radiance
// params  visibility  raster, rays: who says what each pixel sees (raster)
//         backend     who answers those rays
// counters  rays.visibility  with visibility rays
//
//     "raster": { "type": "raster", "in": { "scene": "$scene", "camera": "$camera",
//                 "shadow_maps": "shadow_map.maps", "environment_maps": "probe.maps" } }
//
// Source: Amann, Chajdas, Westermann, Error Metrics for Smart Image Refinement, 2012, the raster
// image; Burns and Hunt, The Visibility Buffer, 2013.
#include "hone/passes/passes.h"

#include "hone_spirv/raster_shade.h"

#include "hone/core/device/kernel.glsl.h"
#include "hone/passes/raster/cast_hits.h"
#include "hone/passes/shading/visibility.h"

namespace hone {
namespace {

struct RasterShade : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/raster/raster_shade.glsl.h"
};
constexpr Kernel kRasterShade = makeKernel<RasterShade>("raster_shade", spirv::raster_shade);

class Raster final : public RenderPass {
public:
    void execute(PassContext& context) override {
        const Camera& camera = context.camera();
        const BufferView gbuffer = context.out("gbuffer").buffer;
        if (context.params->choice("visibility") == 0) {
            visibility_.drawHits(context, {camera, context.extent, 0.0f}, {}, gbuffer);
        } else {
            context.chosen->finish();
            cast_.cast(context, camera,
                       context.tracers->get(context.param<std::string>("backend"), context.scene()),
                       gbuffer);
        }
        // Maps that nobody connected are maps of size 0.
        if (!no_maps_)
            no_maps_ = context.memory->createBuffer(kNoMapsBytes, "no_maps");
        Argument missing[2];
        std::size_t count = 0;
        for (const char* port : {"shadow_maps", "environment_maps"})
            if (!context.has(port))
                missing[count++] = {port, no_maps_.view()};
        const RasterShade::Params params{camera, context.extent};
        context.dispatch(kRasterShade, params, context.extent.x * context.extent.y,
                         std::span(missing).first(count));
    }

private:
    static constexpr std::size_t kNoMapsBytes = 32; ///< the header of shadow maps

    Visibility visibility_;
    CastHits cast_;
    Buffer no_maps_;
};

} // namespace

PassType rasterPass() {
    return PassType("raster", "Rasterises and shades what the camera sees")
        .in("scene", types::kScene, "what is drawn")
        .in("camera", types::kCamera, "where from")
        .inOptional("shadow_maps", types::kShadowMaps, "hard shadows; without, everything is lit")
        .inOptional("environment_maps", types::kEnvironmentMaps,
                    "what mirrors reflect; without, they reflect the sky")
        .out("gbuffer", types::kHits, "the triangle that each pixel's centre sees")
        .out("depth", types::kDepth, "view depth of that triangle along the pixel's ray")
        .out("color", types::kRadiance, "the raster image")
        .param("visibility", {"raster", "rays"},
               "raster: drawn by the Vulkan device; rays: asked of a trace backend, faster where "
               "that device is software")
        .backendParam("backend", "who answers the rays of visibility")
        .implementedBy<Raster>(Domain::kEither);
}

} // namespace hone

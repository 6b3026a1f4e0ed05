// SPDX-License-Identifier: Apache-2.0
//
// error.cab10: 1 where something reflects or is transparent.
//
// The rule of a renderer that rasterises everything and traces rays from reflecting and transparent
// surfaces alone. It gates, but orders nothing: all that it flags is equally wrong. For reflections
// it is metric 1 of error.reflection.
//
// The only transparency in hone's scenes is the alpha mask, whose holes raster and tracers answer
// alike: flagging what is left of a masked surface costs rays and repairs nothing. It is here
// because the source's rule says so; `transparent` false leaves it out. expect = bound = E.
//
// in   gbuffer  Hits
//      scene    Scene
//      camera   Camera
// out  error    Error, 0 or 1
// params  transparent  whether masked surfaces count (true)
//         epsilon      mirror weight up to which nothing reflects (1/512)
//
//     "cab10": { "type": "error.cab10", "in": { "gbuffer": "raster.gbuffer", "scene": "$scene",
//                "camera": "$camera" } }
//
// Source: Cabeleira, Combining Rasterization and Ray Tracing Techniques to Approximate Global
// Illumination in Real-Time, 2010, as Amann, Chajdas, Westermann, 2012, cite it.
#include "hone/passes/passes.h"

#include "hone_spirv/cab10.h"

#include "hone/core/device/kernel.glsl.h"

namespace hone {
namespace {

struct Cab10 : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/error/cab10/cab10.glsl.h"
};
constexpr Kernel kCab10 = makeKernel<Cab10>("cab10", spirv::cab10);

class Cab10Error final : public RenderPass {
public:
    void execute(PassContext& context) override {
        const Cab10::Params params{context.camera(), context.extent,
                                   context.param<bool>("transparent") ? 1u : 0u,
                                   context.param<float>("epsilon")};
        context.dispatch(kCab10, params, context.extent.x * context.extent.y);
    }
};

} // namespace

PassType cab10ErrorPass() {
    return PassType("error.cab10", "Where something reflects or is transparent")
        .in("gbuffer", types::kHits, "what the raster image sees")
        .in("scene", types::kScene, "materials")
        .in("camera", types::kCamera, "of the raster image")
        .out("error", types::kError, "1 where something reflects or is transparent, else 0")
        .param("transparent", true, "whether surfaces with an alpha mask count")
        .param("epsilon", 1.0f / 512.0f, {.min = 0, .max = 1},
               "mirror weight up to which a pixel counts as not reflecting")
        .implementedBy<Cab10Error>(Domain::kEither);
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
//
// depth_of_field: blurs a pinhole's image as a thin lens would, as far as one image can tell.
//
// Each pixel is spread over its circle of confusion; what arrives at a pixel is layered by depth
// (lens_blur.glsl.h), so that sharp objects neither bleed into a blurred background nor take its
// colour, and blurred ones spread over what lies behind. What the pinhole did not see, it cannot
// know: that is what error.dof predicts. Pixels that nothing is spread to keep their bits; with a
// pinhole camera that is all of them. Radiance above 1e30 is spread as 1e30, so that what is finite
// or infinite gives no NaN.
//
// in   image   Radiance
//      depth   Depth
//      camera  Camera: its lens and focus
// out  color   Radiance
// params  taps          most pixels that are looked at for one pixel, evenly spread; 0: all in
//                       reach. The time is that of pixels times taps
//         radius_limit  pixels that blur reaches at most
// counters  depth_of_field.limited  pixels whose blur the limit cut short
//
//     "lens": { "type": "depth_of_field", "in": { "image": "raster.color", "depth": "raster.depth",
//               "camera": "$camera" } }
//
// Source: Potmesil and Chakravarty, A Lens and Aperture Camera Model for Synthetic Image
// Generation, 1981; the post-process of Amann, Chajdas, Westermann 2012, section 3.2.
#include "hone/core/log.h"
#include "hone/passes/passes.h"

#include "hone_spirv/depth_of_field.h"

#include "hone/core/device/kernel.glsl.h"
#include "hone/passes/shading/lens_blur.h"
#include "hone/passes/shading/lens_blur_lanes.h"

namespace hone {
namespace {

struct DepthOfFieldKernel : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/depth_of_field/depth_of_field.glsl.h"
};
constexpr Kernel kDepthOfField =
    makeKernel<DepthOfFieldKernel>("depth_of_field", spirv::depth_of_field);

class DepthOfField final : public RenderPass {
public:
    void execute(PassContext& context) override {
        if (context.camera().lens_radius == 0.0f) {
            context.chosen->copy(context.in("image").buffer, context.out("color").buffer);
            return;
        }
        const DepthOfFieldKernel::Params params{context.extent, context.param<uint>("taps"),
                                                context.param<float>("radius_limit")};
        blur_.prepare(context, params.radius_limit);
        const auto [confusion, reach] = blur_.arguments();
        if (context.chosen == context.host)
            lanes_.blur(
                {context.extent, params.taps, params.radius_limit, confusion.buffer, reach.buffer},
                context.in("image").as<vec3>(), context.out("color").as<vec3>());
        else
            context.dispatch(kDepthOfField, params, context.extent.x * context.extent.y,
                             blur_.arguments());
        context.chosen->finish();
        const std::size_t limited = blur_.limitedPixels();
        context.counters->set("depth_of_field.limited", limited);
        if (limited > 0 && !has_warned_)
            logger().warn("{}: {} pixels are blurred less than the lens would; raise radius_limit, "
                          "which is {}",
                          context.pass_name, limited, params.radius_limit);
        has_warned_ |= limited > 0;
    }

private:
    LensBlur blur_;
    LensBlurLanes lanes_;
    bool has_warned_ = false;
};

} // namespace

PassType depthOfFieldPass() {
    return PassType("depth_of_field", "Blurs a pinhole's image as a thin lens would")
        .in("image", types::kRadiance, "sharp everywhere")
        .in("depth", types::kDepth, "of the same pixels")
        .in("camera", types::kCamera, "its lens and focus")
        .out("color", types::kRadiance, "with depth of field")
        .param("taps", kBlurTaps, {.min = 0, .max = 1u << 20},
               "most pixels that are looked at for one, evenly spread; 0: all in reach")
        .param("radius_limit", kBlurRadiusLimit, {.min = 0.5, .max = 512},
               "pixels that blur reaches at most")
        .implementedBy<DepthOfField>(Domain::kEither);
}

} // namespace hone

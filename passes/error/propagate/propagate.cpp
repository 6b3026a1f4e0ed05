// SPDX-License-Identifier: Apache-2.0
//
// error.propagate: what an image's errors become when it is blurred for depth of field.
//
// A wrong pixel spoils all that it is blurred into. The blur is a weighted mean whose weights
// depend on depth only, so |blur(raster) - blur(traced)| <= blur(|raster - traced|): errors and
// bounds are sent through the filter of depth_of_field, and the error of the filter itself, what it
// could not know, is added. Give both passes the same taps and radius_limit.
//
//     mode propagate  blur(error) + post
//          max        max(error, post)               pixel by pixel, as in the source
//          sum        error + post                   likewise
//          noisy_or   1 - (1 - error) (1 - post)     likewise, both cut at 1
//
// NaN and infinity count as 1, negative values as 0; results are finite.
//
// in   error   Error of the image before it is blurred
//      depth   Depth
//      camera  Camera: its lens and focus
//      post    Error (optional): of the blur, from error.dof
// out  error   Error of the blurred image
// params  mode          propagate, max, sum, noisy_or
//         taps          that of depth_of_field
//         radius_limit  that of depth_of_field
//
//     "propagate": { "type": "error.propagate", "in": { "error": "combine.error",
//                    "depth": "raster.depth", "camera": "$camera", "post": "dof.error" } }
//
// Source: Amann, Chajdas, Westermann 2012, section 3.3 (post-process errors are composed with those
// of shading); propagate is hone's own.
#include "hone/passes/passes.h"

#include "hone_spirv/blur_errors.h"
#include "hone_spirv/propagate.h"
#include "hone_spirv/wrong_near.h"
#include "hone_spirv/wrong_tiles.h"

#include "hone/core/device/kernel.glsl.h"
#include "hone/passes/shading/lens_blur.h"
#include "hone/passes/shading/lens_blur_lanes.h"

namespace hone {
namespace {

struct PropagateKernel : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/error/propagate/propagate.glsl.h"
};
struct BlurErrors : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/error/propagate/blur_errors.glsl.h"
};
struct WrongTiles : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/error/propagate/wrong_tiles.glsl.h"
};
struct WrongNear : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/error/propagate/wrong_near.glsl.h"
};
constexpr Kernel kPropagate = makeKernel<PropagateKernel>("propagate", spirv::propagate);
constexpr Kernel kBlurErrors = makeKernel<BlurErrors>("blur_errors", spirv::blur_errors);
constexpr Kernel kWrongTiles = makeKernel<WrongTiles>("wrong_tiles", spirv::wrong_tiles);
constexpr Kernel kWrongNear = makeKernel<WrongNear>("wrong_near", spirv::wrong_near);

class PropagateError final : public RenderPass {
public:
    void execute(PassContext& context) override {
        const bool is_blurred =
            context.params->choice("mode") == 0 && context.camera().lens_radius > 0;
        BufferView error = context.in("error").buffer;
        if (is_blurred) {
            blur(context, error);
            error = blurred_.view();
        }
        const bool has_post = context.has("post");
        const Argument extra[] = {{"shading_error", error},
                                  {"propagated", context.out("error").buffer},
                                  {"post", has_post ? context.in("post").buffer : error}};
        const PropagateKernel::Params params{.mode = context.params->choice("mode"),
                                             .has_post = has_post ? 1u : 0u};
        context.dispatch(kPropagate, params, context.extent.x * context.extent.y, extra);
    }

private:
    /// Blurs the errors as depth_of_field blurs an image.
    void blur(PassContext& context, BufferView error) {
        const uvec2 extent = context.extent;
        const uvec2 tiles = LensBlur::tiles(extent);
        const uint pixels = extent.x * extent.y, tile_count = tiles.x * tiles.y;
        const BlurErrors::Params params{extent, context.param<uint>("taps"),
                                        context.param<float>("radius_limit")};
        reserve(*context.memory, pixels, tile_count);
        blur_.prepare(context, params.radius_limit);
        const auto [confusion, reach] = blur_.arguments();
        const Argument extra[] = {confusion,
                                  reach,
                                  {"wrong_tiles", wrong_tiles_.view()},
                                  {"wrong_near", wrong_near_.view()},
                                  {"shading_error", error},
                                  {"clean", clean_.view()},
                                  {"blurred", blurred_.view()}};
        context.dispatch(kWrongTiles, WrongTiles::Params{extent, tiles, LensBlur::kTile},
                         tile_count, extra);
        context.dispatch(kWrongNear, WrongNear::Params{tiles, LensBlur::kTile}, tile_count, extra);
        if (context.chosen == context.host)
            lanes_.blur({extent, params.taps, params.radius_limit, confusion.buffer, reach.buffer,
                         wrong_near_.as<uint>().first(tile_count)},
                        clean_.as<vec2>().first(pixels), blurred_.as<vec2>().first(pixels));
        else
            context.dispatch(kBlurErrors, params, pixels, extra);
    }

    void reserve(Device& memory, std::size_t pixels, std::size_t tile_count) {
        if (clean_.bytes() < pixels * sizeof(vec2)) {
            clean_ = memory.createBuffer(pixels * sizeof(vec2), "clean");
            blurred_ = memory.createBuffer(pixels * sizeof(vec2), "blurred");
        }
        if (wrong_near_.bytes() < tile_count * sizeof(uint)) {
            wrong_tiles_ = memory.createBuffer(tile_count * sizeof(uint), "wrong_tiles");
            wrong_near_ = memory.createBuffer(tile_count * sizeof(uint), "wrong_near");
        }
    }

    LensBlur blur_;
    LensBlurLanes lanes_;
    Buffer clean_, blurred_, wrong_tiles_, wrong_near_;
};

} // namespace

PassType propagateErrorPass() {
    return PassType("error.propagate", "What errors become when depth of field blurs the image")
        .in("error", types::kError, "of the image before it is blurred")
        .in("depth", types::kDepth, "of the same pixels")
        .in("camera", types::kCamera, "its lens and focus")
        .inOptional("post", types::kError, "of the blur itself")
        .out("error", types::kError, "of the blurred image")
        .param("mode", {"propagate", "max", "sum", "noisy_or"},
               "through the blur, or pixel by pixel as in the paper")
        .param("taps", kBlurTaps, {.min = 0, .max = 1u << 20}, "that of depth_of_field")
        .param("radius_limit", kBlurRadiusLimit, {.min = 0.5, .max = 512}, "that of depth_of_field")
        .promises(Promise::kMonotone)
        .implementedBy<PropagateError>(Domain::kEither);
}

} // namespace hone

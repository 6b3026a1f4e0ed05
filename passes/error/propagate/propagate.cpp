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

#include "hone_spirv/propagate.h"
#include "hone_spirv/wrong_near.h"
#include "hone_spirv/wrong_tiles.h"

#include "hone/core/device/kernel.glsl.h"
#include "hone/passes/shading/lens_blur.h"

namespace hone {
namespace {

struct PropagateKernel : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/error/propagate/propagate.glsl.h"
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
constexpr Kernel kWrongTiles = makeKernel<WrongTiles>("wrong_tiles", spirv::wrong_tiles);
constexpr Kernel kWrongNear = makeKernel<WrongNear>("wrong_near", spirv::wrong_near);

class PropagateError final : public RenderPass {
public:
    void execute(PassContext& context) override {
        const BufferView error = context.in("error").buffer;
        const bool has_post = context.has("post");
        const PropagateKernel::Params params{.extent = context.extent,
                                             .taps = context.param<uint>("taps"),
                                             .radius_limit = context.param<float>("radius_limit"),
                                             .mode = context.params->choice("mode"),
                                             .has_post = has_post ? 1u : 0u};
        blur_.prepare(context, params.radius_limit);
        const uvec2 tiles = LensBlur::tiles(context.extent);
        const uint tile_count = tiles.x * tiles.y;
        if (wrong_near_.bytes() < tile_count * sizeof(uint)) {
            wrong_tiles_ = context.memory->createBuffer(tile_count * sizeof(uint), "wrong_tiles");
            wrong_near_ = context.memory->createBuffer(tile_count * sizeof(uint), "wrong_near");
        }
        const auto [confusion, reach] = blur_.arguments();
        const Argument extra[] = {confusion,
                                  reach,
                                  {"wrong_tiles", wrong_tiles_.view()},
                                  {"wrong_near", wrong_near_.view()},
                                  {"shading_error", error},
                                  {"propagated", context.out("error").buffer},
                                  {"post", has_post ? context.in("post").buffer : error}};
        context.dispatch(kWrongTiles, WrongTiles::Params{context.extent, tiles, LensBlur::kTile},
                         tile_count, extra);
        context.dispatch(kWrongNear, WrongNear::Params{tiles, LensBlur::kTile}, tile_count, extra);
        context.dispatch(kPropagate, params, context.extent.x * context.extent.y, extra);
    }

private:
    LensBlur blur_;
    Buffer wrong_tiles_, wrong_near_;
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

// SPDX-License-Identifier: Apache-2.0
//
// error.dof: where an image that was blurred afterwards differs from one seen through a lens.
//
// A lens sees around edges. Wherever depth jumps, the blurred image had to make up what the pinhole
// did not see: every pixel at a jump is grown by the radius of its circle of confusion. The image's
// border is such a jump, too, for what lies beyond it spreads in. Elsewhere one surface fills the
// circle, and its blur is known, but for what the pixels' centres miss of it.
//
//     expect mask    1 where a jump reaches
//            layers  an estimate everywhere. depth_of_field sees three layers (in front of the
//                    pixel's surface, that surface, behind it). What the pinhole did not see of
//                    one counts as much as it covers, by the deviation of what was seen of it;
//                    edges and textures count by how little the blur averages over pixels' centres
//
// A mask finds, but gives no order; layers do both. bound: 1, or expect where that is greater,
// where a jump reaches or layers expect more than `least`; else 0.
//
// in   depth   Depth
//      camera  Camera: its lens and focus; a pinhole's error is 0
//      image   Radiance (optional): what depth_of_field blurs; layers look at it
// out  error   Error
// params  expect    mask, layers
//         detector  coc_jump: blur of neighbours differs by more than `jump` pixels, and not only
//                   as it does beside them (slanted planes are no jumps); sobel_z: the source's
//                   Sobel filter of depth, with `slope`
//         scope     coc_jump only. blur: jumps that change blur; all: also jumps of depth by more
//                   than `slope` where both sides are equally blurred
//         radius    c is the diameter of the circle of confusion of the pixel, c_max the greater of
//                   c and that of infinity. paper: c_max / 2; paper_diameter: c_max, the source's
//                   words taken literally; tight: the greatest c / 2 of the 3 x 3 pixels around;
//                   own: c / 2
//         shape     disc, or square as in the source
//         border    the outermost pixels count as jumps with the greatest radius of all (true)
//         jump      pixels of blur (0.5)
//         slope     of depth, as a part of it (0.02)
//         radius_limit  that of depth_of_field: pixels; errors farther away are missed (64)
//         space     layers: what errors are measured in. display: sRGB, linear: radiance
//         least     layers: less is no error where no jump reaches (1/512)
//         taps      layers: that of depth_of_field
// counters  error.dof.limited  jumps whose radius the limit cut
//
//     "dof": { "type": "error.dof", "in": { "depth": "raster.depth", "camera": "$camera",
//              "image": "raster.color" }, "params": { "expect": "layers" } }
//
// Source: Amann, Chajdas, Westermann 2012, section 3.2: discontinuities of depth by a Sobel filter,
// each grown by the greatest circle of confusion behind it. coc_jump, the border, tight radii,
// discs and layers are hone's own.
#include "hone/core/error.h"
#include "hone/core/log.h"
#include "hone/passes/error/dof/dilate.h"
#include "hone/passes/passes.h"
#include "hone/passes/shading/lens_blur.h"

#include "hone_spirv/dof_layers.h"

#include "hone/core/device/kernel.glsl.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace hone {
namespace {

struct DofLayers : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/error/dof/dof_layers.glsl.h"
};
constexpr Kernel kDofLayers = makeKernel<DofLayers>("dof_layers", spirv::dof_layers);

struct Library : HostKernel {
    Library() : HostKernel(Arguments{}, nullptr) {}
#include "hone/core/scene/camera.glsl.h"
};

/// The order of the parameters' choices.
enum Detector : uint { kCocJump, kSobelZ };
enum Scope : uint { kBlur, kAll };
enum Radius : uint { kPaper, kPaperDiameter, kTight, kOwn };
enum DilationShape : uint { kDisc, kSquare };
enum Expect : uint { kMask, kLayers };

/// Values by pixel, asked for by column and row; outside they are those of the nearest inside.
struct Plane {
    uvec2 extent;
    std::span<const float> values;

    [[nodiscard]] bool has(int x, int y) const {
        return x >= 0 && y >= 0 && x < static_cast<int>(extent.x) && y < static_cast<int>(extent.y);
    }
    [[nodiscard]] float at(int x, int y) const {
        const int column = std::clamp(x, 0, static_cast<int>(extent.x) - 1);
        const int row = std::clamp(y, 0, static_cast<int>(extent.y) - 1);
        return values[static_cast<std::size_t>(row) * extent.x + static_cast<std::size_t>(column)];
    }
};

/// Calls visit(x, y, index) for every pixel, rows on all cores.
template <class Visit> void forEachPixel(uvec2 extent, Visit visit) {
    tbb::parallel_for(0, static_cast<int>(extent.y), [&](int y) {
        for (int x = 0; x < static_cast<int>(extent.x); ++x)
            visit(x, y, static_cast<std::size_t>(y) * extent.x + static_cast<std::size_t>(x));
    });
}

/// Whether a value steps by more than `jump` from (x, y) to its neighbour at (dx, dy), and that is
/// not how it changes on one of the two sides anyway.
bool isStep(const Plane& plane, int x, int y, int dx, int dy, float jump) {
    if (!plane.has(x + dx, y + dy))
        return false;
    const float here = plane.at(x, y), next = plane.at(x + dx, y + dy);
    const float step = next - here;
    if (!(std::abs(step) > jump))
        return false;
    const bool bends_here = plane.has(x - dx, y - dy) &&
                            std::abs(step - (here - plane.at(x - dx, y - dy))) > 0.5f * jump;
    const bool bends_next = plane.has(x + 2 * dx, y + 2 * dy) &&
                            std::abs(plane.at(x + 2 * dx, y + 2 * dy) - next - step) > 0.5f * jump;
    return bends_here || bends_next;
}

bool isStepToAny(const Plane& plane, int x, int y, float jump) {
    return isStep(plane, x, y, 1, 0, jump) || isStep(plane, x, y, -1, 0, jump) ||
           isStep(plane, x, y, 0, 1, jump) || isStep(plane, x, y, 0, -1, jump);
}

/// Sobel's filter over 3 x 3 view depths, divided by 8: 1/2 beside a step of 1. Infinite where some
/// of them see nothing and others do.
float sobel(const Plane& depth, int x, int y) {
    int nothing = 0;
    for (int i = 0; i < 9; ++i)
        nothing += depth.at(x + i % 3 - 1, y + i / 3 - 1) == 0.0f ? 1 : 0;
    if (nothing > 0)
        return nothing == 9 ? 0.0f : std::numeric_limits<float>::infinity();
    const auto z = [&](int dx, int dy) { return depth.at(x + dx, y + dy); };
    const float gx = z(1, -1) - z(-1, -1) + 2 * (z(1, 0) - z(-1, 0)) + z(1, 1) - z(-1, 1);
    const float gy = z(-1, 1) - z(-1, -1) + 2 * (z(0, 1) - z(0, -1)) + z(1, 1) - z(1, -1);
    return std::sqrt(gx * gx + gy * gy) / 8;
}

class DofError final : public RenderPass {
public:
    void execute(PassContext& context) override {
        const std::span<vec2> error = context.out("error").as<vec2>();
        context.counters->set("error.dof.limited", 0);
        if (context.camera().lens_radius == 0.0f) {
            std::ranges::fill(error, vec2(0));
            return;
        }
        extent_ = context.extent;
        findConfusion(context);
        findRadii(context);
        grown_.resize(error.size());
        if (context.params->choice("shape") == kSquare)
            dilation_.squares(extent_, radii_, grown_);
        else
            dilation_.discs(extent_, radii_, grown_);
        if (context.params->choice("expect") == kLayers)
            estimate(context);
        else
            forEachPixel(extent_, [&](int, int, std::size_t i) {
                error[i] = vec2(static_cast<float>(grown_[i]));
            });
    }

private:
    /// Gives flagged pixels the error that their surroundings let expect.
    void estimate(PassContext& context) {
        if (!context.has("image"))
            throw GraphError(std::string(context.pass_name) +
                             ": \"expect\": \"layers\" looks at \"image\", which nothing is "
                             "connected to; connect what depth_of_field blurs");
        if (flagged_.bytes() < grown_.size() * sizeof(uint))
            flagged_ = context.memory->createBuffer(grown_.size() * sizeof(uint), "flagged");
        std::ranges::copy(grown_, flagged_.as<uint>().begin());
        constexpr uint kEstimateTaps = 121; // an estimate needs fewer than an image
        const uint taps = context.param<uint>("taps");
        const DofLayers::Params params{.extent = extent_,
                                       .taps = taps,
                                       .estimate_taps = taps == 0 ? kEstimateTaps
                                                                  : std::min(taps, kEstimateTaps),
                                       .radius_limit = context.param<float>("radius_limit"),
                                       .space = context.params->choice("space"),
                                       .least = context.param<float>("least")};
        blur_.prepare(context, params.radius_limit);
        const auto [confusion, reach] = blur_.arguments();
        const Argument extra[] = {confusion, reach, {"flagged", flagged_.view()}};
        context.dispatch(kDofLayers, params, extent_.x * extent_.y, extra);
    }

    /// Signed diameters, and inverse depths: linear across the image of a plane, as those are.
    void findConfusion(const PassContext& context) {
        const std::span<const float> depth = context.in("depth").as<float>();
        confusion_.resize(depth.size());
        inverse_depth_.resize(depth.size());
        Library library;
        const Camera camera = context.camera();
        forEachPixel(extent_, [&](int, int, std::size_t i) {
            confusion_[i] = library.circleOfConfusion(camera, extent_, depth[i]);
            inverse_depth_[i] = depth[i] > 0 ? 1 / depth[i] : 0.0f;
        });
        infinity_ = library.circleOfConfusion(camera, extent_, 0);
    }

    /// Jumps get their radius in whole pixels, other pixels -1.
    void findRadii(const PassContext& context) {
        const bool has_border = context.param<bool>("border");
        const auto limit = static_cast<int>(context.param<float>("radius_limit"));
        const ivec2 last = ivec2(extent_) - 1;
        const Edges edges{.depth = {extent_, context.in("depth").as<float>()},
                          .confusion = {extent_, confusion_},
                          .inverse_depth = {extent_, inverse_depth_},
                          .is_sobel = context.params->choice("detector") == kSobelZ,
                          .finds_all = context.params->choice("scope") == kAll,
                          .jump = context.param<float>("jump"),
                          .slope = context.param<float>("slope")};
        const auto mode = static_cast<Radius>(context.params->choice("radius"));
        radii_.resize(confusion_.size());
        const float greatest = has_border ? greatestRadius(mode) : 0.0f;
        std::atomic<std::size_t> limited = 0;
        forEachPixel(extent_, [&](int x, int y, std::size_t i) {
            const bool is_border = has_border && (x == 0 || y == 0 || x == last.x || y == last.y);
            radii_[i] = -1;
            if (!is_border && !edges.has(x, y, i))
                return;
            const float radius = std::ceil(is_border ? greatest : radiusAt(mode, x, y));
            if (radius > static_cast<float>(limit))
                limited.fetch_add(1, std::memory_order_relaxed);
            radii_[i] = std::min(static_cast<int>(std::min(radius, 65536.0f)), limit);
        });
        context.counters->set("error.dof.limited", limited);
        if (limited > 0 && !has_warned_)
            logger().warn("{}: {} jumps of depth are blurred further than radius_limit, {}; errors "
                          "there are missed unless it is raised",
                          context.pass_name, limited.load(), limit);
        has_warned_ |= limited > 0;
    }

    struct Edges {
        Plane depth, confusion, inverse_depth;
        bool is_sobel, finds_all;
        float jump, slope;

        [[nodiscard]] bool has(int x, int y, std::size_t i) const {
            if (is_sobel)
                return sobel(depth, x, y) > slope * depth.values[i];
            return isStepToAny(confusion, x, y, jump) || (finds_all && isDepthStep(x, y, i));
        }
        /// A step by a part of the nearer depth.
        [[nodiscard]] bool isDepthStep(int x, int y, std::size_t i) const {
            const auto steps = [&](int dx, int dy) {
                const float nearer =
                    std::max(inverse_depth.values[i], inverse_depth.at(x + dx, y + dy));
                return isStep(inverse_depth, x, y, dx, dy, slope * nearer);
            };
            return steps(1, 0) || steps(-1, 0) || steps(0, 1) || steps(0, -1);
        }
    };

    /// In pixels.
    [[nodiscard]] float radiusAt(Radius mode, int x, int y) const {
        const Plane confusion{extent_, confusion_};
        const float own = std::abs(confusion.at(x, y));
        switch (mode) {
        case kPaper:
            return 0.5f * std::max(own, infinity_);
        case kPaperDiameter:
            return std::max(own, infinity_);
        case kTight: {
            float greatest = 0;
            for (int i = 0; i < 9; ++i)
                greatest = std::max(greatest, std::abs(confusion.at(x + i % 3 - 1, y + i / 3 - 1)));
            return 0.5f * greatest;
        }
        case kOwn:
            break;
        }
        return 0.5f * own;
    }
    /// Of all pixels.
    [[nodiscard]] float greatestRadius(Radius mode) const {
        float greatest = mode == kPaper || mode == kPaperDiameter ? infinity_ : 0.0f;
        for (const float diameter : confusion_)
            greatest = std::max(greatest, std::abs(diameter));
        return mode == kPaperDiameter ? greatest : 0.5f * greatest;
    }

    uvec2 extent_{0, 0};
    float infinity_ = 0; ///< diameter of what is infinitely far
    std::vector<float> confusion_, inverse_depth_;
    std::vector<int> radii_;
    std::vector<std::uint8_t> grown_;
    Dilation dilation_;
    LensBlur blur_;
    Buffer flagged_;
    bool has_warned_ = false;
};

} // namespace

PassType dofErrorPass() {
    return PassType("error.dof", "Where blurring afterwards differs from looking through a lens")
        .in("depth", types::kDepth, "of the image that is blurred")
        .in("camera", types::kCamera, "its lens and focus")
        .inOptional("image", types::kRadiance, "that is blurred; for layers")
        .out("error", types::kError, "not 0 where a lens may see around an edge")
        .param("expect", {"mask", "layers"},
               "1 wherever an error may be, or what the pixels around let expect")
        .param("detector", {"coc_jump", "sobel_z"}, "what a jump of depth is: of blur or of depth")
        .param("scope", {"blur", "all"},
               "of coc_jump; all: jumps between equally blurred surfaces, too")
        .param("radius", {"paper", "paper_diameter", "tight", "own"},
               "how far a jump's error reaches")
        .param("shape", {"disc", "square"}, "what a jump grows to; square: as in the paper")
        .param("border", true, "whether the image's border is a jump")
        .param("jump", 0.5f, {.min = 0, .max = 64}, "pixels of blur that are a jump")
        .param("slope", 0.02f, {.min = 0, .max = 10}, "part of depth that is a jump")
        .param("radius_limit", kBlurRadiusLimit, {.min = 0.5, .max = 512},
               "pixels that an error reaches at most")
        .param("space", {"display", "linear"}, "of layers: what the error is measured in")
        .param("least", 1.0f / 512, {.min = 0, .max = {}},
               "of layers: what is less is no error outside the mask")
        .param("taps", kBlurTaps, {.min = 0, .max = 1u << 20}, "of layers: that of depth_of_field")
        .implementedBy<DofError>(Domain::kHost);
}

} // namespace hone

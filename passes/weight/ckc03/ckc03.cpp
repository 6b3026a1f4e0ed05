// SPDX-License-Identifier: Apache-2.0
//
// weight.ckc03: errors as someone sees them who looks for certain objects.
//
//     out expect = S * max(E / N - 1, 0)
//
// N is the difference that is just noticed: of weight.ypg01's tolerance where it is connected, else
// the parameter `noticeable`. S says how well the pixel is seen by eyes that follow the task's
// objects: 1 on them, and falling with the visual angle e to the nearest of their pixels as acuity
// does, 1 / (1 + e / falloff). With falloff 0 nothing else is looked at. Where no pixel shows an
// object of the task, S is 1 everywhere: the task says nothing about such an image.
//
// The task's objects are the scene's, "task_objects" of a scene file.
//
// S = 0 takes a pixel out of the order, not out of what is refined in the end: bound passes as it
// is. Errors that are not finite count as 1, negative ones as 0.
//
// in   error      Error
// in   gbuffer    Hits
// in   scene      Scene
// in   tolerance  Tolerance (optional): of weight.ypg01. E must not have been divided by it yet
// out  error      Error
// params  falloff_degrees    where acuity is half of that at the centre of gaze (2.3)
//         pixels_per_degree  of visual angle (40: 96 dpi from 60 cm)
//         noticeable         N without a tolerance (0.01)
//
//     "task": { "type": "weight.ckc03", "in": { "error": "combine.error",
//               "gbuffer": "raster.gbuffer", "scene": "$scene" } }
//
// Source: Cater, Chalmers, Ward, Detail to Attention: Exploiting Visual Tasks for Selective
// Rendering, 2003; the formula as we recall it. The source paints a ramp around the objects; its
// fall as 1 / (1 + e / 2.3) is our reading.
#include "hone/passes/passes.h"

#include "hone/core/device/kernel.glsl.h"
#include "hone/core/trace/ray.glsl.h"
#include "hone/passes/weight/ckc03/task_distance.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hone {
namespace {

struct Library : HostKernel {
    Library() : HostKernel(Arguments{}, nullptr) {}
#include "hone/passes/shading/sanitised.glsl.h"
};

class Ckc03 final : public RenderPass {
public:
    void execute(PassContext& context) override {
        const std::span<const Hit> hits = context.in("gbuffer").as<Hit>();
        const Scene& scene = *context.scene().scene;
        is_looked_for_.assign(scene.instances.size(), false);
        for (uint instance : scene.task_objects)
            is_looked_for_[instance] = true;
        distances_.resize(hits.size());
        for (std::size_t pixel = 0; pixel < hits.size(); ++pixel) {
            const uint instance = hits[pixel].instance;
            distances_[pixel] = instance != kNone && is_looked_for_[instance] ? 0.0f : 1.0f;
        }
        squaredDistances(context.extent, distances_);

        const std::span<const vec2> in = context.in("error").as<vec2>();
        const std::span<vec2> out = context.out("error").as<vec2>();
        const std::span<const float> tolerance =
            context.has("tolerance") ? context.in("tolerance").as<float>() : std::span<float>();
        Library library;
        const float noticeable = context.param<float>("noticeable");
        const float pixels_per_degree = context.param<float>("pixels_per_degree");
        const float falloff = context.param<float>("falloff_degrees");
        tbb::parallel_for(std::size_t{0}, in.size(), [&](std::size_t pixel) {
            const float acuity =
                acuityAt(std::sqrt(distances_[pixel]) / pixels_per_degree, falloff);
            const bool is_known = !tolerance.empty() && tolerance[pixel] > 0;
            const float least = is_known ? tolerance[pixel] : noticeable;
            const float noticed = std::min(library.sanitised(in[pixel].x) / least - 1.0f,
                                           std::numeric_limits<float>::max());
            out[pixel] = {acuity * std::max(noticed, 0.0f), library.sanitised(in[pixel].y)};
        });
    }

private:
    /// `degrees`: infinite where the image shows no object of the task.
    static float acuityAt(float degrees, float falloff) {
        if (degrees == 0.0f || std::isinf(degrees))
            return 1.0f;
        return falloff > 0.0f ? 1.0f / (1.0f + degrees / falloff) : 0.0f;
    }

    std::vector<bool> is_looked_for_; ///< by instance
    std::vector<float> distances_;
};

} // namespace

PassType ckc03WeightPass() {
    return PassType("weight.ckc03", "Errors as someone sees them who looks for certain objects")
        .in("error", types::kError, "as metrics give it")
        .in("gbuffer", types::kHits, "where the objects are")
        .in("scene", types::kScene, "which they are")
        .inOptional("tolerance", types::kTolerance, "from weight.ypg01; none: noticeable")
        .out("error", types::kError, "expect by how well it is seen; bound as it came")
        .param("falloff_degrees", 2.3f, {.min = 0, .max = 180},
               "visual angle at which acuity is half; 0: only the objects are seen")
        .param("pixels_per_degree", 40.0f, {.min = 1, .max = 1000},
               "pixels of a degree of visual angle")
        .param("noticeable", 0.01f, {.min = 1e-6, .max = {}},
               "error that is just noticed where no tolerance is connected")
        .promises(Promise::kMonotone)
        .implementedBy<Ckc03>(Domain::kHost);
}

} // namespace hone

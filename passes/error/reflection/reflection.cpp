// SPDX-License-Identifier: Apache-2.0
//
// error.reflection: how wrong a mirror's environment lookup may be.
//
// The raster image looks reflections up in a cube map taken at one point, the probe. Five measures
// of how wrong that is at a pixel whose mirror weight exceeds epsilon; other pixels are 0. i: unit
// direction from the eye, n: normal, r: reflected direction, p: surface, c: probe.
//
//     1  1 wherever a mirror reflects
//     2  |p - c| / M; 1 where the object has no probe
//     3  (1 - -i.r) / 2 = sin^2 of the angle of incidence    as printed: max(0, -i.r)
//     4  1 - -i.n                                             as printed: -i.n
//     5  k_o, the occlusion of the surface by its own object
//
// As the paper prints 3 and 4, they are greatest where the lookup is exact; the corrected form is
// the default, in which 3 and 4 order pixels alike, for both grow with the angle of incidence.
// expect = bound = E, but only 1 is never below the real error: 2 to 5 are 0 at pixels that
// may be wrong.
//
// The paper leaves M open. Readings, by max_distance:
//     object   greatest |v - c| of the object's vertices: 2 is at most 1, and reaches it
//     visible  greatest |p - c| among this image's pixels of the object: changes with the view
//     scene    half the diagonal of the scene's box
//     probe    mean distance of what the probe sees, the sky left out: a lookup's angle is wrong by
//              about |p - c| / distance. 2 is 0 where the probe sees the sky only
//
// in   gbuffer           Hits
//      scene             Scene
//      camera            Camera
//      occlusion         Occlusion, of error.self_occlusion  } metric 5 needs
//      screen_occlusion  PixelOcclusion                      } one of them
//      environment_maps  EnvironmentMaps; max_distance probe needs it
// out  error             Error, in [0,1]
// params  metric        1 to 5 (4)
//         orientation   corrected; as_printed: of metrics 3 and 4; accessibility: corrected, and
//                       metric 5's input is 1 where nothing covers, as engines often store it
//         max_distance  object, visible, scene, probe (object)
//         covered       metric 5: share: k_o; any: 1 where k_o > 0, so that a thin fin counts that
//                       covers little but may be what the mirror shows (share)
//         epsilon       mirror weight up to which nothing reflects (1/512)
//
//     "reflection": { "type": "error.reflection", "params": { "metric": 4 },
//                     "in": { "gbuffer": "raster.gbuffer", "scene": "$scene",
//                             "camera": "$camera" } }
//
// Source: Amann, Chajdas, Westermann, Error Metrics for Smart Image Refinement, 2012, section on
// reflections. Metric 1 is Cabeleira, 2010.
#include "hone/passes/passes.h"

#include "hone_spirv/reflection.h"

#include "hone/core/device/kernel.glsl.h"
#include "hone/core/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hone {
namespace {

struct Reflection : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/error/reflection/reflection.glsl.h"
};
constexpr Kernel kReflection = makeKernel<Reflection>("reflection", spirv::reflection);

/// What M is.
enum class Reach : uint { kObject, kVisible, kScene, kProbe };

/// The greatest distance from the instance's probe to its vertices: the distance is convex, so no
/// point of a triangle is farther than a corner.
float greatestDistance(const Scene& scene, const Instance& instance) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    const vec3 probe = scene.probes[instance.probe].position;
    float greatest = 0;
    for (const uvec3& corners :
         std::span(scene.triangles).subspan(mesh.first_triangle, mesh.triangle_count))
        for (int corner = 0; corner < 3; ++corner) {
            const vec3 world = instance.to_world * vec4(scene.positions[corners[corner]], 1.0f);
            greatest = std::max(greatest, glm::distance(world, probe));
        }
    return greatest;
}

/// The mean distance of what a probe sees, by solid angle; infinite if it sees nothing. `maps` as
/// passes/shading/environment_map.glsl.h says.
float meanDistance(std::span<const vec4> maps, uint probe) {
    constexpr float kNothing = 1e30f;
    const auto size = static_cast<std::size_t>(maps[0].x);
    const auto texels = maps.subspan(1 + probe * 6 * size * size, 6 * size * size);
    double sum = 0, weights = 0;
    for (std::size_t i = 0; i < texels.size(); ++i) {
        if (!(texels[i].w < kNothing))
            continue;
        // A texel of a cube fills an angle in proportion to its distance to the power of -3.
        const double x =
            (2.0 * static_cast<double>(i % size) + 1.0) / static_cast<double>(size) - 1;
        const double y =
            (2.0 * static_cast<double>(i / size % size) + 1.0) / static_cast<double>(size) - 1;
        const double weight = std::pow(1 + x * x + y * y, -1.5);
        sum += weight * static_cast<double>(texels[i].w);
        weights += weight;
    }
    return weights > 0 ? static_cast<float>(sum / weights) : std::numeric_limits<float>::infinity();
}

class ReflectionError final : public RenderPass {
public:
    void execute(PassContext& context) override {
        const Scene& scene = *context.scene().scene;
        const uint metric = context.param<uint>("metric");
        const auto reach = static_cast<Reach>(context.params->choice("max_distance"));
        if (metric == 5 && !context.has("occlusion") && !context.has("screen_occlusion"))
            fail(context, "metric 5 needs the input \"occlusion\" or \"screen_occlusion\"; connect "
                          "the output of a pass error.self_occlusion or error.screen_occlusion");
        if (metric == 2 && reach == Reach::kProbe && !context.has("environment_maps"))
            fail(context, "max_distance probe needs the input \"environment_maps\"; connect the "
                          "output of a pass environment_probe");
        reserve(context, scene);

        Reflection::Params params{};
        params.camera = context.camera();
        params.extent = context.extent;
        params.metric = metric;
        params.orientation = context.params->choice("orientation");
        params.covered = context.params->choice("covered");
        params.has_screen = context.has("screen_occlusion") ? 1u : 0u;
        params.epsilon = context.param<float>("epsilon");
        if (metric == 2) {
            if (reach == Reach::kVisible)
                findVisible(context, params);
            else
                findReach(context, scene, reach);
        }
        dispatch(context, params);
    }

private:
    [[noreturn]] static void fail(const PassContext& context, const std::string& what) {
        throw GraphError("pass \"" + std::string(context.pass_name) + "\": " + what);
    }

    void reserve(PassContext& context, const Scene& scene) {
        const std::size_t bytes = std::max<std::size_t>(scene.instances.size(), 1) * sizeof(float);
        if (max_distance_ && max_distance_.bytes() >= bytes)
            return;
        context.chosen->finish();
        max_distance_ = context.memory->createBuffer(bytes, "max_distance");
        scene_version_ = 0;
    }

    void dispatch(PassContext& context, const Reflection::Params& params) {
        // A port that no edge feeds is never read, but must be bound to something.
        Argument extra[3] = {{"max_distance", max_distance_.view()}};
        std::size_t extras = 1;
        for (const char* optional : {"occlusion", "screen_occlusion"})
            if (!context.has(optional))
                extra[extras++] = {optional, max_distance_.view()};
        context.dispatch(kReflection, params, context.extent.x * context.extent.y,
                         std::span(extra).first(extras));
    }

    /// By instance, from the scene and its probes: changes with them only.
    void findReach(PassContext& context, const Scene& scene, Reach reach) {
        const std::uint64_t maps_version =
            reach == Reach::kProbe ? context.in("environment_maps").version : 0;
        if (scene_version_ == scene.version && maps_version_ == maps_version && reach_ == reach)
            return;
        context.chosen->finish();
        mean_distances_.clear();
        if (reach == Reach::kProbe)
            for (uint probe = 0; probe < scene.probes.size(); ++probe)
                mean_distances_.push_back(
                    meanDistance(context.in("environment_maps").as<vec4>(), probe));
        const std::span<float> distances = max_distance_.as<float>();
        for (std::size_t i = 0; i < scene.instances.size(); ++i) {
            const Instance& instance = scene.instances[i];
            distances[i] = reach == Reach::kScene
                               ? glm::distance(scene.bounds.high, scene.bounds.center())
                           : instance.probe == kNone ? 0.0f
                           : reach == Reach::kProbe  ? mean_distances_[instance.probe]
                                                     : greatestDistance(scene, instance);
        }
        scene_version_ = scene.version;
        maps_version_ = maps_version;
        reach_ = reach;
    }

    /// By instance, from this image: the pixels' distances take the place of their errors for a
    /// moment.
    void findVisible(PassContext& context, Reflection::Params params) {
        params.metric = Reflection::kReach;
        dispatch(context, params);
        context.chosen->finish();
        const std::span<float> distances = max_distance_.as<float>();
        std::ranges::fill(distances, 0.0f);
        const std::span<const Hit> hits = context.in("gbuffer").as<Hit>();
        const std::span<const vec2> found = context.out("error").as<vec2>();
        for (std::size_t pixel = 0; pixel < hits.size(); ++pixel)
            if (hits[pixel].instance != kNone) {
                float& greatest = distances[hits[pixel].instance];
                greatest = std::max(greatest, found[pixel].x);
            }
        scene_version_ = 0; // what findReach() found is gone
    }

    Buffer max_distance_; ///< by instance
    std::vector<float> mean_distances_;
    // What findReach() found it for.
    std::uint64_t scene_version_ = 0;
    std::uint64_t maps_version_ = 0;
    Reach reach_ = Reach::kObject;
};

} // namespace

PassType reflectionErrorPass() {
    return PassType("error.reflection", "How wrong a mirror's environment lookup may be")
        .in("gbuffer", types::kHits, "what the raster image sees")
        .in("scene", types::kScene, "mirrors and probes")
        .in("camera", types::kCamera, "of the raster image")
        .inOptional("occlusion", types::kOcclusion, "metric 5: from error.self_occlusion")
        .inOptional("screen_occlusion", types::kPixelOcclusion,
                    "metric 5: from error.screen_occlusion; comes before occlusion")
        .inOptional("environment_maps", types::kEnvironmentMaps, "max_distance probe")
        .out("error", types::kError, "in [0,1]; 0 where nothing reflects")
        .param("metric", 4u, {.min = 1, .max = 5}, "which of the paper's five measures")
        .param("orientation", {"corrected", "as_printed", "accessibility"},
               "of metrics 3 and 4: greatest at grazing angles, or as the paper prints them; "
               "accessibility: metric 5's input is 1 where nothing covers")
        .param("max_distance", {"object", "visible", "scene", "probe"},
               "metric 2's greatest distance: of the object's vertices, of its pixels, the "
               "scene's half diagonal, or the mean of what the probe sees")
        .param("covered", {"share", "any"},
               "metric 5: how much of the hemisphere is covered, or 1 if any is")
        .param("epsilon", 1.0f / 512.0f, {.min = 0, .max = 1},
               "mirror weight up to which a pixel counts as not reflecting")
        .implementedBy<ReflectionError>(Domain::kEither);
}

} // namespace hone

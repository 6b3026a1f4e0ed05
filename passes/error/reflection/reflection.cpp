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
//     5  the occlusion of the surface by its own object
//
// As the paper prints 3 and 4, they are greatest where the lookup is exact; the corrected form is
// the default. The paper leaves M open: here it is the greatest |v - c| of the object's vertices,
// or the scene's half diagonal. expect = bound = E.
//
// in   gbuffer    Hits
//      scene      Scene
//      camera     Camera
//      occlusion  Occlusion, of error.self_occlusion; metric 5 needs it
// out  error      Error, in [0,1]
// params  metric        1 to 5 (4)
//         orientation   corrected, as_printed: of metrics 3 and 4 (corrected)
//         max_distance  object, scene: what M is (object)
//         epsilon       mirror weight below which nothing reflects (1/512)
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

namespace hone {
namespace {

struct Reflection : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/error/reflection/reflection.glsl.h"
};
constexpr Kernel kReflection = makeKernel<Reflection>("reflection", spirv::reflection);

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

class ReflectionError final : public RenderPass {
public:
    void execute(PassContext& context) override {
        const Scene& scene = *context.scene().scene;
        const uint metric = context.param<uint>("metric");
        if (metric == 5 && !context.has("occlusion"))
            throw GraphError("pass \"" + std::string(context.pass_name) +
                             "\": metric 5 needs the input \"occlusion\"; connect the output of a "
                             "pass error.self_occlusion");
        updateMaxDistance(context, scene);

        Reflection::Params params{};
        params.camera = context.camera();
        params.extent = context.extent;
        params.metric = metric;
        params.orientation = context.params->choice("orientation");
        params.epsilon = context.param<float>("epsilon");
        // A port that no edge feeds is never read, but must be bound to something.
        const Argument extra[] = {{"max_distance", max_distance_.view()},
                                  {"occlusion", max_distance_.view()}};
        context.dispatch(kReflection, params, context.extent.x * context.extent.y,
                         std::span(extra).first(context.has("occlusion") ? 1 : 2));
    }

private:
    void updateMaxDistance(PassContext& context, const Scene& scene) {
        const bool of_scene = context.params->choice("max_distance") == 1;
        if (version_ == scene.version && of_scene_ == of_scene)
            return;
        context.chosen->finish();
        const std::size_t bytes = scene.instances.size() * sizeof(float);
        if (!max_distance_ || max_distance_.bytes() < bytes)
            max_distance_ = context.memory->createBuffer(bytes, "max_distance");
        const std::span<float> distances = max_distance_.as<float>();
        for (std::size_t i = 0; i < scene.instances.size(); ++i) {
            const Instance& instance = scene.instances[i];
            if (of_scene)
                distances[i] = glm::distance(scene.bounds.high, scene.bounds.center());
            else
                distances[i] = instance.probe != kNone ? greatestDistance(scene, instance) : 0.0f;
        }
        version_ = scene.version;
        of_scene_ = of_scene;
    }

    Buffer max_distance_;
    std::uint64_t version_ = 0;
    bool of_scene_ = false;
};

} // namespace

PassType reflectionErrorPass() {
    return PassType("error.reflection", "How wrong a mirror's environment lookup may be")
        .in("gbuffer", types::kHits, "what the raster image sees")
        .in("scene", types::kScene, "mirrors and probes")
        .in("camera", types::kCamera, "of the raster image")
        .inOptional("occlusion", types::kOcclusion, "metric 5: from error.self_occlusion")
        .out("error", types::kError, "in [0,1]; 0 where nothing reflects")
        .param("metric", 4u, {.min = 1, .max = 5}, "which of the paper's five measures")
        .param("orientation", {"corrected", "as_printed"},
               "of metrics 3 and 4: greatest at grazing angles, or as the paper prints them")
        .param("max_distance", {"object", "scene"},
               "metric 2's greatest distance: of the object's vertices, or the scene's half "
               "diagonal")
        .param("epsilon", 1.0f / 512.0f, {.min = 0, .max = 1},
               "mirror weight up to which a pixel counts as not reflecting")
        .implementedBy<ReflectionError>(Domain::kEither);
}

} // namespace hone

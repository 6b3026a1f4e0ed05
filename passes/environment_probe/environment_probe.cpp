// SPDX-License-Identifier: Apache-2.0
//
// environment_probe: what is around each probe, as cube maps.
//
// Rasterises the six faces around each probe without the probe's own object and shades them as
// raster does, with the distance to what was seen in the fourth channel. A mirror in the map
// reflects the sky. The record's layout is documented in passes/shading/environment_map.glsl.h.
// Runs again only when the scene changed.
//
// in   scene        Scene
//      shadow_maps  ShadowMaps; not connected: everything is lit
// out  maps         EnvironmentMaps
// params  size  texels along a face's edge (256)
//
//     "probe": { "type": "environment_probe",
//                "in": { "scene": "$scene", "shadow_maps": "shadow_map.maps" } }
//
// Source: Greene, Environment Mapping and Other Applications of World Projections, 1986.
#include "hone/passes/passes.h"

#include "hone_spirv/probe_shade.h"

#include "hone/core/device/kernel.glsl.h"
#include "hone/passes/shading/visibility.h"

#include <algorithm>

namespace hone {
namespace {

struct ProbeShade : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/environment_probe/probe_shade.glsl.h"
};
constexpr Kernel kProbeShade = makeKernel<ProbeShade>("probe_shade", spirv::probe_shade);

/// Nothing nearer to a probe is seen; a part of the scene's radius.
constexpr float kNear = 1e-4f;

std::size_t recordSize(const SizeQuery& query) {
    const std::size_t size = query.params.get<uint>("size");
    return 1 + query.scene->probes.size() * 6 * size * size;
}

class EnvironmentProbe final : public RenderPass {
public:
    void execute(PassContext& context) override {
        const Scene& scene = *context.scene().scene;
        const uint size = context.param<uint>("size");
        const std::size_t face_bytes = std::size_t{size} * size * sizeof(Hit);
        if (hits_.bytes() < 6 * face_bytes)
            hits_ = context.memory->createBuffer(6 * face_bytes, "probe_hits");
        if (!no_maps_)
            no_maps_ = context.memory->createBuffer(kNoMapsBytes, "no_maps");

        context.chosen->finish();
        Value& maps = context.out("maps");
        maps.count = static_cast<uint>(maps.capacity<vec4>().size());
        maps.capacity<vec4>()[0] =
            vec4(static_cast<float>(size), static_cast<float>(scene.probes.size()), 0.0f, 0.0f);
        const float radius =
            scene.bounds.empty() ? 1.0f : glm::distance(scene.bounds.high, scene.bounds.center());

        const Arguments no_arguments;
        ProbeFaces faces(no_arguments, nullptr);
        for (uint i = 0; i < scene.probes.size(); ++i) {
            const Probe& probe = scene.probes[i];
            for (uint face = 0; face < 6; ++face) {
                const View view{{.position = probe.position,
                                 .forward = faces.cubeForward(face),
                                 .right = faces.cubeRight(face),
                                 .up = faces.cubeUp(face),
                                 .tan_half_fov_y = 1.0f,
                                 .near = kNear * radius,
                                 .lens_radius = 0.0f,
                                 .focus = 1.0f},
                                {size, size},
                                0.0f};
                visibility_.drawHits(context, view, {.without = probe.object},
                                     hits_.view().part(face * face_bytes, face_bytes));
            }
            const Argument extra[] = {{"hits", hits_.view()}, {"shadow_maps", no_maps_.view()}};
            const ProbeShade::Params params{i, size, kNear * radius};
            context.dispatch(kProbeShade, params, 6 * size * size,
                             std::span(extra).first(context.has("shadow_maps") ? 1 : 2));
        }
    }

private:
    struct ProbeFaces : HostKernel {
        using HostKernel::HostKernel;
#include "hone/passes/shading/cube.glsl.h"
    };
    static constexpr std::size_t kNoMapsBytes = 32; ///< the header of shadow maps

    Visibility visibility_;
    Buffer hits_, no_maps_;
};

} // namespace

PassType environmentProbePass() {
    return PassType("environment_probe", "Draws cube maps of what is around each probe")
        .in("scene", types::kScene, "its probes and what is around them")
        .inOptional("shadow_maps", types::kShadowMaps, "hard shadows; without, everything is lit")
        .out("maps", types::kEnvironmentMaps, "see passes/shading/environment_map.glsl.h",
             recordSize)
        .param("size", 256u, {.min = 8, .max = 4096}, "texels along a face's edge")
        .implementedBy<EnvironmentProbe>(Domain::kEither);
}

} // namespace hone

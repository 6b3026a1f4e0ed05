// SPDX-License-Identifier: Apache-2.0
//
// shadow_map: depth seen from the lights.
//
// Draws a cube of depth maps around each light point (one face for directional lights), both faces
// of every triangle, holes of masked materials left open: what blocks a shadow ray is in the map.
// Faces that the light does not shine into hold nothing; lights that nothing blocks have no maps.
// The record's layout is documented in passes/shading/shadow_map.glsl.h. Runs again only when the
// scene changed.
//
// in   scene   Scene
// out  maps    ShadowMaps
// params  size    texels along a face's edge (1024)
//         points  points of a light that has an extent: 1 its centre, 5 four around it as well (5)
//
//     "shadow_map": { "type": "shadow_map", "in": { "scene": "$scene" } }
//
// Source: Williams, Casting Curved Shadows on Curved Surfaces, 1978.
#include "hone/passes/passes.h"

#include "hone_spirv/shadow_linear.h"

#include "hone/core/device/kernel.glsl.h"
#include "hone/passes/shading/visibility.h"

#include <algorithm>
#include <cmath>

namespace hone {
namespace {

struct ShadowLinear : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/shadow_map/shadow_linear.glsl.h"
};
constexpr Kernel kShadowLinear = makeKernel<ShadowLinear>("shadow_linear", spirv::shadow_linear);

/// The functions that look maps up also say where they are taken from.
struct MapLayout : HostKernel {
    using HostKernel::HostKernel;
#include "hone/core/scene/texture.glsl.h"

#include "hone/core/scene/surface.glsl.h"

#include "hone/passes/shading/shading.glsl.h"

#include "hone/passes/shading/cube.glsl.h"

#include "hone/passes/shading/shadow_map.glsl.h"
};

/// Which lights have how many maps is known before there are any.
struct LightShape : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/shading/light_extent.glsl.h"
};

constexpr std::size_t kHeader = MapLayout::kShadowHeader;
/// Nothing nearer to a light casts a shadow; a part of the scene's radius.
constexpr float kNear = 1e-4f;

std::size_t mapCount(const Scene& scene, uint points) {
    LightShape shape({}, nullptr);
    std::size_t maps = 0;
    for (const Light& light : scene.lights)
        if (light.shadowless == 0)
            maps += shape.hasExtent(light) ? points : 1u;
    return maps;
}

std::size_t recordSize(const SizeQuery& query) {
    const std::size_t size = query.params.get<uint>("size");
    return kHeader + mapCount(*query.scene, query.params.get<uint>("points")) * 6 * size * size;
}

/// Whether the light sends anything into a cube face that looks along `forward`.
bool shinesInto(const Light& light, vec3 forward) {
    constexpr float kHalfDiagonal =
        0.9553167f; // from a face's axis to its corners: acos(1/sqrt(3))
    const float angle = std::acos(std::clamp(glm::dot(forward, light.direction), -1.0f, 1.0f));
    if (light.kind == kLightRectangle || light.kind == kLightDisc)
        return angle < kHalfDiagonal + 0.5f * glm::pi<float>();
    if (light.kind == kLightSpot)
        return angle < kHalfDiagonal + std::acos(std::clamp(light.cos_outer, -1.0f, 1.0f));
    return true;
}

class ShadowMap final : public RenderPass {
public:
    void execute(PassContext& context) override {
        const Scene& scene = *context.scene().scene;
        const uint size = context.param<uint>("size");
        const uint points = context.param<uint>("points");
        Value& maps = context.out("maps");

        // The header comes first: the layout's functions read it.
        context.chosen->finish();
        const vec3 center = scene.bounds.empty() ? vec3(0.0f) : scene.bounds.center();
        const float radius =
            scene.bounds.empty() ? 1.0f : std::max(glm::distance(scene.bounds.high, center), 1e-6f);
        const float header[kHeader] = {static_cast<float>(size),
                                       static_cast<float>(points),
                                       center.x,
                                       center.y,
                                       center.z,
                                       radius,
                                       0.0f,
                                       0.0f};
        std::ranges::copy(header, maps.capacity<float>().begin());
        maps.count = static_cast<uint>(maps.capacity<float>().size());

        Arguments arguments = context.arguments();
        arguments.bind("shadow_maps", maps.buffer);
        MapLayout layout(arguments, nullptr);
        for (uint light = 0; light < scene.lights.size(); ++light)
            for (uint k = 0; k < layout.shadowPoints(scene.lights[light]); ++k)
                drawMap(context, layout, scene.lights[light], k, layout.shadowMapFirst(light, k));
    }

private:
    void drawMap(PassContext& context, MapLayout& layout, const Light& light, uint k, uint first) {
        const uint size = static_cast<uint>(layout.shadow_maps[0]);
        for (uint face = 0; face < 6; ++face) {
            const uint texels = size * size;
            const View view = faceView(layout, light, k, face);
            const bool is_drawn = light.kind == kLightDirectional
                                      ? face == 0
                                      : shinesInto(light, view.camera.forward);
            const BufferView target = context.out("maps").buffer.part(
                (first + face * texels) * sizeof(float), texels * sizeof(float));
            if (is_drawn)
                visibility_.drawDepth(context, view, {.back_faces = false}, target);
            else
                context.device->fill(target, 0);
        }
        if (context.chosen != context.device)
            context.device->finish();
        const View view = faceView(layout, light, k, 0);
        const ShadowLinear::Params params{first, view.camera.near, view.depth_range};
        context.dispatch(kShadowLinear, params, 6 * size * size);
    }

    static View faceView(MapLayout& layout, const Light& light, uint k, uint face) {
        const uint size = static_cast<uint>(layout.shadow_maps[0]);
        const float radius = layout.shadow_maps[5];
        View view{{}, {size, size}, 0.0f};
        Camera& camera = view.camera;
        if (light.kind == kLightDirectional) {
            const vec3 center(layout.shadow_maps[2], layout.shadow_maps[3], layout.shadow_maps[4]);
            camera.forward = layout.lightDirection(light, k);
            camera.position = center - radius * camera.forward;
            camera.right = layout.across(camera.forward);
            camera.up = glm::cross(camera.right, camera.forward);
            camera.tan_half_fov_y = radius;
            view.depth_range = 2.0f * radius;
            return view;
        }
        camera.position = layout.lightPoint(light, k);
        camera.forward = layout.cubeForward(face);
        camera.right = layout.cubeRight(face);
        camera.up = layout.cubeUp(face);
        camera.tan_half_fov_y = 1.0f;
        camera.near = kNear * radius;
        return view;
    }

    Visibility visibility_;
};

} // namespace

PassType shadowMapPass() {
    return PassType("shadow_map", "Draws depth maps around the lights, for hard shadows")
        .in("scene", types::kScene, "its lights and what blocks them")
        .out("maps", types::kShadowMaps, "see passes/shading/shadow_map.glsl.h", recordSize)
        .param("size", 1024u, {.min = 16, .max = 8192}, "texels along a face's edge")
        .param("points", 5u, {.min = 1, .max = 5},
               "points that get maps of a light with an extent: its centre, then four around it")
        .implementedBy<ShadowMap>(Domain::kEither);
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/support/shadow_scenes.h"

namespace hone::test {

Light lampOf(uint kind) {
    Light light{};
    light.kind = kind;
    light.position = vec3(0, 10, 0);
    light.direction = vec3(0, -1, 0);
    light.half_u = vec3(1, 0, 0);
    light.half_v = vec3(0, 0, 1);
    light.intensity = vec3(1.0f);
    light.cos_outer = -1;
    light.radius = kind == kLightDirectional ? 0.1f : 1.0f;
    return light;
}

Camera cameraAt(vec3 position, vec3 forward, vec3 up) {
    Camera camera{};
    camera.position = position;
    camera.forward = glm::normalize(forward);
    camera.right = glm::normalize(glm::cross(camera.forward, up));
    camera.up = glm::cross(camera.right, camera.forward);
    camera.tan_half_fov_y = 1.0f;
    camera.near = 0.01f;
    return camera;
}

Camera lookingDown(float x) {
    return cameraAt({x, 3.5f, 0}, {0, -1, 0}, {0, 0, -1});
}

void addSquare(SceneBuilder& builder, vec3 middle, vec3 u, vec3 v) {
    const vec3 positions[] = {middle - 20.0f * (u + v), middle + 20.0f * (u - v),
                              middle + 20.0f * (u + v), middle + 20.0f * (v - u)};
    const uvec3 triangles[] = {{0, 1, 2}, {0, 2, 3}};
    builder.add(positions, triangles, builder.addMaterial(plainMaterial(kMaterialTwoSided)));
}

Scene edgeOverFloor(const Light& light, float edge) {
    SceneBuilder builder;
    addSquare(builder, vec3(0), vec3(1, 0, 0), vec3(0, 0, -1));
    addSquare(builder, vec3(edge - 20, 4, 0), vec3(1, 0, 0), vec3(0, 0, -1));
    Scene scene = builder.finish();
    scene.lights = {light};
    return scene;
}

float visibleBesideEdge(const Light& light, float edge, float x, float z) {
    constexpr int kSteps = 200;
    const vec3 point(x, 0, z);
    vec3 half_u = light.half_u;
    vec3 half_v = light.half_v;
    vec3 to_center = light.position - point;
    if (light.kind == kLightDirectional) {
        to_center = -light.direction;
        half_u *= light.radius;
        half_v *= light.radius;
    }
    if (light.kind == kLightSphere) { // the disc that faces the point
        half_u = glm::normalize(glm::cross(to_center, vec3(0, 0, 1)));
        half_v = glm::normalize(glm::cross(to_center, half_u));
    }
    int seen = 0, all = 0;
    for (int i = 0; i < kSteps; ++i)
        for (int k = 0; k < kSteps; ++k) {
            const float u = (static_cast<float>(i) + 0.5f) * 2 / kSteps - 1;
            const float v = (static_cast<float>(k) + 0.5f) * 2 / kSteps - 1;
            if (light.kind != kLightRectangle && u * u + v * v > 1)
                continue;
            const vec3 to_light = to_center + u * half_u + v * half_v;
            seen += x + 4 / to_light.y * to_light.x > edge ? 1 : 0;
            ++all;
        }
    return static_cast<float>(seen) / static_cast<float>(all);
}

} // namespace hone::test

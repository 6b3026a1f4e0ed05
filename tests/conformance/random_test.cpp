// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/brute/brute_backend.h"
#include "hone/tests/conformance/conformance.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <random>

namespace hone::test {
namespace {

/// Numbers in [-1,1] and what is made of them, drawn in the order that the code says.
class Random {
public:
    explicit Random(uint seed) : engine_(seed) {}
    float number() { return distribution_(engine_); }
    vec3 vector() {
        const float x = number();
        const float y = number();
        return {x, y, number()};
    }

private:
    std::mt19937 engine_;
    std::uniform_real_distribution<float> distribution_{-1, 1};
};

/// Five meshes of 20 triangles, each placed five times by any affine map: single-sided, two-sided
/// and masked materials.
Scene randomScene(uint seed) {
    Random random(seed);
    SceneBuilder builder;
    const uint texels[] = {0xff'00'00'00u, 0x00'00'00'00u, 0x40'00'00'00u, 0xc0'00'00'00u};
    const uint texture = builder.addTexture(2, 2, texels, 0);
    for (uint flags :
         {0u, kMaterialTwoSided, kMaterialMasked, kMaterialMasked | kMaterialTwoSided, 0u}) {
        Material material = plainMaterial(flags);
        material.base_color_texture = texture;
        std::vector<vec3> positions;
        std::vector<vec2> uvs;
        std::vector<uvec3> triangles;
        for (uint i = 0; i < 20; ++i) {
            const vec3 center = random.vector();
            for (int corner = 0; corner < 3; ++corner) {
                positions.push_back(center + 0.5f * random.vector());
                const float u = 3 * random.number();
                uvs.emplace_back(u, 3 * random.number());
            }
            triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
        }
        const uint mesh = builder.addMesh(positions, triangles, builder.addMaterial(material), uvs);
        for (int i = 0; i < 5; ++i) {
            mat4 place(1);
            for (int column = 0; column < 3; ++column)
                place[column] += vec4(0.6f * random.vector(), 0);
            place[0] *= i % 2 == 0 ? 1.0f : -1.0f; // every second one mirrored, roughly
            place[3] = vec4(2.0f * random.vector(), 1);
            builder.addInstance(mesh, place);
        }
    }
    return builder.finish();
}

/// Where `ray` meets the plane of the triangle that `hit` names, in double precision.
double distanceTo(const Scene& scene, const Ray& ray, Hit hit) {
    using glm::dvec3;
    if (hit == kMiss)
        return INFINITY;
    const Instance& instance = scene.instances[hit.instance];
    const uvec3 corners =
        scene.triangles[scene.meshes[instance.mesh].first_triangle + hit.primitive];
    const auto place = [&](uint v) {
        return dvec3(instance.to_world * vec4(scene.positions[v], 1));
    };
    const dvec3 a = place(corners.x);
    const dvec3 normal = glm::cross(place(corners.y) - a, place(corners.z) - a);
    return glm::dot(a - dvec3(ray.origin), normal) / glm::dot(dvec3(ray.direction), normal);
}

/// Rays through the middle of the scene, some of them short.
std::vector<Ray> randomRays(uint seed, std::size_t count) {
    Random random(seed);
    std::vector<Ray> rays(count);
    for (Ray& ray : rays) {
        const vec3 origin = 3.0f * random.vector();
        const float tmin = 0.5f * (1 + random.number());
        const vec3 direction = 2.0f * random.vector() - origin;
        ray = {origin, tmin, direction, random.number() > 0 ? 1e30f : 1.0f};
    }
    return rays;
}

TEST_P(TracerConformance, AgreesWithTheBruteLoopOnRandomScenes) {
    for (const uint seed : {1u, 2u}) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        build(randomScene(seed));
        expectAgreementWithBrute(randomRays(seed + 100, rayCount(20'000)));
    }
}

TEST_P(TracerConformance, AgreesWithTheBruteLoopWhileInstancesMove) {
    build(randomScene(3));
    Random random(203);
    // One of them again and again, others once; at last so many that little stands still.
    const std::vector<std::vector<uint>> moves = {{7}, {7}, {0, 7, 24}, {1, 2, 3, 7, 8, 15, 16}};
    for (const std::vector<uint>& moved : moves) {
        SCOPED_TRACE(std::to_string(moved.size()) + " move");
        for (const uint index : moved) {
            mat4x3 place = scene_.instances[index].to_world;
            place[0] *= random.number() > 0 ? 1.0f : -1.0f;
            place[1] += 0.3f * random.vector();
            place[3] = 2.0f * random.vector();
            moveInstance(scene_, index, place);
        }
        tracer_->update(moved);
        expectAgreementWithBrute(randomRays(300, rayCount(5'000)));
    }
}

} // namespace

void TracerConformance::expectAgreementWithBrute(std::span<const Ray> rays) const {
    const auto brute = makeBruteBackend();
    brute->build(scene_);
    std::vector<Hit> expected(rays.size());
    std::vector<uint> expected_occluded(rays.size());
    brute->closest(rays, expected, Coherence::kIncoherent, {});
    brute->occluded(rays, expected_occluded, Coherence::kIncoherent, {});
    const auto misses = static_cast<std::size_t>(std::ranges::count(expected, kMiss));
    EXPECT_GT(misses, rays.size() / 20);
    EXPECT_LT(misses, rays.size() - rays.size() / 20);

    for (const Mode& mode : kModes) {
        const std::vector<Hit> hits = closestOf(rays, mode);
        EXPECT_EQ(occludedOf(rays, mode), expected_occluded);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            if (hits[i] == expected[i])
                continue;
            const double t = distanceTo(scene_, rays[i], expected[i]);
            EXPECT_NEAR(distanceTo(scene_, rays[i], hits[i]), t, 1e-5 * t) << "ray " << i;
        }
    }
}

} // namespace hone::test

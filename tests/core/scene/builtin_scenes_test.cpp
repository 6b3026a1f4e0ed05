// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/builtin_scenes.h"

#include "hone/core/error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <tuple>

namespace hone {
namespace {

using Triangle = std::array<vec3, 3>;

Triangle worldTriangle(const Scene& scene, const Instance& instance, uint primitive) {
    const uvec3 corners = scene.triangles[scene.meshes[instance.mesh].first_triangle + primitive];
    const auto at = [&](uint vertex) -> vec3 {
        return instance.to_world * vec4(scene.positions[vertex], 1.0f);
    };
    Triangle result{at(corners.x), at(corners.y), at(corners.z)};
    if (instance.flipped != 0)
        std::swap(result[1], result[2]);
    return result;
}

std::vector<Triangle> worldTriangles(const Scene& scene) {
    std::vector<Triangle> result;
    for (const Instance& instance : scene.instances)
        for (uint i = 0; i < scene.meshes[instance.mesh].triangle_count; ++i)
            result.push_back(worldTriangle(scene, instance, i));
    return result;
}

/// Each scene is built once for all tests.
const Scene& builtScene(std::string_view name) {
    static std::map<std::string_view, Scene> built;
    const auto found = built.find(name);
    return found != built.end() ? found->second
                                : built.emplace(name, makeBuiltinScene(name)).first->second;
}

class EveryBuiltinScene : public ::testing::TestWithParam<std::string_view> {
protected:
    const Scene& scene = builtScene(GetParam());
};

INSTANTIATE_TEST_SUITE_P(Scenes, EveryBuiltinScene, ::testing::ValuesIn(builtinScenes()),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(EveryBuiltinScene, HasItsNameAndACamera) {
    EXPECT_EQ(scene.name, "builtin:" + std::string(GetParam()));
    EXPECT_FALSE(scene.cameras.empty());
    EXPECT_NE(scene.version, 0u);
    EXPECT_TRUE(scene.warnings.empty());
}

TEST_P(EveryBuiltinScene, HasOnlyValidIndices) {
    EXPECT_EQ(scene.normals.size(), scene.positions.size());
    EXPECT_EQ(scene.uvs.size(), scene.positions.size());
    for (const uvec3 t : scene.triangles)
        ASSERT_LT(std::max({t.x, t.y, t.z}), scene.positions.size());
    for (const Mesh& mesh : scene.meshes) {
        ASSERT_LE(std::size_t(mesh.first_triangle) + mesh.triangle_count, scene.triangles.size());
        ASSERT_LT(mesh.material, scene.materials.size());
    }
    for (const Instance& instance : scene.instances) {
        ASSERT_LT(instance.mesh, scene.meshes.size());
        ASSERT_TRUE(instance.probe == kNone || instance.probe < scene.probes.size());
    }
    for (const Material& material : scene.materials)
        ASSERT_TRUE(material.base_color_texture == kNone ||
                    material.base_color_texture < scene.textures.size());
    EXPECT_EQ(scene.instance_names.size(), scene.instances.size());
    EXPECT_EQ(scene.material_names.size(), scene.materials.size());
}

TEST_P(EveryBuiltinScene, HasUnitNormalsOnTheFrontSide) {
    for (const vec3 n : scene.normals)
        ASSERT_NEAR(length(n), 1.0f, 1e-4f);
    for (const Mesh& mesh : scene.meshes)
        for (uint i = 0; i < mesh.triangle_count; ++i) {
            const uvec3 t = scene.triangles[mesh.first_triangle + i];
            const vec3 a = scene.positions[t.x];
            const vec3 front = cross(scene.positions[t.y] - a, scene.positions[t.z] - a);
            // Their mean: at a sharp fold a single corner's normal may lean over the edge.
            const vec3 mean = scene.normals[t.x] + scene.normals[t.y] + scene.normals[t.z];
            ASSERT_GT(dot(front, mean), 0.0f) << scene.material_names[mesh.material] << " triangle "
                                              << i << " at " << a.x << ' ' << a.y << ' ' << a.z;
        }
}

TEST_P(EveryBuiltinScene, TurnsClosedMeshesOutward) {
    // The parts of a mesh that close (every edge is met once each way, corners told apart by
    // position) have a positive volume by the divergence theorem, unless they are rooms.
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        const Mesh& mesh = scene.meshes[m];
        using Point = std::tuple<float, float, float>;
        std::map<std::pair<Point, Point>, int> edges;
        double volume = 0;
        for (uint i = 0; i < mesh.triangle_count; ++i) {
            const uvec3 t = scene.triangles[mesh.first_triangle + i];
            for (glm::length_t corner = 0; corner < 3; ++corner) {
                // + 0: the two zeros are one place.
                const vec3 a = scene.positions[t[corner]] + 0.0f;
                const vec3 b = scene.positions[t[(corner + 1) % 3]] + 0.0f;
                const Point from{a.x, a.y, a.z}, to{b.x, b.y, b.z};
                if (from < to)
                    ++edges[{from, to}];
                else
                    --edges[{to, from}];
            }
            volume += double(
                dot(scene.positions[t.x], cross(scene.positions[t.y], scene.positions[t.z])));
        }
        const bool closed = std::all_of(edges.begin(), edges.end(),
                                        [](const auto& edge) { return edge.second == 0; });
        const bool room = scene.material_names[mesh.material] == "room";
        if (closed && mesh.triangle_count > 0) {
            EXPECT_GT(room ? -volume : volume, 0.0) << scene.material_names[mesh.material];
        }
    }
}

TEST_P(EveryBuiltinScene, HasAllMipLevels) {
    std::size_t expected = 0;
    for (const Texture& texture : scene.textures) {
        EXPECT_EQ(texture.first_texel, expected);
        uint w = texture.width, h = texture.height, levels = 1;
        expected += std::size_t(w) * h;
        for (; w > 1 || h > 1; ++levels) {
            w = std::max(1u, w / 2);
            h = std::max(1u, h / 2);
            expected += std::size_t(w) * h;
        }
        EXPECT_EQ(texture.levels, levels);
    }
    EXPECT_EQ(scene.texels.size(), expected);
}

TEST_P(EveryBuiltinScene, IsTheSameEachTime) {
    const Scene again = makeBuiltinScene(GetParam());
    const auto same = [](const auto& a, const auto& b) {
        return a.size() == b.size() &&
               (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
    };
    EXPECT_TRUE(same(scene.positions, again.positions));
    EXPECT_TRUE(same(scene.normals, again.normals));
    EXPECT_TRUE(same(scene.uvs, again.uvs));
    EXPECT_TRUE(same(scene.triangles, again.triangles));
    EXPECT_TRUE(same(scene.instances, again.instances));
    EXPECT_TRUE(same(scene.materials, again.materials));
    EXPECT_TRUE(same(scene.texels, again.texels));
    EXPECT_TRUE(same(scene.lights, again.lights));
}

/// Whether two triangles in one plane share more than an edge: no side of either keeps them apart
/// (separating axes, in the plane of the two larger axes).
bool overlaps(const Triangle& a, const Triangle& b, glm::length_t x, glm::length_t y) {
    const auto separated = [&](const Triangle& p, const Triangle& q) {
        for (std::size_t i = 0; i < 3; ++i) {
            const vec3 edge = p[(i + 1) % 3] - p[i];
            const vec2 axis = normalize(vec2(-edge[y], edge[x]));
            const auto reach = [&](const Triangle& t) {
                float low = 1e30f, high = -1e30f;
                for (const vec3& v : t) {
                    const float d = axis.x * (v[x] - p[i][x]) + axis.y * (v[y] - p[i][y]);
                    low = std::min(low, d);
                    high = std::max(high, d);
                }
                return std::pair(low, high);
            };
            const auto [a_low, a_high] = reach(p);
            const auto [b_low, b_high] = reach(q);
            if (a_high <= b_low + 1e-4f || b_high <= a_low + 1e-4f)
                return true;
        }
        return false;
    };
    return !separated(a, b) && !separated(b, a);
}

TEST_P(EveryBuiltinScene, HasNoTwoFacesInOnePlane) {
    // Where two faces coincide, the nearest hit is a tie that tracers break differently. Faces
    // along the axes are those that are placed by hand; 0.1 mm apart is apart.
    std::map<std::pair<glm::length_t, int>, std::vector<Triangle>> planes;
    for (const Triangle& t : worldTriangles(scene)) {
        const vec3 normal = normalize(cross(t[1] - t[0], t[2] - t[0]));
        for (glm::length_t axis = 0; axis < 3; ++axis)
            if (std::abs(normal[axis]) > 0.99999f)
                planes[{axis, static_cast<int>(std::lround(t[0][axis] * 10000))}].push_back(t);
    }
    for (auto& [plane, faces] : planes) {
        const glm::length_t x = (plane.first + 1) % 3, y = (plane.first + 2) % 3;
        const auto low = [x](const Triangle& t) { return std::min({t[0][x], t[1][x], t[2][x]}); };
        const auto high = [x](const Triangle& t) { return std::max({t[0][x], t[1][x], t[2][x]}); };
        std::sort(faces.begin(), faces.end(),
                  [&](const Triangle& a, const Triangle& b) { return low(a) < low(b); });
        for (std::size_t i = 0; i < faces.size(); ++i)
            for (std::size_t j = i + 1; j < faces.size() && low(faces[j]) < high(faces[i]); ++j)
                ASSERT_FALSE(overlaps(faces[i], faces[j], x, y))
                    << "axis " << plane.first << " at " << plane.second / 10000.0 << ": "
                    << faces[i][0].x << ' ' << faces[i][0].y << ' ' << faces[i][0].z << " and "
                    << faces[j][0].x << ' ' << faces[j][0].y << ' ' << faces[j][0].z;
    }
}

TEST(BuiltinScenes, UnknownNameIsAnErrorWithTheList) {
    try {
        (void)makeBuiltinScene("sponza");
        FAIL();
    } catch (const SceneError& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("sponza"), std::string::npos);
        for (const std::string_view name : builtinScenes())
            EXPECT_NE(message.find(name), std::string::npos);
    }
}

TEST(BuiltinAtrium, HasAboutAsManyTrianglesAsSponza) {
    const Scene& scene = builtScene("atrium");
    EXPECT_GE(scene.instancedTriangles(), 250000u);
    EXPECT_LE(scene.instancedTriangles(), 270000u);
    EXPECT_LT(scene.triangles.size(), scene.instancedTriangles() / 3); // parts are shared
}

TEST(BuiltinAtrium, FillsItsCourt) {
    const Scene& scene = builtScene("atrium");
    EXPECT_NEAR(scene.bounds.high.x - scene.bounds.low.x, 30, 1);
    EXPECT_NEAR(scene.bounds.high.y - scene.bounds.low.y, 11.3, 0.5);
    EXPECT_NEAR(scene.bounds.high.z - scene.bounds.low.z, 14.4, 0.5);
}

TEST(BuiltinAtrium, HasWhatTheMetricsLookFor) {
    const Scene& scene = builtScene("atrium");
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.lights[0].kind, kLightRectangle);
    EXPECT_NEAR(2 * length(scene.lights[0].half_u), 2, 1e-5);
    EXPECT_LT(scene.lights[0].direction.y, -0.8f);
    EXPECT_NEAR(dot(scene.lights[0].direction, scene.lights[0].half_u), 0, 1e-5);
    ASSERT_EQ(scene.probes.size(), 1u);
    const Instance& mirror_object = scene.instances[scene.probes[0].object];
    EXPECT_EQ(scene.instance_names[scene.probes[0].object], "knot");
    EXPECT_EQ(mirror_object.probe, 0u);
    const auto count = [&](uint flags) {
        return std::count_if(scene.materials.begin(), scene.materials.end(),
                             [&](const Material& m) { return (m.flags & flags) == flags; });
    };
    EXPECT_EQ(count(kMaterialMirror), 2);
    EXPECT_EQ(count(kMaterialMasked | kMaterialTwoSided), 1);
    for (const char* camera : {"court", "gallery", "mirror"})
        EXPECT_NO_THROW((void)scene.camera(camera));
    EXPECT_EQ(scene.camera("").name, "court");
}

TEST(BuiltinMirrorSphere, LiesOnItsSpheres) {
    const Scene& scene = builtScene("mirror_sphere");
    const uint object = scene.probes.at(0).object;
    EXPECT_EQ(scene.probes[0].position, vec3(0));
    for (uint i = 0; i < scene.instances.size(); ++i) {
        const float radius = i == object ? 1.0f : 5.0f;
        const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
        EXPECT_GE(mesh.triangle_count, 2u * 128 * 62);
        for (uint p = 0; p < mesh.triangle_count; ++p)
            for (const vec3& corner : worldTriangle(scene, scene.instances[i], p))
                ASSERT_NEAR(length(corner), radius, 1e-5f);
    }
}

TEST(BuiltinMirrorSphere, RoomShinesByItsDirection) {
    // L(w) = 1/2 + 1/2 w.x in the texel that a vertex of the room points at: half a texel of 1024
    // and one of 255 codes are at most 0.004 off where the slope is largest (1/2 per radian).
    const Scene& scene = builtScene("mirror_sphere");
    const Texture& texture = scene.textures.at(0);
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        if (scene.materials[mesh.material].base_color_texture == kNone)
            continue;
        for (uint p = 0; p < mesh.triangle_count; ++p) {
            const uint vertex = scene.triangles[mesh.first_triangle + p].x;
            const vec3 direction = scene.positions[vertex] / 5.0f;
            if (std::abs(direction.y) > 0.98f)
                continue;
            const vec2 uv = scene.uvs[vertex];
            const auto x =
                std::min(static_cast<uint>(uv.x * float(texture.width)), texture.width - 1);
            const auto y =
                std::min(static_cast<uint>(uv.y * float(texture.height)), texture.height - 1);
            const uint code = scene.texels[texture.first_texel + y * texture.width + x] & 255u;
            const float encoded = float(code) / 255.0f;
            const float linear = encoded <= 0.04045f ? encoded / 12.92f
                                                     : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
            ASSERT_NEAR(linear, 0.5f + 0.5f * direction.x, 0.008f);
        }
    }
}

TEST(BuiltinStraightEdge, HasTheClosedFormsNumbers) {
    const Scene& scene = builtScene("straight_edge");
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.lights[0].position, vec3(0, 10, 0));
    EXPECT_EQ(scene.lights[0].direction, vec3(0, -1, 0));
    EXPECT_EQ(length(scene.lights[0].half_u), 1.0f);
    float edge = -1e30f;
    for (const Triangle& t : worldTriangles(scene))
        for (const vec3& corner : t)
            if (corner.y == 4.0f)
                edge = std::max(edge, corner.x);
    EXPECT_EQ(edge, 0.0f);
}

TEST(BuiltinLitFloor, SeesTheWholeLightEverywhere) {
    const Scene& scene = builtScene("lit_floor");
    const Light& light = scene.lights.at(0);
    const std::vector<Triangle> triangles = worldTriangles(scene);
    float steepest = 1;
    for (const Triangle& t : triangles) {
        const vec3 normal = normalize(cross(t[1] - t[0], t[2] - t[0]));
        steepest = std::min(steepest, normal.y);
        for (const vec3& corner : t)
            for (const float u : {-1.0f, 1.0f})
                for (const float v : {-1.0f, 1.0f}) {
                    const vec3 to_light =
                        light.position + u * light.half_u + v * light.half_v - corner;
                    EXPECT_GT(dot(normal, to_light), 0.0f); // above the horizon
                    // And, for the floor, on the near side of the slanted plane through the origin.
                    EXPECT_LE(corner.x * std::sin(1.3962634f) - corner.y * std::cos(1.3962634f),
                              1e-5f);
                }
    }
    EXPECT_NEAR(steepest, std::cos(1.3962634), 1e-5); // 80 degrees
}

} // namespace
} // namespace hone

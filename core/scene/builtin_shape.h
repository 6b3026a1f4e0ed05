// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/scene/scene.h"

#include <functional>

namespace hone {

/// Triangles in the making, for built-in scenes: shapes are added, placed and put into a scene.
/// Faces turn counter-clockwise seen from outside. Texture coordinates are in metres until addMesh.
struct Shape {
    std::vector<vec3> positions;
    std::vector<vec3> normals;
    std::vector<vec2> uvs;
    std::vector<uvec3> triangles;

    /// A flat quad; a, b, c, d counter-clockwise seen from its front. uv: (0,0) at a.
    void addQuad(vec3 a, vec3 b, vec3 c, vec3 d);

    /// The six faces of an axis-aligned box; uv in the plane of each face.
    void addBox(vec3 low, vec3 high);

    /// A box whose upper edges are cut by `bevel` metres at 45 degrees, without a bottom.
    void addTile(vec3 low, vec3 high, float bevel);

    /// A surface of revolution about y. profile: (radius, height) from the bottom to the top; first
    /// or last radius 0 closes it. Normals are smooth across edges of less than 40 degrees.
    void addLathe(std::span<const vec2> profile, uint sides);

    /// A round tube along a path, closed to a ring or with flat ends. Radius > 0, at least two
    /// points, no two neighbours equal.
    void addTube(std::span<const vec3> path, float radius, uint sides, bool ring = false);

    /// A smooth sheet: point(u, v) for u, v in [0,1]; its front is where cross(d/du, d/dv) points.
    /// uv: (u, v) times uv_size.
    void addSheet(uvec2 cells, vec2 uv_size, const std::function<vec3(float, float)>& point);

    /// A prism: the outline (x, y), counter-clockwise seen from +z, from z = low to high, without
    /// end faces.
    void addWalls(std::span<const vec2> outline, float low, float high);

    /// Replaces all texture coordinates by the position, seen along the axis nearest to the normal:
    /// one pattern runs across all that was added.
    void projectUvs();

    /// Another shape, moved.
    void add(const Shape& other, const mat4& to_here);
};

/// Moves by `offset` after turning about y by `degrees`.
[[nodiscard]] mat4 placed(vec3 offset, float degrees = 0.0f);

/// Appends the material and its name; returns its index.
uint addMaterial(Scene& scene, const std::string& name, const Material& material);

/// A diffuse material, single-sided.
[[nodiscard]] Material diffuse(vec3 base_color, uint texture = kNone);

/// A smooth mirror that shows nothing else.
[[nodiscard]] Material mirror(vec3 f0);

/// Appends the shape as a mesh; texture coordinates are divided by `uv_meters`. Returns its index.
uint addMesh(Scene& scene, const Shape& shape, uint material, vec2 uv_meters = vec2(1));

/// Places a mesh in the world; returns the instance's index.
uint addInstance(Scene& scene, const std::string& name, uint mesh, const mat4& to_world = mat4(1));

/// A rectangle light of half edges u and v that shines along cross(u, v).
[[nodiscard]] Light rectangleLight(vec3 center, vec3 half_u, vec3 half_v, vec3 radiance);

/// A directional light of that irradiance, perpendicular to it.
[[nodiscard]] Light directionalLight(vec3 direction, vec3 irradiance);

/// Bits of a 32-bit integer, mixed (Wellons' lowbias32). The built-in scenes' only chance.
[[nodiscard]] uint hashed(uint x);

/// hashed as a float in [0,1).
[[nodiscard]] float chance(uint x);

} // namespace hone

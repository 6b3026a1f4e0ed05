// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/builtin_shape.h"

#include "hone/core/error.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <numbers>

namespace hone {
namespace {

constexpr float kTau = 2.0f * std::numbers::pi_v<float>;

uint vertexCount(const Shape& shape) {
    return static_cast<uint>(shape.positions.size());
}

void addVertex(Shape& shape, vec3 position, vec3 normal, vec2 uv) {
    shape.positions.push_back(position);
    shape.normals.push_back(normal);
    shape.uvs.push_back(uv);
}

/// The cells of a grid of vertices, rows of `columns` each, front side up where columns run right
/// and rows run up. Triangles without area (at poles) are left out.
void addCells(Shape& shape, uint first, uint columns, uint rows) {
    const auto add = [&](uint a, uint b, uint c) {
        const vec3 pa = shape.positions[a], pb = shape.positions[b], pc = shape.positions[c];
        if (pa != pb && pb != pc && pc != pa)
            shape.triangles.emplace_back(a, b, c);
    };
    for (uint y = 0; y + 1 < rows; ++y)
        for (uint x = 0; x + 1 < columns; ++x) {
            const uint a = first + y * columns + x;
            add(a, a + 1, a + columns + 1);
            add(a, a + columns + 1, a + columns);
        }
}

/// Points of a circle; the last is exactly the first.
vec2 onCircle(uint i, uint sides) {
    const float angle = kTau * float(i % sides) / float(sides);
    return {std::cos(angle), std::sin(angle)};
}

} // namespace

void Shape::addQuad(vec3 a, vec3 b, vec3 c, vec3 d) {
    const uint first = vertexCount(*this);
    const vec3 normal = normalize(cross(b - a, d - a));
    const vec3 across = normalize(b - a);
    const vec3 up = cross(normal, across);
    for (const vec3 p : {a, b, c, d})
        addVertex(*this, p, normal, {dot(p - a, across), -dot(p - a, up)});
    triangles.emplace_back(first, first + 1, first + 2);
    triangles.emplace_back(first, first + 2, first + 3);
}

void Shape::addBox(vec3 l, vec3 h) {
    addQuad({l.x, l.y, h.z}, {h.x, l.y, h.z}, {h.x, h.y, h.z}, {l.x, h.y, h.z});
    addQuad({h.x, l.y, l.z}, {l.x, l.y, l.z}, {l.x, h.y, l.z}, {h.x, h.y, l.z});
    addQuad({h.x, l.y, h.z}, {h.x, l.y, l.z}, {h.x, h.y, l.z}, {h.x, h.y, h.z});
    addQuad({l.x, l.y, l.z}, {l.x, l.y, h.z}, {l.x, h.y, h.z}, {l.x, h.y, l.z});
    addQuad({l.x, h.y, h.z}, {h.x, h.y, h.z}, {h.x, h.y, l.z}, {l.x, h.y, l.z});
    addQuad({l.x, l.y, l.z}, {h.x, l.y, l.z}, {h.x, l.y, h.z}, {l.x, l.y, h.z});
}

void Shape::addTile(vec3 l, vec3 h, float bevel) {
    const float y = h.y - bevel; // where the bevel begins
    const vec3 outer[4] = {{l.x, y, h.z}, {h.x, y, h.z}, {h.x, y, l.z}, {l.x, y, l.z}};
    const vec3 inner[4] = {{l.x + bevel, h.y, h.z - bevel},
                           {h.x - bevel, h.y, h.z - bevel},
                           {h.x - bevel, h.y, l.z + bevel},
                           {l.x + bevel, h.y, l.z + bevel}};
    addQuad(inner[0], inner[1], inner[2], inner[3]);
    for (uint i = 0; i < 4; ++i) {
        const vec3 a = outer[i], b = outer[(i + 1) % 4];
        addQuad(a, b, inner[(i + 1) % 4], inner[i]);
        addQuad({a.x, l.y, a.z}, {b.x, l.y, b.z}, b, a);
    }
}

void Shape::addLathe(std::span<const vec2> points, uint sides) {
    // Where one arc of an outline ends and the next begins, a point may stand twice.
    std::vector<vec2> profile;
    for (const vec2 point : points)
        if (profile.empty() || distance(profile.back(), point) > 1e-5f)
            profile.push_back(point);
    HONE_ASSERT(profile.size() >= 2 && sides >= 3, std::to_string(profile.size()));
    // Going up, outside is to the right: the edge (r, y) has the normal (y, -r).
    std::vector<vec2> edges;
    for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
        const vec2 along = profile[i + 1] - profile[i];
        edges.push_back(normalize(vec2(along.y, -along.x)));
    }
    const auto is_smooth = [&](std::size_t i) { return dot(edges[i - 1], edges[i]) > 0.766f; };

    float length = 0;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const vec2 ends[2] = {profile[i], profile[i + 1]};
        vec2 normals_2d[2] = {edges[i], edges[i]};
        if (i > 0 && is_smooth(i))
            normals_2d[0] = normalize(edges[i - 1] + edges[i]);
        if (i + 1 < edges.size() && is_smooth(i + 1))
            normals_2d[1] = normalize(edges[i] + edges[i + 1]);
        const float width = kTau * std::max(profile[i].x, profile[i + 1].x);
        const uint first = vertexCount(*this);
        for (uint end = 0; end < 2; ++end) {
            for (uint side = 0; side <= sides; ++side) {
                const vec2 circle = onCircle(side, sides);
                // Seen from outside, columns run right, which is down in the angle.
                const auto turned = [&](vec2 p) {
                    return vec3(p.x * circle.x, p.y, -p.x * circle.y);
                };
                addVertex(*this, turned(ends[end]), turned(normals_2d[end]),
                          {width * float(side) / float(sides), -length});
            }
            length += end == 0 ? distance(ends[0], ends[1]) : 0.0f;
        }
        addCells(*this, first, sides + 1, 2);
    }
}

void Shape::addTube(std::span<const vec3> path, float radius, uint sides, bool ring) {
    HONE_ASSERT(path.size() >= 2, "a tube needs two points");
    const std::size_t count = path.size();
    const auto tangentAt = [&](std::size_t i) {
        if (ring)
            return normalize(path[(i + 1) % count] - path[(i + count - 1) % count]);
        return normalize(path[std::min(i + 1, count - 1)] - path[i > 0 ? i - 1 : 0]);
    };
    // A frame carried along without twist (double reflection, Wang et al. 2008).
    std::vector<vec3> sideways;
    const vec3 start = tangentAt(0);
    sideways.push_back(
        normalize(cross(start, std::abs(start.y) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0))));
    const std::size_t rings = ring ? count + 1 : count;
    for (std::size_t i = 0; i + 1 < rings; ++i) {
        const vec3 step = path[(i + 1) % count] - path[i];
        const float scale = 2.0f / dot(step, step);
        const vec3 reflected = sideways[i] - scale * dot(step, sideways[i]) * step;
        const vec3 tangent = tangentAt(i) - scale * dot(step, tangentAt(i)) * step;
        const vec3 error = tangentAt((i + 1) % count) - tangent;
        const float size = dot(error, error);
        vec3 next =
            size > 0.0f ? reflected - 2.0f / size * dot(error, reflected) * error : reflected;
        sideways.push_back(normalize(next));
    }
    // A ring's last frame is turned against its first: every frame takes its share of it.
    float twist = 0;
    if (ring)
        twist = std::atan2(dot(cross(sideways.back(), sideways[0]), start),
                           dot(sideways.back(), sideways[0]));

    const uint first = vertexCount(*this);
    float length = 0;
    for (std::size_t i = 0; i < rings; ++i) {
        const std::size_t at = i % count;
        const vec3 x = sideways[i], y = cross(tangentAt(at), x);
        const float turn = twist * float(i) / float(rings - 1);
        length += i > 0 ? distance(path[at], path[i - 1]) : 0.0f;
        for (uint side = 0; side <= sides; ++side) {
            const float angle = kTau * float(side % sides) / float(sides) + turn;
            vec3 normal = std::cos(angle) * x + std::sin(angle) * y;
            vec3 position = path[at] + radius * normal;
            if (ring && i + 1 == rings) { // the seam closes bit for bit
                position = positions[first + side];
                normal = normals[first + side];
            }
            addVertex(*this, position, normal,
                      {kTau * radius * float(side) / float(sides), -length});
        }
    }
    addCells(*this, first, sides + 1, static_cast<uint>(rings));
    if (ring)
        return;
    for (const bool at_end : {false, true}) {
        const vec3 normal = at_end ? tangentAt(count - 1) : -tangentAt(0);
        const uint rim = first + (at_end ? static_cast<uint>(rings - 1) * (sides + 1) : 0);
        const uint cap = vertexCount(*this);
        for (uint side = 0; side < sides; ++side)
            addVertex(*this, positions[rim + side], normal, uvs[rim + side]);
        for (uint side = 1; side + 1 < sides; ++side)
            triangles.push_back(at_end ? uvec3(cap, cap + side, cap + side + 1)
                                       : uvec3(cap, cap + side + 1, cap + side));
    }
}

void Shape::addSheet(uvec2 cells, vec2 uv_size, const std::function<vec3(float, float)>& point) {
    const uint first = vertexCount(*this);
    constexpr float kStep = 1e-3f;
    for (uint j = 0; j <= cells.y; ++j)
        for (uint i = 0; i <= cells.x; ++i) {
            const float u = float(i) / float(cells.x), v = float(j) / float(cells.y);
            const vec3 du = point(u + kStep, v) - point(u - kStep, v);
            const vec3 dv = point(u, v + kStep) - point(u, v - kStep);
            addVertex(*this, point(u, v), normalize(cross(du, dv)), vec2(u, v) * uv_size);
        }
    addCells(*this, first, cells.x + 1, cells.y + 1);
}

void Shape::addWalls(std::span<const vec2> outline, float low, float high) {
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const vec2 a = outline[i], b = outline[(i + 1) % outline.size()];
        addQuad({a.x, a.y, high}, {a.x, a.y, low}, {b.x, b.y, low}, {b.x, b.y, high});
    }
}

void Shape::projectUvs() {
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const vec3 p = positions[i], n = abs(normals[i]);
        uvs[i] = n.y > n.x && n.y > n.z ? vec2(p.x, p.z) : vec2(n.x > n.z ? p.z : p.x, -p.y);
    }
}

void Shape::add(const Shape& other, const mat4& to_here) {
    const uint first = vertexCount(*this);
    const mat3 normal_matrix = transpose(inverse(mat3(to_here)));
    for (std::size_t i = 0; i < other.positions.size(); ++i)
        addVertex(*this, vec3(to_here * vec4(other.positions[i], 1.0f)),
                  normalize(normal_matrix * other.normals[i]), other.uvs[i]);
    const bool flips = determinant(mat3(to_here)) < 0.0f;
    for (const uvec3 t : other.triangles)
        triangles.push_back(first + (flips ? uvec3(t.x, t.z, t.y) : t));
}

mat4 placed(vec3 offset, float degrees) {
    return glm::rotate(glm::translate(mat4(1), offset), glm::radians(degrees), vec3(0, 1, 0));
}

uint addMaterial(Scene& scene, const std::string& name, const Material& material) {
    scene.materials.push_back(material);
    scene.material_names.push_back(name);
    return static_cast<uint>(scene.materials.size() - 1);
}

Material diffuse(vec3 base_color, uint texture) {
    return {.base_color = base_color,
            .base_color_texture = texture,
            .emission = vec3(0),
            .alpha = 1.0f,
            .f0 = vec3(0),
            .alpha_cutoff = 0.5f,
            .flags = 0};
}

Material mirror(vec3 f0) {
    Material material = diffuse(vec3(0));
    material.f0 = f0;
    material.flags = kMaterialMirror;
    return material;
}

uint addMesh(Scene& scene, const Shape& shape, uint material, vec2 uv_meters) {
    const auto first_vertex = static_cast<uint>(scene.positions.size());
    Mesh mesh{static_cast<uint>(scene.triangles.size()), static_cast<uint>(shape.triangles.size()),
              material, 0, 0};
    scene.positions.insert(scene.positions.end(), shape.positions.begin(), shape.positions.end());
    scene.normals.insert(scene.normals.end(), shape.normals.begin(), shape.normals.end());
    for (const vec2 uv : shape.uvs)
        scene.uvs.push_back(uv / uv_meters);
    for (const uvec3 triangle : shape.triangles)
        scene.triangles.push_back(first_vertex + triangle);
    scene.meshes.push_back(mesh);
    return static_cast<uint>(scene.meshes.size() - 1);
}

uint addInstance(Scene& scene, const std::string& name, uint mesh, const mat4& to_world) {
    const mat3 linear(to_world);
    scene.instances.push_back({.to_world = mat4x3(to_world),
                               .normal_matrix = transpose(inverse(linear)),
                               .mesh = mesh,
                               .probe = kNone,
                               .flipped = determinant(linear) < 0.0f ? 1u : 0u});
    scene.instance_names.push_back(name);
    return static_cast<uint>(scene.instances.size() - 1);
}

Light rectangleLight(vec3 center, vec3 half_u, vec3 half_v, vec3 radiance) {
    return {.kind = kLightRectangle,
            .position = center,
            .direction = normalize(cross(half_u, half_v)),
            .half_u = half_u,
            .half_v = half_v,
            .intensity = radiance,
            .cos_inner = 0,
            .cos_outer = 0,
            .range = 0,
            .radius = 0,
            .shadowless = 0};
}

Light directionalLight(vec3 direction, vec3 irradiance) {
    return {.kind = kLightDirectional,
            .position = vec3(0),
            .direction = normalize(direction),
            .half_u = vec3(0),
            .half_v = vec3(0),
            .intensity = irradiance,
            .cos_inner = 0,
            .cos_outer = 0,
            .range = 0,
            .radius = 0,
            .shadowless = 0};
}

uint hashed(uint x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

float chance(uint x) {
    return float(hashed(x) >> 8) * (1.0f / 16777216.0f);
}

} // namespace hone

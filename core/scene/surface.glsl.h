// SPDX-License-Identifier: Apache-2.0
//
// From a hit to what is there: the one routine that recomputes barycentrics and position from a ray
// and a triangle, for raster and trace alike, and for every tracer's alpha test. Kernel source:
// included flat, once, inside a kernel, after texture.glsl.h.

HONE_READ(vec3, scene_positions)
HONE_READ(vec3, scene_normals)
HONE_READ(vec2, scene_uvs)
HONE_READ(uvec3, scene_triangles)
HONE_READ(Mesh, scene_meshes)
HONE_READ(Instance, scene_instances)
HONE_READ(Material, scene_materials)

/// A point on a surface, seen along a ray.
struct Surface {
    vec3 position;         ///< world space
    float t;               ///< where on the ray
    vec3 geometric_normal; ///< unit, on the side that the ray comes from
    vec3 normal;           ///< unit, interpolated, on the side that the ray comes from
    vec2 uv;
    float uv_per_meter; ///< sqrt(area in texture space / area in the world), for the texture's
                        ///< level of detail
    uint material;
    uint instance;
    uint primitive;
    vec2 barycentrics; ///< weights of the triangle's second and third vertex
};

/// Of what `hit` (not a miss) names: kMaterialMirror and the like.
uint materialFlags(Hit hit) {
    return scene_materials[scene_meshes[scene_instances[hit.instance].mesh].material].flags;
}

vec3 worldPosition(Instance instance, uint vertex) {
    return instance.to_world * vec4(scene_positions[vertex], 1.0f);
}

/// Barycentrics and t of the ray in the triangle's plane, clamped to the triangle (Moeller &
/// Trumbore 1997). A ray in the plane gives the first vertex.
vec3 intersectTriangle(Ray ray, vec3 a, vec3 b, vec3 c) {
    vec3 edge1 = b - a;
    vec3 edge2 = c - a;
    vec3 p = cross(ray.direction, edge2);
    float det = dot(edge1, p);
    if (det == 0.0f)
        return vec3(0.0f);
    float inverse = 1.0f / det;
    vec3 s = ray.origin - a;
    vec3 q = cross(s, edge1);
    float u = clamp(dot(s, p) * inverse, 0.0f, 1.0f);
    float v = clamp(dot(ray.direction, q) * inverse, 0.0f, 1.0f - u);
    return vec3(u, v, dot(edge2, q) * inverse);
}

/// The surface that `hit` (not a miss) names, seen along `ray`.
Surface surfaceAt(Ray ray, Hit hit) {
    Instance instance = scene_instances[hit.instance];
    Mesh mesh = scene_meshes[instance.mesh];
    uvec3 corners = scene_triangles[mesh.first_triangle + hit.primitive];
    vec3 a = worldPosition(instance, corners.x);
    vec3 b = worldPosition(instance, corners.y);
    vec3 c = worldPosition(instance, corners.z);
    vec3 found = intersectTriangle(ray, a, b, c);
    float w = 1.0f - found.x - found.y;
    Surface surface;
    surface.barycentrics = vec2(found.x, found.y);
    surface.t = found.z;
    surface.position = w * a + found.x * b + found.y * c;
    surface.material = mesh.material;
    surface.instance = hit.instance;
    surface.primitive = hit.primitive;

    vec3 area_normal = cross(b - a, c - a);
    float double_area = length(area_normal);
    surface.geometric_normal =
        double_area > 0.0f ? area_normal / double_area : vec3(0.0f, 1.0f, 0.0f);
    if (dot(surface.geometric_normal, ray.direction) > 0.0f)
        surface.geometric_normal = -surface.geometric_normal;
    vec3 shading = instance.normal_matrix *
                   (w * scene_normals[corners.x] + found.x * scene_normals[corners.y] +
                    found.y * scene_normals[corners.z]);
    float shading_length = length(shading);
    surface.normal = shading_length > 0.0f ? shading / shading_length : surface.geometric_normal;
    if (dot(surface.normal, surface.geometric_normal) < 0.0f)
        surface.normal = -surface.normal;

    vec2 uv_a = scene_uvs[corners.x];
    vec2 uv_b = scene_uvs[corners.y];
    vec2 uv_c = scene_uvs[corners.z];
    surface.uv = w * uv_a + found.x * uv_b + found.y * uv_c;
    vec2 uv_ab = uv_b - uv_a;
    vec2 uv_ac = uv_c - uv_a;
    float uv_area = abs(uv_ab.x * uv_ac.y - uv_ab.y * uv_ac.x);
    surface.uv_per_meter = double_area > 0.0f ? sqrt(uv_area / double_area) : 0.0f;
    return surface;
}

/// The base colour (linear) and alpha of a surface. `footprint`: width of the pixel's cone there,
/// in metres across the ray. Level of detail after ray cones (Akenine-Moeller et al., Ray Tracing
/// Gems, 2019, chapter 20): texels under the footprint, stretched by the angle of view.
vec4 baseColor(Surface surface, vec3 direction, float footprint) {
    Material material = scene_materials[surface.material];
    vec4 color = vec4(material.base_color, material.alpha);
    if (material.base_color_texture == kNone)
        return color;
    Texture texture_info = scene_textures[material.base_color_texture];
    float slope = max(abs(dot(surface.geometric_normal, normalize(direction))), 0.01f);
    float texels = footprint * surface.uv_per_meter *
                   sqrt(float(texture_info.width) * float(texture_info.height)) / slope;
    return color *
           textureTrilinear(material.base_color_texture, surface.uv, log2(max(texels, 1.0f)));
}

/// Whether the point that `ray` sees on the triangle `hit` is solid: alpha, base level and
/// bilinear, against the cutoff.
bool isSolid(Ray ray, Hit hit) {
    Instance instance = scene_instances[hit.instance];
    Mesh mesh = scene_meshes[instance.mesh];
    Material material = scene_materials[mesh.material];
    if ((material.flags & kMaterialMasked) == 0u)
        return true;
    float alpha = material.alpha;
    if (material.base_color_texture != kNone) {
        uvec3 corners = scene_triangles[mesh.first_triangle + hit.primitive];
        vec3 found = intersectTriangle(ray, worldPosition(instance, corners.x),
                                       worldPosition(instance, corners.y),
                                       worldPosition(instance, corners.z));
        vec2 uv = (1.0f - found.x - found.y) * scene_uvs[corners.x] +
                  found.x * scene_uvs[corners.y] + found.y * scene_uvs[corners.z];
        alpha *= textureAlpha(scene_textures[material.base_color_texture], uv);
    }
    return alpha >= material.alpha_cutoff;
}

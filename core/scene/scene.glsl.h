// SPDX-License-Identifier: Apache-2.0
//
// The records of a scene as host, device and tracers see them: scalar layout, the same bytes in C++
// and GLSL.
#ifndef HONE_SCENE_GLSL_H
#define HONE_SCENE_GLSL_H

#ifdef __cplusplus
#include "hone/core/math.h"
namespace hone {
#define HONE_RECORD_CONST inline constexpr
#else
#define HONE_RECORD_CONST const
#endif

/// "None": no texture, no probe, no hit.
HONE_RECORD_CONST uint kNone = 0xffffffffu;

/// One glTF primitive: a range of Scene::triangles with one material. `instance.primitive` counts
/// from first_triangle.
struct Mesh {
    uint first_triangle;
    uint triangle_count;
    uint material;
    uint first_cluster;
    uint cluster_count;
};

/// A mesh placed in the world. Instances are what hits name.
struct Instance {
    mat4x3 to_world;    ///< four columns of vec3: object to world space
    mat3 normal_matrix; ///< inverse transpose of the linear part, for normals
    uint mesh;
    uint probe;   ///< environment probe that its mirror looks up, or kNone
    uint flipped; ///< 1 if to_world mirrors (negative determinant): front faces turn clockwise
};

HONE_RECORD_CONST uint kMaterialTwoSided =
    1u; ///< both faces are seen; otherwise closest hits ignore back faces
HONE_RECORD_CONST uint kMaterialMasked = 2u; ///< alpha below alpha_cutoff is a hole
HONE_RECORD_CONST uint kMaterialMirror =
    4u; ///< reflects like a smooth mirror with reflectance at normal incidence f0

struct Material {
    vec3 base_color; ///< linear, [0,1]; diffuse albedo, multiplies the texture
    uint base_color_texture;
    vec3 emission; ///< radiance, W / (sr m^2)
    float alpha;   ///< [0,1], multiplies the texture's alpha
    vec3 f0;       ///< mirror reflectance at normal incidence, Schlick; 0 where not kMaterialMirror
    float alpha_cutoff;
    uint flags;
};

/// A texture in Scene::texels: RGBA8, one 32-bit word a texel (red lowest), mip levels one after
/// another, rows top down. Colour is sRGB-encoded, alpha linear.
struct Texture {
    uint first_texel;
    uint width;
    uint height;
    uint levels;
    uint wrap_u; ///< 0 repeat, 1 clamp, 2 mirrored repeat
    uint wrap_v;
};

HONE_RECORD_CONST uint kLightPoint = 0u;
HONE_RECORD_CONST uint kLightRectangle = 1u;
HONE_RECORD_CONST uint kLightDirectional = 2u;
HONE_RECORD_CONST uint kLightSpot = 3u;
HONE_RECORD_CONST uint kLightDisc = 4u;
HONE_RECORD_CONST uint kLightSphere = 5u;

struct Light {
    uint kind;
    vec3 position;  ///< centre; world space
    vec3 direction; ///< unit, the way the light travels (rectangle, disc: emitting side's normal)
    vec3 half_u;    ///< rectangle: half edges; disc: two perpendicular radii
    vec3 half_v;
    vec3 intensity;  ///< point, spot: W/sr; rectangle, disc, sphere: radiance; directional:
                     ///< irradiance perpendicular to it
    float cos_inner; ///< spot cone
    float cos_outer;
    float range;     ///< metres where a point or spot light ends; 0 = never
    float radius;    ///< sphere: metres; directional: tangent of half the angle that it fills
    uint shadowless; ///< 1: nothing blocks it
};

/// Where an environment probe sits and whose mirrors use it.
struct Probe {
    vec3 position;
    uint object; ///< the instance that is left out of the probe's own image, or kNone
};

/// What rays see that hit nothing, and the constant ambient term that stands in for light bounced
/// diffusely.
struct Environment {
    vec3 zenith; ///< radiance straight up; blends to horizon by the height of the direction
    vec3 horizon;
    vec3 ground;
    vec3 ambient; ///< radiance added as albedo * ambient, the same in raster and trace
};

/// A camera, ready for making rays. Right-handed, y up in the image plane.
struct Camera {
    vec3 position;
    vec3 forward; ///< unit
    vec3 right;   ///< unit
    vec3 up;      ///< unit
    float tan_half_fov_y;
    float near;        ///< metres; nothing nearer is seen
    float lens_radius; ///< metres; 0 = a pinhole, everything is sharp
    float focus;       ///< view depth in metres of the plane that a lens images sharply
};

/// A run of triangles that are culled and drawn together. Bounds in object space.
struct Cluster {
    uint first_triangle;
    uint triangle_count;
    vec3 center;
    float radius;
    vec3 cone_axis;    ///< all its faces point away from an eye e if dot(center - e, axis) >=
    float cone_cutoff; ///< cutoff * |center - e| + radius (Meshoptimizer's test); 1 = cannot be
                       ///< culled
};

#ifdef __cplusplus
static_assert(sizeof(Mesh) == 20 && sizeof(Instance) == 96 && sizeof(Material) == 52 &&
              sizeof(Texture) == 24 && sizeof(Light) == 84 && sizeof(Probe) == 16 &&
              sizeof(Environment) == 48 && sizeof(Camera) == 64 && sizeof(Cluster) == 40);
} // namespace hone
#endif
#undef HONE_RECORD_CONST
#endif
